"""What a started system is, seen from outside, and what its model says that it has to be.

The programs are real: nodes of rclpy that have the ports and parameters of their descriptions, and
processes that tell what they were given. Both write it into the folder ``told``.
"""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Collection, Iterator, Mapping
from pathlib import Path
from typing import Any

from deros.models.node import NodeType, PortKind, as_double
from deros.systems.flat import FlatNode, FlatProcess, FlatSystem
from tests.support.ros import LIMIT, Peer

ROOT = Path(__file__).resolve().parents[2]
_OF_EVERY_NODE = ("start_type_description_service", "qos_overrides.")
_SERVICES = (
    *(f"/{each}_parameters" for each in ("describe", "get", "list", "set")),
    *("/get_parameter_types", "/set_parameters_atomically", "/get_type_description"),
)
_CONTAINER = tuple(f"/_container/{each}" for each in ("load_node", "unload_node", "list_nodes"))
_MANAGED = (
    *("/change_state", "/get_state", "/get_available_states", "/get_available_transitions"),
    *("/get_transition_graph", "/transition_event"),
)

Graph = dict[str, dict[str, Any]]
"""What nodes and processes do and have been given, by their full names."""


# The programs -------------------------------------------------------------------------------------


def install(prefix: Path, types: Mapping[tuple[str, str], tuple[NodeType, ...]]) -> None:
    """Install a program for each package and executable: it makes these nodes, in this order."""
    for (package, executable), nodes in types.items():
        program = install_program(prefix, package, executable, _module("graph_member"), ROOT)
        described = [_described(each) for each in nodes]
        program.with_name(f"{executable}.json").write_text(json.dumps(described), encoding="utf-8")
    _write_program(prefix / "bin/tell", _module("telling_process"), ROOT)


def install_program(
    prefix: Path, package: str, executable: str, module: str, *folders: Path
) -> Path:
    """Install a program of a package: it runs ``main`` of a module in one of some folders."""
    index = prefix / "share/ament_index/resource_index/packages"
    index.mkdir(parents=True, exist_ok=True)
    (index / package).touch()
    program = prefix / "lib" / package / executable
    _write_program(program, module, *folders)
    return program


def _module(name: str) -> str:
    return f"tests.support.{name}"


def _write_program(path: Path, module: str, *folders: Path) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(
        f"#!{sys.executable}\nimport sys\nsys.path += {[*map(str, folders)]!r}\n"
        f"from {module} import main\nmain()\n",
        encoding="utf-8",
    )
    path.chmod(0o755)


def _described(found: NodeType) -> dict[str, Any]:
    return {
        "name": found.name,
        "lifecycle": found.lifecycle,
        "parameters": {each.name: each.default for each in found.parameters},
        "ports": [[p.kind.value, p.name, str(p.type), p.via] for p in found.ports],
    }


# What the model says ------------------------------------------------------------------------------


def expected_graph(
    flat: FlatSystem, texts: Mapping[str, object], silent: Collection[str] = ()
) -> Graph:
    """Return what a system is when it is started, for the values that it has been resolved for.

    Args:
        flat: the system.
        texts: what stands where the model has a text that is known at the start only.
        silent: packages whose programs do not tell what they were given, as containers never do.
    """
    programs: list[FlatNode | FlatProcess] = [*flat.processes]
    programs += (each for each in flat.nodes if _tells(each, silent))
    variables = {each.name for program in programs for each in program.environment}
    found: Graph = {each.full_name: _expected_node(each, texts) for each in flat.nodes}
    for each in programs:
        told = _expected_told(each, texts)
        told["variables"] = {
            **{name: os.environ.get(name) for name in variables},
            **{each.name: each.value.text for each in each.environment},
        }
        found.setdefault(each.full_name, {})["told"] = told
    return found


def _tells(node: FlatNode, silent: Collection[str]) -> bool:
    assert node.type is not None
    own = not node.instance.is_container and node.container is None and node.instance.inside is None
    return own and node.type.package not in silent


