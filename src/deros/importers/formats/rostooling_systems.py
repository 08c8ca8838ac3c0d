"""System models of RosTooling (``*.rossystem``): nodes, what they connect, and subsystems.

Source: the grammar RosSystem.xtext of RosTooling, and the launch files that its
LaunchFileCompiler_ROS2 makes: an interface is remapped to its name in the system, and all ends of a
connection to the name of the first one.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

from deros.diagnostics import SourceFile, Span
from deros.importers.formats import loading
from deros.importers.formats.rostooling_nodes import ReadNode, entries, tree_of
from deros.importers.readers import UnreadableError
from deros.importers.results import Missing
from deros.metamodels.yaml_trees import tree as yaml
from deros.models.node import Port, PortKind
from deros.names.graph_names import resolve_name
from deros.names.names import check_namespace, check_node_name, check_topic_name

_KINDS = {
    "pub": PortKind.PUBLISHER,
    "sub": PortKind.SUBSCRIPTION,
    "ss": PortKind.SERVICE,
    "sc": PortKind.CLIENT,
    "as": PortKind.ACTION,
    "ac": PortKind.ACTION_CLIENT,
}
_TO = {
    PortKind.PUBLISHER: PortKind.SUBSCRIPTION,
    PortKind.SERVICE: PortKind.CLIENT,
    PortKind.ACTION: PortKind.ACTION_CLIENT,
}
_WITHOUT_PLACE = {
    "processes": ("process", "write its nodes into a container"),
    "parameters": ("parameter", "it is of the whole system, and no node is said to use it"),
}
_REFERENCE = re.compile(r"""(pub|sub|ss|sc|as|ac)->\s*(["']?)(.+?)\2\s*""")


@dataclass(frozen=True, slots=True)
class Interface:
    """A port of a node by its name in the system."""

    name: str
    port: Port
    span: Span


@dataclass
class Instance:
    """A node of a system.

    Attributes:
        settings: the values of parameters, with their names and places.
        graph_names: of ports that do not have their own.
    """

    name: str
    namespace: str
    read: ReadNode
    span: Span
    interfaces: list[Interface] = field(default_factory=list)
    settings: list[tuple[str, yaml.Tree]] = field(default_factory=list)
    graph_names: dict[tuple[PortKind, str], str] = field(default_factory=dict)

    @property
    def full_name(self) -> str:
        """The name in the graph."""
        return resolve_name(self.name, self.namespace)

    def resolved(self, name: str) -> str:
        """Return the graph name of a name of this node."""
        return resolve_name(name, self.namespace, self.name)

    def graph_name(self, port: Port) -> str:
        """Return the graph name of a port."""
        return self.graph_names.get((port.kind, port.name)) or self.resolved(port.name)


@dataclass
class ReadSystem:
    """A system, its own nodes first.

    Attributes:
        inside: the names of its subsystems, and their places.
        origin: its launch file, for people; empty if it is not said.
    """

    name: str
    instances: list[Instance]
    inside: list[tuple[str, Span]]
    missing: list[Missing]
    origin: str = ""


def read_systems(source: SourceFile, known: Sequence[ReadNode]) -> list[ReadSystem]:
    """Return the systems of a file.

    Args:
        source: the text.
        known: the node types that they may have.

    Raises:
        UnreadableError: if it cannot be read.
    """
    top = tree_of(source)
    systems = [_Reader(name, tree, known).system for name, tree in top.entries.items()]
    if not systems:
        raise UnreadableError(f"{source.path}: this file has no system")
    systems[0].missing[:0] = loading.unused_keys(top)
    return systems


class _Reader:
    """Reads one system."""

    def __init__(self, name: str, tree: yaml.Tree, known: Sequence[ReadNode]) -> None:
        self.system = ReadSystem(name, [], [], [])
        self._known = known
        connections: yaml.Tree | None = None
        for key, value in entries(tree, f"system '{name}'", self.system.missing):
            if key == "nodes":
                self._nodes(value)
            elif key == "subSystems":
                self.system.inside += _words(value)
            elif key == "connections":
                connections = value
            elif key == "fromFile":
                self.system.origin = _text(value)
            else:
                self._lack_all(key, value)
        # Names of interfaces first, then connections, which may change them.
        for instance in self.system.instances:
            self._names(instance)
        if connections is not None:
            self._connections(connections)

    def _lack(self, what: str, why: str, at: yaml.Tree | Span) -> None:
        span = at if isinstance(at, Span) else at.span
        self.system.missing.append(loading.missing(what, why, span))

    def _lack_all(self, key: str, value: yaml.Tree) -> None:
        """Note what stands below a key that models have no place for."""
        if key not in _WITHOUT_PLACE:
            self._lack(f"'{key}'", "is left out: a system has nothing of that name", value)
            return
        word, why = _WITHOUT_PLACE[key]
        for name, _ in entries(value, f"'{key}'", self.system.missing):
            assert isinstance(value, yaml.Mapping)
            self._lack(f"{word} '{name}'", f"is left out: {why}", value.keys[name])

    # Nodes ---------------------------------------------------------------------------------------

    def _nodes(self, tree: yaml.Tree) -> None:
        for name, said in entries(tree, "'nodes'", self.system.missing):
            assert isinstance(tree, yaml.Mapping)
            self._node(name, said, tree.keys[name])

    def _node(self, name: str, tree: yaml.Tree, place: Span) -> None:
        what = f"node '{name}'"
        said = dict(entries(tree, what, self.system.missing))
        if fault := check_node_name(name):
            self._lack(what, f"is left out: its name {fault}", place)
            return
        stated = said.pop("from", None)
        of = stated.text if isinstance(stated, yaml.Scalar) else ""
        read = next((each for each in self._known if each.is_called(of)), None)
        if read is None:
            self._lack(what, f"is left out: none of the files has its type '{of}'", place)
            return
        instance = Instance(name, self._namespace(what, said.pop("namespace", None)), read, place)
        taken = (each.full_name for each in self.system.instances)
        if instance.full_name in taken:
            self._lack(what, "is left out: another one has its full name", place)
            return
        self.system.instances.append(instance)
        for key, value in said.items():
            if key == "interfaces":
                self._interfaces(instance, value)
            elif key == "parameters":
                self._settings(instance, value)
            else:
                self._lack(what, f"has '{key}', which is not known", value)

    def _namespace(self, what: str, tree: yaml.Tree | None) -> str:
        if not isinstance(tree, yaml.Scalar) or not tree.text:
            return "/"
        name = tree.text if tree.text.startswith("/") else f"/{tree.text}"
        if fault := check_namespace(name):
            self._lack(what, f"is in no namespace here: '{tree.text}' {fault}", tree)
            return "/"
        return name

    def _pairs(self, tree: yaml.Tree, what: str) -> Iterator[tuple[str, yaml.Mapping]]:
        """Yield the entries of a list of keys, each by its first key."""
        items = tree.items if isinstance(tree, yaml.Sequence) else ()
        for each in items:
            if isinstance(each, yaml.Mapping) and each.entries:
                yield next(iter(each.entries)), each
            else:
                self._lack(f"an entry of {what}", "cannot be read", each)
        if not isinstance(tree, yaml.Sequence) and not _is_empty(tree):
            self._lack(what, "are no list", tree)

    def _interfaces(self, instance: Instance, tree: yaml.Tree) -> None:
        for name, said in self._pairs(tree, f"'interfaces' of '{instance.name}'"):
            what = f"interface '{name}' of '{instance.name}'"
            place, stated = said.keys[name], said.entries[name]
            text = stated.text if isinstance(stated, yaml.Scalar) else ""
            found = _REFERENCE.fullmatch(text)
            if found is None:
                self._lack(what, f"cannot be read: '{text}'", place)
                continue
            port_name = found[3].rpartition("::")[2] or found[3]
            kind = _KINDS[found[1]]
            port = instance.read.draft.node.port(port_name, kind)
            if port is None:
                why = f"is left out: the type has no {kind.word} '{port_name}' here"
                self._lack(what, why, place)
                continue
            instance.interfaces.append(Interface(name, port, place))

    def _settings(self, instance: Instance, tree: yaml.Tree) -> None:
        for name, said in self._pairs(tree, f"'parameters' of '{instance.name}'"):
            stated, value = said.entries[name], said.get("value")
            text = stated.text if isinstance(stated, yaml.Scalar) else ""
            if value is None:
                what = f"parameter '{name}' of '{instance.name}'"
                self._lack(what, "is left out: it has no value", said.keys[name])
                continue
            instance.settings.append((text.rpartition("::")[2] or name, value))

    # Names ---------------------------------------------------------------------------------------

    def _names(self, instance: Instance) -> None:
        for each in instance.interfaces:
            full = instance.resolved(each.name)
            if fault := check_topic_name(full):
                what = f"interface '{each.name}' of '{instance.name}'"
                self._lack(what, f"has no name of its own here: it {fault}", each.span)
            else:
                instance.graph_names[each.port.kind, each.port.name] = full

    def _connections(self, tree: yaml.Tree) -> None:
        items = tree.items if isinstance(tree, yaml.Sequence) else ()
        if not isinstance(tree, yaml.Sequence) and not _is_empty(tree):
            self._lack("'connections'", "are no list", tree)
        for each in items:
            ends = each.items if isinstance(each, yaml.Sequence) else ()
            names = [end.text for end in ends if isinstance(end, yaml.Scalar)]
            if len(names) == len(ends) == 2:
                self._connect(names[0], names[1], each.span)
            else:
                self._lack("a connection", "cannot be read: it has two ends, '[from, to]'", each)

    def _connect(self, first: str, second: str, span: Span) -> None:
        what = f"connection of '{first}' and '{second}'"
        sources = self._called(first, is_source=True) or self._called(second, is_source=True)
        targets = self._called(second, is_source=False) or self._called(first, is_source=False)
        pairs = [
            (source, target)
            for source in sources
            for target in targets
            if _TO[source[1].port.kind] is target[1].port.kind
        ]
        if not pairs:
            why = "is left out: there are no interfaces of these names that could be connected"
            self._lack(what, why, span)
        for (instance, source), (other, target) in pairs:
            if source.port.type != target.port.type:
                why = f"is left out: {source.port.type} is not {target.port.type}"
                self._lack(what, why, span)
            else:
                name = instance.graph_name(source.port)
                other.graph_names[target.port.kind, target.port.name] = name

    def _called(self, name: str, *, is_source: bool) -> list[tuple[Instance, Interface]]:
        return [
            (instance, each)
            for instance in self.system.instances
            for each in instance.interfaces
            if each.name == name and (each.port.kind in _TO) is is_source
        ]


def _text(tree: yaml.Tree) -> str:
    return loading.shown(tree.text) if isinstance(tree, yaml.Scalar) else ""


def _is_empty(tree: yaml.Tree) -> bool:
    return isinstance(tree, yaml.Scalar) and tree.value is None


def _words(tree: yaml.Tree) -> Iterator[tuple[str, Span]]:
    """Yield the names of a list; RosTooling writes them below one another without any sign."""
    if isinstance(tree, yaml.Scalar):
        yield from ((word.strip("\"'"), tree.span) for word in tree.text.split())
    elif isinstance(tree, yaml.Sequence):
        for each in tree.items:
            yield from _words(each)
    else:
        yield from tree.keys.items()
