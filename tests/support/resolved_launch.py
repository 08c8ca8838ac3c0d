"""What the real ``launch`` and ``launch_ros`` make of a launch file, without starting anything.

Run as a program, in an environment in which these can be imported: it prints the nodes as JSON.
"""

from __future__ import annotations

import asyncio
import json
import os
import re
import shlex
import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import yaml

OWN_NAMES = {
    "controller_manager/ros2_control_node": "controller_manager",
    "controller_manager/spawner": "spawner_{}",
    "moveit_ros_move_group/move_group": "move_group",
    "nav2_controller/controller_server": "controller_server",
    "nav2_map_server/map_saver_server": "map_saver",
    "warehouse_ros_mongo/mongo_wrapper_ros.py": "mongodb",
}
"""The names that programs give themselves, where a launch file gives none; ``{}`` is their first
word: a spawner is called like its first controller."""
_NODE = re.compile(r"(?:(\w+):(?!//))?(.*)")
_TYPES = {1: "bool_value", 2: "integer_value", 3: "double_value", 4: "string_value"}


class _Loader(yaml.SafeLoader):  # type: ignore[misc]
    """Reads what launch_ros writes of tuples as rcl does, which knows no tags."""


_Loader.add_constructor("tag:yaml.org,2002:python/tuple", _Loader.construct_sequence)


@dataclass(frozen=True)
class Started:
    """A node that a launch file starts or loads.

    Attributes:
        name: its full name.
        program: package and executable, or the class of a component.
        container: that it is loaded into; empty for a process.
        words: the other words of its command, without those that set names and parameters.
        parameters: those that the node reads, and of a file also those of other nodes in it, each
            with its key in front: the node may make these in its process.
        shared: the names of those that all nodes of its process get, and not only this one.
        remappings: full names by full names.
    """

    name: str
    program: str
    container: str
    words: tuple[str, ...]
    parameters: Mapping[str, Any]
    shared: tuple[str, ...]
    remappings: Mapping[str, str]


def resolve(path: str, arguments: Mapping[str, str]) -> Iterator[Started]:
    """Yield what a launch file starts with these arguments.

    Timers and what follows on events are not looked into.
    """
    import launch
    from launch.launch_description_sources import (
        AnyLaunchDescriptionSource,
    )

    context = launch.LaunchContext(argv=[])
    loop = asyncio.new_event_loop()
    context._set_asyncio_loop(loop)
    included = launch.actions.IncludeLaunchDescription(
        AnyLaunchDescriptionSource(path), launch_arguments=list(arguments.items())
    )
    try:
        yield from _visited(included, context)
    finally:
        for task in asyncio.all_tasks(loop):  # each would start a process
            task.cancel()
        loop.run_until_complete(asyncio.sleep(0))
        loop.close()


def _visited(entity: Any, context: Any) -> Iterator[Started]:
    from launch_ros.actions import LoadComposableNodes, Node

    if isinstance(entity, LoadComposableNodes):
        if entity.condition is None or entity.condition.evaluate(context):
            yield from _loaded(entity, context)
        return
    further = entity.visit(context) or ()  # of a process: what follows, it runs in no loop
    if isinstance(entity, Node) and entity.process_details is not None:
        yield _process(entity)
    for each in further:
        yield from _visited(each, context)


def _process(node: Any) -> Started:
    words = [str(word) for word in node.process_details["cmd"]]
    program = "/".join(Path(words[0]).parts[-2:])
    given = node.node_name
    namespace = "/".join(part for part in given.split("/")[:-1] if part and "<" not in part)
    name = given.rpartition("/")[2]
    if name.startswith("<"):
        name = OWN_NAMES[program].format(words[1] if len(words) > 1 else "")
    full = _absolute(name, namespace)
    files, values, remaps, others = _sorted(words[1:])
    parameters: dict[str, Any] = {}
    shared = {*values}
    for file in files:
        of_all, of_node = _of_file(Path(file), full)
        parameters |= of_all | of_node
        shared |= of_all.keys()
    parameters |= values
    remappings = remapped(remaps, full)
    return Started(full, program, "", tuple(others), parameters, tuple(sorted(shared)), remappings)


