"""A graph as a message of ROS 2, ``rosgraph_msgs/msg/Graph``, in the YAML of ``ros2 topic echo``.

Source: ``Graph.msg`` of rosgraph_msgs and what it consists of (Node, Topic, Service, Action,
QoSProfile), and ``ParameterDescriptor.msg`` and ``ParameterValue.msg`` of rcl_interfaces.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from deros.diagnostics import Span
from deros.importers.formats import loading
from deros.importers.formats.graph_fields import Fields
from deros.importers.formats.graph_parameters import parameters_of
from deros.importers.node_types import imported
from deros.importers.readers import Request, UnreadableError, source_of
from deros.importers.results import Imported, Missing
from deros.importers.texts import files
from deros.interfaces.durations import NS_PER_S
from deros.live.ends import NodeEnds, belongs_to_nodes
from deros.live.snapshots import End, SeenNode, Snapshot
from deros.metamodels.yaml_trees.tree import Mapping, Sequence
from deros.models.common import QosProfile
from deros.models.node import PortKind

_RELIABILITY = {1: "reliable", 2: "best_effort"}
_DURABILITY = {1: "transient_local", 2: "volatile"}
_LIVELINESS = {1: "automatic", 3: "manual_by_topic"}
_KEEP_LAST, _KEEP_ALL = 1, 2
_LONGEST = (2**31 - 1) * NS_PER_S  # of DDS; what is longer stands for infinite
_DEPTHS = range(1, 2**31)

_TOPICS = {"publishers": PortKind.PUBLISHER, "subscriptions": PortKind.SUBSCRIPTION}
_SERVICES = {"service_servers": PortKind.SERVICE, "service_clients": PortKind.CLIENT}
_ACTIONS = {"action_servers": PortKind.ACTION, "action_clients": PortKind.ACTION_CLIENT}


def is_graph(path: Path) -> bool:
    """Return whether a file is such a message: its nodes have names and publishers."""
    if path.suffix not in (".yaml", ".yml", ".json"):
        return False
    top = loading.top_of(path)
    nodes = top.get("nodes") if top is not None else None
    if not isinstance(nodes, Sequence) or not nodes.items:
        return False
    first = nodes.items[0]
    return isinstance(first, Mapping) and {"name", "publishers"} <= first.entries.keys()


def read_graph(request: Request) -> Imported:
    """Return the node descriptions and the system of a graph, as of one that runs.

    Raises:
        UnreadableError: if there is more than one file, or it has no nodes.
    """
    if len(request.files) != 1:
        raise UnreadableError(f"{request.files[1]}: a graph is in one file; import one by one")
    path = request.files[0]
    top = loading.mapping_of(source_of(path))
    nodes = top.get("nodes")
    if not isinstance(nodes, Sequence):
        raise UnreadableError(f"{path}: this is no graph, which has a list of 'nodes'")
    missing: list[Missing] = list(loading.unused_keys(top))
    places: dict[str, Span] = {}
    seen: list[SeenNode] = []
    for each in nodes.items:
        fields = Fields.of(each, "a node", missing)
        if fields is None:
            continue
        name = _absolute(fields)
        what = f"node '{name}'"
        if name in places:
            fields.lack(what, "is left out: another one has its name")
        elif name.rpartition("/")[2].startswith("_"):
            fields.lack(what, "is left out: names that begin with '_' are those of tools")
        else:
            places[name] = each.span
            seen.append(_node(name, fields))
    if not seen:
        raise UnreadableError(f"{path}: there is no node in this graph")
    graph = imported(Snapshot(tuple(sorted(seen, key=lambda n: n.full_name))), request.is_known)
    missing += (_placed(each, places, path) for each in graph.problems)
    return Imported(files(graph, request.name or "robot"), tuple(map(str, missing)))


def _placed(problem: str, places: dict[str, Span], path: Path) -> Missing:
    """Return what is left out of a node, with the place of the node."""
    nodes = [each for each in places if problem.startswith((f"{each}:", f"{each} "))]
    name = max(nodes, key=len, default="")
    what, why = problem[: len(name)], problem[len(name) :].lstrip(": ")
    line = places[name].line if name else 0
    return Missing(what or "the graph", why, str(path), line)


# Ends -------------------------------------------------------------------------------------------


def _node(name: str, fields: Fields) -> SeenNode:
    all_ends = list(_ends(fields))
    services = tuple((e.name, e.type) for e, _ in all_ends if e.kind is PortKind.SERVICE)
    found = NodeEnds(name, (), services, ())
    ends: dict[tuple[PortKind, str], End] = {}
    for each, qos in all_ends:
        if belongs_to_nodes(each.kind, each.name, [each.type], found):
            continue
        if qos is not None:
            each = each._replace(qos=_qos(qos, f"{each.kind.word} '{each.name}'"))
        other = ends.setdefault((each.kind, each.name), each)
        if other != each:
            what = f"{each.kind.word} '{each.name}' of '{name}'"
            fields.lack(what, "comes again, with another type or QoS, which is left out")
    order = list(PortKind)
    ordered = sorted(ends.values(), key=lambda each: (order.index(each.kind), each.name))
    lifecycle = "unknown" if found.is_managed else None
    parameters = parameters_of(name, fields)
    return SeenNode(name, tuple(ordered), parameters, lifecycle, found.is_container)


def _ends(fields: Fields) -> Iterator[tuple[End, Fields | None]]:
    """Yield the ends of a node, and the QoS of those of topics."""
    for key, kind in _TOPICS.items():
        for each in fields.items(key):
            of_type = _type(each.within("type"))
            yield End(kind, _absolute(each), of_type), each.within("qos")
    for key, kind in _SERVICES.items():
        for each in fields.items(key):
            of_type = _type(each.within("request_type"))
            yield End(kind, _absolute(each), of_type.removesuffix("_Request")), None
    for key, kind in _ACTIONS.items():
        for each in fields.items(key):
            of_type = _type(each.within("send_goal").within("request_type"))
            of_type = of_type.removesuffix("_Request").removesuffix("_SendGoal")
            yield End(kind, _absolute(each), of_type), None


def _absolute(fields: Fields) -> str:
    return f"/{loading.shown(fields.text('name')).removeprefix('/')}"


def _type(fields: Fields) -> str:
    return loading.shown(fields.text("name"))


def _qos(fields: Fields, what: str) -> QosProfile:
    words: dict[str, str | None] = {}
    for key, known in (
        ("reliability", _RELIABILITY),
        ("durability", _DURABILITY),
        ("liveliness", _LIVELINESS),
    ):
        number = fields.integer(key)
        words[key] = known.get(number)
        if words[key] is None:
            fields.lack(what, f"has the QoS '{key}: {number}', which says nothing")
    lease = _time(fields.within("liveliness_lease_duration"))
    liveliness = words["liveliness"]
    if liveliness == "automatic" and lease is None:
        liveliness = None
    depth, history = fields.integer("depth"), fields.integer("history")
    return QosProfile(
        reliability=words["reliability"],
        durability=words["durability"],
        depth=depth if history == _KEEP_LAST and depth in _DEPTHS else None,
        keep_all=history == _KEEP_ALL,
        deadline_ns=_time(fields.within("deadline")),
        lifespan_ns=_time(fields.within("lifespan")),
        liveliness=liveliness,
        lease_ns=lease if liveliness is not None else None,
    )


def _time(fields: Fields) -> int | None:
    nanoseconds = fields.integer("sec") * NS_PER_S + fields.integer("nanosec")
    return nanoseconds if 0 < nanoseconds <= _LONGEST else None
