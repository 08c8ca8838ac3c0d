"""A program for the nodes of a system: real nodes of rclpy, as their descriptions say.

It is installed with its descriptions beside it (:mod:`tests.support.started_graph`), tells what it
was started with in a file of the folder ``DEROS_TEST_TOLD``, and then answers like any node.
"""

from __future__ import annotations

import contextlib
import importlib
import json
import os
import sys
import time
from pathlib import Path
from typing import Any

TOLD = "DEROS_TEST_TOLD"
ENDS_FIRST = "--ends-first"
"""With this word, the first of the processes of one name ends at once with exit code 3."""


ALONE = "--alone"
"""With this word, a program makes the first of its nodes only."""


def tell(name: str, words: list[str], **more: object) -> None:
    """Write down what a process was started with; the first of two may end here."""
    folder = Path(os.environ[TOLD])
    label = name.strip("/").replace("/", ".")
    earlier = len(list(folder.glob(f"{label}.*.json")))
    said = {
        "name": name,
        "words": [_as_file(word) for word in words],
        "variables": dict(os.environ),
        "folder": str(Path.cwd()),
        "nice": os.nice(0),
        "at": time.monotonic(),
        **more,
    }
    hidden = folder / f".{label}.{os.getpid()}"
    hidden.write_text(json.dumps(said), encoding="utf-8")
    hidden.rename(folder / f"{label}.{os.getpid()}.json")
    if ENDS_FIRST in words and earlier == 0:
        sys.exit(3)


def _as_file(word: str) -> object:
    """Return the name and the text of a file that was made, whose folder is different each time."""
    path = Path(word)
    if path.is_absolute() and path.is_file():
        return [path.name, path.read_text(encoding="utf-8")]
    return word


def _type(name: str) -> Any:
    package, kind, message = name.split("/")
    return getattr(importlib.import_module(f"{package}.{kind}"), message)


def _refuse(goal: Any) -> None:
    raise NotImplementedError(goal)  # no goal is sent


def _add_ports(node: Any, ports: list[list[str]]) -> None:
    from rclpy.action.client import ActionClient
    from rclpy.action.server import ActionServer

    for kind, name, type_name, via in ports:
        found = _type(type_name)
        topic = node.get_parameter(via).value if via else name
        if kind == "publishes":
            node.create_publisher(found, topic, 1)
        elif kind == "subscribes":
            node.create_subscription(found, topic, lambda _: None, 1)
        elif kind == "services":
            node.create_service(found, topic, lambda _, response: response)
        elif kind == "clients":
            node.create_client(found, topic)
        elif kind == "actions":
            node.kept.append(ActionServer(node, found, topic, _refuse))
        else:
            node.kept.append(ActionClient(node, found, topic))


def _made(described: dict[str, Any]) -> Any:
    from rclpy.lifecycle import LifecycleNode
    from rclpy.node import Node

    node: Any = (LifecycleNode if described["lifecycle"] else Node)(described["name"])
    node.kept = []
    for name, value in described["parameters"].items():
        node.declare_parameter(name, value)  # refuses a value of another type
    _add_ports(node, described["ports"])
    return node


def main() -> None:
    """Make the nodes of the process and run them until they are stopped."""
    import rclpy
    from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
    from rclpy.utilities import try_shutdown

    own = sys.argv[1:]
    if "--ros-args" in own:
        own = own[: own.index("--ros-args")]
    described = json.loads(Path(f"{sys.argv[0]}.json").read_text(encoding="utf-8"))
    nodes: list[Any] = []
    with contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
        rclpy.init(args=sys.argv)
        try:
            began = time.monotonic()
            nodes.extend(map(_made, described[:1] if ALONE in own else described))
            level = nodes[0].get_logger().get_effective_level().name
            tell(nodes[0].get_fully_qualified_name(), own, level=level, at=began)
            executor = SingleThreadedExecutor()
            for node in nodes:
                executor.add_node(node)
            executor.spin()
        finally:  # no other is to see in the graph what has ended
            for node in nodes:
                node.destroy_node()
            try_shutdown()


if __name__ == "__main__":
    main()
