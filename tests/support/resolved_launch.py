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
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import yaml

OWN_NAMES: Mapping[str, tuple[str, ...]] = {
    "coin_d4_driver/single_coin_d4_node": ("lidar_node",),
    "create3_republisher/create3_republisher": ("create3_repub",),
    "diagnostic_aggregator/aggregator_node": ("analyzers",),
    "controller_manager/ros2_control_node": ("controller_manager",),
    "controller_manager/spawner": ("spawner_{}",),
    "moveit_ros_move_group/move_group": ("move_group",),
    "nav2_controller/controller_server": ("controller_server",),
    "nav2_map_server/map_saver_server": ("map_saver",),
    "robot_state_publisher/robot_state_publisher": ("robot_state_publisher",),
    "turtlebot3_node/turtlebot3_ros": ("turtlebot3_node", "diff_drive_controller"),
    "turtlebot4_base/turtlebot4_base_node": ("turtlebot4_base_node",),
    "turtlebot4_diagnostics/diagnostics_updater": ("turtlebot4_diagnostics",),
    "turtlebot4_node/turtlebot4_node": ("turtlebot4_node",),
    "warehouse_ros_mongo/mongo_wrapper_ros.py": ("mongodb",),
}
"""The nodes in programs, by the names that they have where a launch file gives none; ``{}`` is the
first word of a program: a spawner is called like its first controller."""
_NODE = re.compile(r"(?:(\w+):(?!//))?(.*)")
_TYPES = {1: "bool_value", 2: "integer_value", 3: "double_value", 4: "string_value"}


class _Loader(yaml.SafeLoader):  # type: ignore[misc]
    """Reads what launch_ros writes of tuples as rcl does, which knows no tags."""


_Loader.add_constructor("tag:yaml.org,2002:python/tuple", _Loader.construct_sequence)
_Loader.add_constructor("tag:yaml.org,2002:map", lambda loader, node: _merged(loader, node.value))


def _merged(loader: Any, pairs: Iterable[tuple[Any, Any]]) -> dict[Any, Any]:
    """Return what stands below keys, also below one that is there twice: rcl reads both."""
    found: dict[Any, Any] = {}
    for key, value in pairs:
        name, read = loader.construct_object(key, deep=True), loader.construct_object(value, True)
        found[name] = _both(found.get(name), read)
    return found


def _both(one: Any, other: Any) -> Any:
    if not isinstance(one, dict) or not isinstance(other, dict):
        return other
    return one | {key: _both(one.get(key), value) for key, value in other.items()}


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
        remappings: full names by full names.
        shared: the names of parameters that all nodes of its process get, and not only this one.
        inside: full names of further nodes in the process.
        delay: seconds after which it is started.
        respawns: whether it is started again.
        ends_all: whether its end stops all others.
    """

    name: str
    program: str
    container: str
    words: tuple[str, ...]
    parameters: Mapping[str, Any]
    remappings: Mapping[str, str]
    shared: tuple[str, ...] = ()
    inside: tuple[str, ...] = ()
    delay: float = 0.0
    respawns: bool = False
    ends_all: bool = False


def resolve(path: str, arguments: Mapping[str, str]) -> Iterator[Started]:
    """Yield what a launch file starts with these arguments, at once or after some time.

    What follows on other events is not looked into.
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
    timers: list[Any] = []
    try:
        found = list(_visited(included, context, timers))
        for timer in timers:  # fire when all else is done
            delay = launch.utilities.type_utils.perform_typed_substitution(
                context, timer.period, float
            )
            later = (each for of in timer.actions for each in _visited(of, context, timers))
            found += [(replace(started, delay=delay), node) for started, node in later]
        for started, node in found:
            yield replace(started, ends_all=node is not None and _ends_all(node, context))
    finally:
        for task in asyncio.all_tasks(loop):  # each would start a process
            task.cancel()
        loop.run_until_complete(asyncio.sleep(0))
        loop.close()