def _expected_node(node: FlatNode, texts: Mapping[str, object]) -> dict[str, Any]:
    assert node.type is not None
    set_here = dict(node.parameters)
    simulated = set_here.get("use_sim_time", False)
    kinds = {each.name: each.type for each in node.type.parameters}
    values = {each.name: each.default for each in node.type.parameters} | set_here
    ends = {(p.port.kind.value, p.topic, str(p.port.type)) for p in node.ports}
    if simulated:
        ends.add((PortKind.SUBSCRIPTION.value, "/clock", "rosgraph_msgs/msg/Clock"))
    return {
        "ends": ends,
        "parameters": None  # a container serves none
        if node.instance.is_container
        else {"use_sim_time": simulated}
        | {
            name: _at_start(as_double(value, kinds[name]), texts)
            for name, value in values.items()
            if name in kinds and value is not None
        },
        "state": "active" if node.autostart is not None else None,
    }


def _expected_told(program: FlatNode | FlatProcess, texts: Mapping[str, object]) -> dict[str, Any]:
    instance = program.instance
    words = [_at_start(each.text, texts) for each in instance.arguments]
    niceness = instance.prefix.text.split() if instance.prefix is not None else []
    told = {
        "nice": os.nice(0) + (int(niceness[2]) if niceness else 0),
        "starts": 2 if "--ends-first" in words else 1,
    }
    if isinstance(program, FlatNode):
        level = program.instance.log_level or "info"
        return {**told, "words": words, "folder": str(Path.cwd()), "level": level.upper()}
    folder = program.instance.folder
    where = _at_start(folder.text, texts) if folder is not None else str(Path.cwd())
    return {**told, "words": words[1:], "folder": where, "level": None}


def _at_start(value: Any, texts: Mapping[str, object]) -> Any:
    if isinstance(value, tuple):
        return [_at_start(each, texts) for each in value]
    if not isinstance(value, str):
        return value
    if value in texts:
        return texts[value]
    for placeholder, text in texts.items():
        if isinstance(text, str):
            value = value.replace(placeholder, text)
    return value


def differences(found: Any, expected: Any, where: str = "") -> Iterator[str]:
    """Yield what differs, with its place."""
    if isinstance(found, dict) and isinstance(expected, dict):
        for key in sorted({*found, *expected}):
            yield from differences(found.get(key), expected.get(key), f"{where} {key}")
    elif found != expected or type(found) is not type(expected):
        yield f"{where}: {found!r}, expected {expected!r}"


# What is there ------------------------------------------------------------------------------------


def await_graph(expected: Graph, told: Path, peer: Peer, limit: float = LIMIT) -> Graph:
    """Wait until all of a system is there and has told what it was given, and return it.

    Raises:
        AssertionError: if that does not happen; it says what differs.
    """
    ends = {name: each["ends"] for name, each in expected.items() if "ends" in each}
    starts = {name: each["told"]["starts"] for name, each in expected.items() if "told" in each}

    def there() -> tuple[object, object]:
        return _ends_shown(peer), {name: len(each) for name, each in _told(told).items()}

    try:
        peer.until(lambda: there() == (ends, starts), limit)
    except AssertionError:
        shown = _ends_shown(peer)
        differs = {
            name: (ends.get(name), shown.get(name))
            for name in {*ends, *shown}
            if ends.get(name) != shown.get(name)
        }
        raise AssertionError(f"{differs}\nstarts: {starts}, told: {there()[1]}") from None
    managed = [name for name, each in expected.items() if each.get("state")]
    peer.until(lambda: all(_state(peer, name) == "active" for name in managed))
    found: Graph = {
        name: {
            "ends": each,
            "parameters": (
                None if expected[name]["parameters"] is None else _parameters(peer, name)
            ),
            "state": "active" if name in managed else None,
        }
        for name, each in ends.items()
    }
    variables = {
        name: each["told"]["variables"] for name, each in expected.items() if "told" in each
    }
    for name, all_told in _told(told).items():
        found.setdefault(name, {})["told"] = _as_compared(all_told, variables[name])
    return found