def _loaded(action: Any, context: Any) -> Iterator[Started]:
    from launch.utilities import (
        normalize_to_list_of_substitutions,
        perform_substitutions,
    )
    from launch_ros.actions.load_composable_nodes import (
        get_composable_node_load_request,
    )

    target = action._LoadComposableNodes__target_container
    if hasattr(target, "node_name"):
        container = target.node_name
    else:
        container = perform_substitutions(context, normalize_to_list_of_substitutions(target))
    for each in action._LoadComposableNodes__composable_node_descriptions:
        request = get_composable_node_load_request(each, context)
        if request is None:
            continue
        parameters = {}
        for found in request.parameters:
            value = found.value
            kind = _TYPES.get(value.type)
            parameters[found.name] = (
                getattr(value, kind) if kind else [*_array(value)]  # an array
            )
        full = _absolute(request.node_name, request.node_namespace.strip("/"))
        yield Started(
            full,
            f"{request.package_name}/{request.plugin_name}",
            "/" + container.strip("/"),
            (),
            parameters,
            (),
            remapped(request.remap_rules, full),
        )


def _array(value: Any) -> Iterable[Any]:
    names = ("byte", "bool", "integer", "double", "string")
    return next((each for n in names if (each := getattr(value, f"{n}_array_value"))), ())


def _absolute(name: str, namespace: str) -> str:
    if name.startswith("/"):
        return name
    return f"/{namespace}/{name}" if namespace else f"/{name}"


def remapped(rules: Iterable[str], node: str) -> dict[str, str]:
    """Return what rules mean for a node, and with a name in front for others of its process.

    A rule ``arm:~/state:=/state`` is for the node ``arm`` alone, here in the same namespace.
    """
    namespace, _, name = node.strip("/").rpartition("/")
    made = {}
    for rule in rules:
        old, new = rule.split(":=", 1)
        meant, old = _NODE.fullmatch(old).groups()  # type: ignore[union-attr]
        own = _absolute(meant or name, namespace)
        pair = [
            _absolute(f"{own}{n[1:]}" if n.startswith("~") else n, namespace) for n in (old, new)
        ]
        if pair[0] != pair[1]:
            made[pair[0] if own == node else f"{meant}: {pair[0]}"] = pair[1]
    return made


def _sorted(
    words: Sequence[str],
) -> tuple[list[str], dict[str, Any], list[str], list[str]]:
    files, values, remaps, others = [], {}, [], []
    rest = iter(words)
    for word in rest:
        if word == "--params-file":
            files.append(next(rest))
        elif word == "-p":
            name, value = next(rest).split(":=", 1)
            values[name] = yaml.safe_load(value)
        elif word == "-r":
            rule = next(rest)
            remaps += [] if rule.startswith(("__node:=", "__ns:=")) else [rule]
        elif word != "--ros-args":
            others.append(word)
    return files, values, remaps, others


def _of_file(path: Path, name: str) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return the parameters in a file for all nodes, and those of one and of others, by key."""
    sections: dict[str, dict[str, Any]] = {}

    def walk(found: Mapping[str, Any], keys: tuple[str, ...]) -> None:
        for key, value in found.items():
            if key == "ros__parameters":
                flat = sections.setdefault("/".join(k.strip("/") for k in keys), {})
                _flatten(value, "", flat)
            else:
                walk(value, (*keys, key))

    walk(yaml.load(path.read_text(), _Loader), ())
    of_all = sections.pop("**", {})
    found = sections.pop(name.strip("/"), {})
    return of_all, found | {f"{key}: {n}": v for key, of in sections.items() for n, v in of.items()}


def _flatten(values: Mapping[str, Any], prefix: str, into: dict[str, Any]) -> None:
    for name, value in values.items():
        if isinstance(value, Mapping):
            _flatten(value, f"{prefix}{name}.", into)
        else:
            into[f"{prefix}{name}"] = value


def main() -> None:
    """Print what is started by the launch file that the first word names, as JSON."""
    arguments = dict(word.split(":=", 1) for word in sys.argv[2:])
    print(json.dumps([asdict(each) for each in resolve(sys.argv[1], arguments)]), flush=True)
    os._exit(0)  # the node that launch_ros makes for managed nodes spins in a thread for ever


def command(python: str, path: Path, arguments: Mapping[str, str]) -> list[str]:
    """Return the command that resolves a launch file in another environment."""
    words = [python, "-m", __name__, str(path), *(f"{n}:={v}" for n, v in arguments.items())]
    print(shlex.join(words))
    return words


if __name__ == "__main__":
    main()