def _visited(entity: Any, context: Any, timers: list[Any]) -> Iterator[tuple[Started, Any]]:
    """Yield what is started, with its action if it is a process."""
    from launch.actions import TimerAction
    from launch_ros.actions import LoadComposableNodes, Node

    if isinstance(entity, LoadComposableNodes):
        if entity.condition is None or entity.condition.evaluate(context):
            yield from ((each, None) for each in _loaded(entity, context))
        return
    further = entity.visit(context) or ()  # of a process: what follows, it runs in no loop
    if isinstance(entity, TimerAction):
        timers.append(entity)
    if isinstance(entity, Node) and entity.process_details is not None:
        yield _process(entity, context), entity
    for each in further:
        yield from _visited(each, context, timers)


def _process(node: Any, context: Any) -> Started:
    from launch.utilities.type_utils import perform_typed_substitution

    words = [str(word) for word in node.process_details["cmd"]]
    program = "/".join(Path(words[0]).parts[-2:])
    given = node.node_name
    namespace = "/".join(part for part in given.split("/")[:-1] if part and "<" not in part)
    name = given.rpartition("/")[2]
    first = words[1] if len(words) > 1 else ""
    own = tuple(each.format(first) for each in OWN_NAMES.get(program, (name,)))
    names = own if name.startswith("<") else (name,) * len(own)  # a name is for all of them
    full, *inside = nodes = [_absolute(each, namespace) for each in names]
    files, values, remaps, others = _sorted(words[1:])
    parameters, shared = _of_files(map(Path, files), nodes, values)
    respawns = perform_typed_substitution(context, node._ExecuteLocal__respawn, bool)
    return Started(
        full,
        program,
        "",
        tuple(others),
        parameters,
        remapped(remaps, full),
        shared=shared,
        inside=tuple(inside),
        respawns=bool(respawns),
    )


def _ends_all(node: Any, context: Any) -> bool:
    """Return whether everything ends when a process does."""
    from launch.actions import EmitEvent
    from launch.events import Shutdown
    from launch.events.process import ProcessExited

    event = ProcessExited(action=node, name="", cmd=[], cwd=None, env=None, pid=0, returncode=0)
    follows: list[Any] = []
    for handler in list(context._event_handlers):
        if handler.matches(event):
            follows += handler.handle(event, context) or ()
    return any(isinstance(each, EmitEvent) and isinstance(each.event, Shutdown) for each in follows)


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


def _of_files(
    paths: Iterable[Path], nodes: Sequence[str], values: Mapping[str, Any]
) -> tuple[dict[str, Any], tuple[str, ...]]:
    """Return the parameters of the nodes of a process, and those that all of them get.

    With them is what else is in their files.

    Args:
        paths: of the files.
        nodes: full names; the first one is the node whose parameters have no key in front.
        values: from the command line, for all of them.
    """
    sections: dict[str, dict[str, Any]] = {}  # of several that match, the first is the weakest

    def walk(found: Mapping[str, Any], keys: tuple[str, ...]) -> None:
        for key, value in found.items():
            if key == "ros__parameters":
                flat = sections.setdefault("/".join(k.strip("/") for k in keys), {})
                _flatten(value, "", flat)
            else:
                walk(value, (*keys, key))

    for path in paths:
        walk(yaml.load(path.read_text(), _Loader), ())
    sections.setdefault("**", {}).update(values)
    found: dict[str, Any] = {}
    for node in nodes:
        front = "" if node == nodes[0] else f"{node.strip('/')}: "
        for key, of in sections.items():
            if _matches(key.split("/"), node.strip("/").split("/")):
                found |= {f"{front}{name}": value for name, value in of.items()}
    others = {
        key: of
        for key, of in sections.items()
        if not any(_matches(key.split("/"), node.strip("/").split("/")) for node in nodes)
    }
    found |= {f"{key}: {n}": v for key, of in others.items() for n, v in of.items()}
    return found, tuple(sorted(sections["**"]))


def _matches(key: Sequence[str], name: Sequence[str]) -> bool:
    """Return whether a key of a parameter file is for a node, as rcl has it."""
    if not key or not name:
        return not name and all(each == "**" for each in key)
    if key[0] == "**":
        return _matches(key[1:], name) or _matches(key, name[1:])
    return key[0] in ("*", name[0]) and _matches(key[1:], name[1:])


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