def _ends_shown(peer: Peer) -> dict[str, set[tuple[str, str, str]]]:
    node = peer.node
    names = node.get_node_names_and_namespaces()
    return {
        f"{namespace.rstrip('/')}/{name}": set(_ends(node, name, namespace))
        for name, namespace in names
        if name != node.get_name() and not name.startswith(("_", "launch_ros_"))
    }


def _ends(node: Any, name: str, namespace: str) -> Iterator[tuple[str, str, str]]:
    from rclpy.action import graph
    from rclpy.node import NodeNameNonExistentError

    queries = {
        PortKind.PUBLISHER: node.get_publisher_names_and_types_by_node,
        PortKind.SUBSCRIPTION: node.get_subscriber_names_and_types_by_node,
        PortKind.SERVICE: node.get_service_names_and_types_by_node,
        PortKind.CLIENT: node.get_client_names_and_types_by_node,
        PortKind.ACTION: lambda *of: graph.get_action_server_names_and_types_by_node(node, *of),
        PortKind.ACTION_CLIENT: lambda *of: graph.get_action_client_names_and_types_by_node(
            node, *of
        ),
    }
    own = f"{namespace.rstrip('/')}/{name}"
    hidden = {"/rosout", "/parameter_events"} | {
        f"{own}{each}" for each in (*_SERVICES, *_MANAGED, *_CONTAINER)
    }
    try:
        for kind, query in queries.items():
            for end, types in query(name, namespace):
                if end not in hidden and "/_action/" not in end:
                    yield from ((kind.value, end, each) for each in types)
    except (NodeNameNonExistentError, RuntimeError):
        return  # it has left the graph meanwhile


def _parameters(peer: Peer, node: str) -> dict[str, Any]:
    from rcl_interfaces.srv import GetParameters, ListParameters
    from rclpy.parameter import parameter_value_to_python

    names = [
        name
        for name in _call(peer, ListParameters, f"{node}/list_parameters").result.names
        if not name.startswith(_OF_EVERY_NODE)
    ]
    values = _call(peer, GetParameters, f"{node}/get_parameters", names=names).values
    found = map(parameter_value_to_python, values)
    return {
        name: value if isinstance(value, str | bool | int | float) else list(value)
        for name, value in zip(names, found, strict=True)
    }


def _state(peer: Peer, node: str) -> str:
    from lifecycle_msgs.srv import GetState

    return str(_call(peer, GetState, f"{node}/get_state").current_state.label)


def _call(peer: Peer, kind: Any, service: str, **request: Any) -> Any:
    client = peer.node.create_client(kind, service)
    try:
        return peer.call(client, kind.Request(**request))
    finally:
        peer.node.destroy_client(client)


def _told(folder: Path) -> dict[str, list[dict[str, Any]]]:
    """Return what each process has told, in the order of their starts, by its name."""
    all_told = [json.loads(path.read_text(encoding="utf-8")) for path in folder.glob("*.json")]
    found: dict[str, list[dict[str, Any]]] = {}
    for each in sorted(all_told, key=lambda each: float(each["at"])):
        found.setdefault(each["name"], []).append(each)
    return found


def started_at(folder: Path) -> dict[str, float]:
    """Return when each process was first there, in seconds of the monotonic clock, by its name."""
    return {name: each[0]["at"] for name, each in _told(folder).items()}


def _as_compared(told: list[dict[str, Any]], variables: Mapping[str, object]) -> dict[str, Any]:
    first, last = told[0], told[-1]
    kept = ("words", "nice", "folder")
    assert {key: first[key] for key in kept} == {key: last[key] for key in kept}
    return {
        **{key: last[key] for key in kept},
        "level": last.get("level"),
        "starts": len(told),
        "variables": {name: last["variables"].get(name) for name in variables},
    }
