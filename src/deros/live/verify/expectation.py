"""What a system says of its running graph, in the form in which a graph is compared with it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fnmatch import fnmatchcase

from deros.diagnostics import Span
from deros.interfaces.standard_topics import standard_topic
from deros.live.snapshots import Unseen
from deros.models.common import Value
from deros.models.node import BUILT_IN_PARAMETERS, ParameterType, PortKind
from deros.models.parameter_files import Document
from deros.names.graph_names import from_root
from deros.systems.arguments.lookups import is_at_start
from deros.systems.flat import FlatNode, FlatSystem
from deros.validators.wiring.graph import End

_ACTIVE = "active"


@dataclass(frozen=True, slots=True)
class ExpectedParameter:
    """A parameter with the value that it has to have.

    Attributes:
        type: as it is declared; ``None`` if it is not.
        may_be_missing: whether the node need not have it, because it is not declared.
        span: where it is set, or else declared; ``None`` for what every node has.
    """

    name: str
    value: Value
    type: ParameterType | None
    may_be_missing: bool
    span: Span | None


@dataclass(frozen=True, slots=True)
class ExpectedNode:
    """A node that has to run.

    Attributes:
        ends: by kind and graph name; more than one where two ports meet there. ``None`` if they are
            not known.
        untyped: the topics of its other ends, of which nothing is known.
        state: the lifecycle state that it is brought to; ``None`` if it is in none or in any.
        is_managed: whether its ends depend on its state.
        container: the full name of the container that it is loaded into; empty for a process of
            its own, ``None`` if that is not known.
    """

    full_name: str
    span: Span
    ends: Mapping[tuple[PortKind, str], Sequence[End]] | None
    untyped: frozenset[str]
    parameters: tuple[ExpectedParameter, ...]
    state: str | None
    is_managed: bool
    container: str | None = None

    def may_have(self, kind: PortKind, name: str) -> bool:
        """Return whether the model does not exclude an end."""
        return self.ends is None or (kind, name) in self.ends or name in self.untyped


@dataclass(frozen=True, slots=True)
class Expectation:
    """What has to run.

    Attributes:
        system: its name.
        nodes: by full name.
        sole_publishers: the node that alone is meant to publish a topic, by topic.
        open_spaces: the namespaces in which launch files may start further nodes.
        ignored: patterns of the full names of nodes that are not compared.
    """

    system: str
    nodes: Mapping[str, ExpectedNode]
    sole_publishers: Mapping[str, str]
    open_spaces: tuple[str, ...] = ()
    ignored: tuple[str, ...] = ()

    def is_ignored(self, full_name: str) -> bool:
        """Return whether nothing is said of a node."""
        return any(fnmatchcase(full_name, each) for each in self.ignored)

    def misses(self, unseen: Unseen) -> bool:
        """Return whether something that is not seen would be compared."""
        if unseen.is_of_container and unseen.node in self.nodes:
            return bool(self.nodes[unseen.node].parameters)
        return not unseen.node or unseen.node in self.nodes

    def may_run(self, full_name: str) -> bool:
        """Return whether a node that is not among ``nodes`` may be there all the same."""
        spaces = (space.rstrip("/") + "/" for space in self.open_spaces)
        return any(full_name.startswith(space) for space in spaces)


def expectation(
    flat: FlatSystem, elsewhere: FlatSystem | None = None, ignored: Sequence[str] = ()
) -> Expectation:
    """Return what a system says of its graph.

    Args:
        flat: the system, for the values of its arguments.
        elsewhere: the same with :data:`~deros.systems.arguments.lookups.AT_START` in place of what
            it looks up where it is started: values that have it there are not compared.
        ignored: full names of nodes that are not compared, or patterns of them.
    """
    other = {each.full_name: each for each in elsewhere.nodes} if elsewhere is not None else {}
    nodes = {each.full_name: _node(each, other.get(each.full_name)) for each in flat.nodes}
    ignored = tuple(name if name.startswith("/") else f"/{name}" for name in ignored)
    expected = Expectation(
        flat.system.name,
        nodes,
        dict(_sole_publishers(flat)),
        tuple(launch.namespace for launch in flat.launches),
        ignored,
    )
    kept = {name: node for name, node in nodes.items() if not expected.is_ignored(name)}
    return replace(expected, nodes=kept)


def _node(node: FlatNode, elsewhere: FlatNode | None) -> ExpectedNode:
    ends: dict[tuple[PortKind, str], list[End]] = {}
    for port in node.ports:
        ends.setdefault((port.port.kind, port.topic), []).append(End(node, port))
    is_brought_up = node.autostart is not None or node.instance.activated_by is not None
    return ExpectedNode(
        node.full_name,
        node.statement.span if node.statement is not None else node.instance.name_span,
        ends if node.type is not None else None,
        frozenset(each.topic for each in node.untyped),
        tuple(_parameters(node, elsewhere)),
        _ACTIVE if is_brought_up else None,
        node.type is not None and node.type.lifecycle,
        _container(node),
    )


def _container(node: FlatNode) -> str | None:
    if node.container is not None:
        return from_root(node.container)
    return "" if node.is_started else None


def _parameters(node: FlatNode, elsewhere: FlatNode | None) -> Iterator[ExpectedParameter]:
    settings = {each.name: each for each in node.instance.parameters}
    changing = dict(elsewhere.parameters) if elsewhere is not None else {}
    for name, value in node.parameters:
        setting = settings.get(name)
        if (setting is not None and setting.xacro is not None) or is_at_start(changing.get(name)):
            continue
        declared = node.type.parameter_for(name) if node.type is not None else None
        of_type = BUILT_IN_PARAMETERS.get(name) if declared is None else declared.type
        place = setting or declared
        span = place.span if place is not None else None
        yield ExpectedParameter(name, value, of_type, of_type is None, span)
    if node.type is None or not all(isinstance(each.load(), Document) for each in node.files):
        return  # a file that cannot be read may set what is declared
    known = dict(node.parameters)
    for each in node.type.parameters:
        if each.name not in known and not each.keys and each.default is not None:
            yield ExpectedParameter(each.name, each.default, each.type, False, each.span)


def _sole_publishers(flat: FlatSystem) -> Iterator[tuple[str, str]]:
    """Yield topics of which one node alone is known to be the publisher, and that node."""
    open_topics = {
        topic.name
        for topic in flat.topics
        if topic.declaration.external or topic.declaration.any_publishers
    }
    open_topics |= {each.topic for node in flat.nodes for each in node.untyped}
    publishers: dict[str, set[str]] = {}
    for node in flat.nodes:
        for port in node.ports:
            is_open = port.topic in open_topics or standard_topic(port.topic, port.port.type)
            if port.port.kind is PortKind.PUBLISHER and not is_open:
                publishers.setdefault(port.topic, set()).add(node.full_name)
    for topic, names in publishers.items():
        if len(names) == 1:
            yield topic, min(names)
