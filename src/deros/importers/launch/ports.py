"""Remappings of a node: connections of the ports that its description has, and others."""

from __future__ import annotations

from collections.abc import Iterator

from deros.importers.launch.blocks import Group, Line, text
from deros.importers.launch.entities import Entity
from deros.importers.launch.scopes import File, Scope, line_of
from deros.importers.launch.values.conditions import literally
from deros.importers.launch.values.substitutions import InexpressibleError
from deros.importers.node_text import wired
from deros.models.arguments import Expression, Interpolation, Literally
from deros.models.node import NodeType, Port, PortKind
from deros.names.graph_names import resolve_name
from deros.names.names import check_topic_name

_TOPICS = (PortKind.PUBLISHER, PortKind.SUBSCRIPTION)
_CLIENTS = (PortKind.CLIENT, PortKind.ACTION_CLIENT)
_SCHEMES = {"rostopic://": True, "rosservice://": False}


def remapped(
    file: File,
    scope: Scope,
    group: Group,
    entity: Entity,
    model: NodeType | None,
    name: str,
    space: Expression | None,
    is_sure: bool,
) -> Iterator[Line]:
    """Yield the sections with the connections and remappings of a node.

    Args:
        file: it stands in.
        scope: it stands in.
        group: that it is put into.
        entity: that it is.
        model: its description, if there is one.
        name: its own.
        space: its namespace within the group.
        is_sure: whether it is there in any case.
    """
    namer = _Namer(group, name, space)
    others: list[tuple[Entity, Expression, Expression]] = []
    targets: dict[tuple[str, bool | None], tuple[Entity, Expression]] = {}
    for each in entity.details("remap"):
        try:
            source, target = _pair(file, scope, each)
        except InexpressibleError as error:
            file.refuse("'remap'", f"is left out: it {error}", each.line)
            continue
        file.left(each)
        if model is not None and isinstance(source, Literally):
            bare, kinds = _without_scheme(str(source.value))
            if namer.same(model, bare, kinds):
                targets.setdefault((namer.full(bare), kinds), (each, target))
                continue
        others.append((each, source, target))
    if model is not None:
        yield from _connections(file, entity, model, namer, targets, is_sure)
    if others:
        yield line_of(entity, "remappings")
    for place, source, target in others:
        parts = ("remap ", text(source), " to ", text(target))
        yield line_of(place, *parts, depth=1, what="'remap'")


def _pair(file: File, scope: Scope, entity: Entity) -> tuple[Expression, Expression]:
    read = file.expressions(scope)
    source, target = read.of(entity.needed("from")), read.of(entity.needed("to"))
    if isinstance(source, Literally) and str(source.value) in scope.remapped:
        raise InexpressibleError("is for a name that 'set_remap' has remapped before")
    for each in (source, target):
        if isinstance(each, Literally):
            bare, _ = _without_scheme(str(each.value))
            if why := check_topic_name(bare):
                raise InexpressibleError(f"has the name '{each.value}', which {why}")
    return source, target


def _without_scheme(name: str) -> tuple[str, bool | None]:
    """Return a name without what says that it is for topics, or for services, and which it is."""
    for scheme, is_topic in _SCHEMES.items():
        if name.startswith(scheme):
            return name.removeprefix(scheme), is_topic
    return name, None


class _Namer:
    """Knows the full names of a node as far as its namespaces are literal."""

    def __init__(self, group: Group, name: str, space: Expression | None) -> None:
        self.group = group
        self._name = name
        spaces = (*group.namespaces, *([] if space is None else [space]))
        self.is_known = all(isinstance(each, Literally) for each in spaces)
        self._space = "/"
        for each in spaces:
            if isinstance(each, Literally):
                self._space = resolve_name(str(each.value), self._space, "")

    def full(self, name: str) -> str:
        """Return the full name; where the namespace is not known, one that is as good."""
        return resolve_name(name, self._space, self._name)

    def same(self, model: NodeType, name: str, topics: bool | None) -> bool:
        """Return whether a port has a name."""
        return any(
            self.full(port.name) == self.full(name)
            for port in model.ports
            if port.via is None and (topics is None or topics == (port.kind in _TOPICS))
        )

    def declared(self, target: Expression) -> tuple[bool, Expression]:
        """Return the name by which a topic is declared, and whether that is for all."""
        if isinstance(target, Literally):
            name = str(target.value)
            if self.is_known or name.startswith("/"):
                return True, literally(self.full(name))
            inner = f"{self._name}/{name[2:]}" if name.startswith("~/") else name
            return False, literally(inner)
        first = target.pieces[0] if isinstance(target, Interpolation) else None
        return isinstance(first, str) and first.startswith("/"), target


def _connections(
    file: File,
    entity: Entity,
    model: NodeType,
    namer: _Namer,
    targets: dict[tuple[str, bool | None], tuple[Entity, Expression]],
    is_sure: bool,
) -> Iterator[Line]:
    """Yield the connections of all ports that can have one."""
    lines = list(_wirings(file, entity, model, namer, targets, is_sure))
    if lines:
        yield line_of(entity, "wirings")
        yield from lines


def _wirings(
    file: File,
    entity: Entity,
    model: NodeType,
    namer: _Namer,
    targets: dict[tuple[str, bool | None], tuple[Entity, Expression]],
    is_sure: bool,
) -> Iterator[Line]:
    names = [port.name for port in model.ports]
    for port in model.ports:
        if port.via is not None:
            continue
        is_topic = port.kind in _TOPICS
        full = namer.full(port.name)
        place, target = targets.get((full, is_topic)) or targets.get((full, None)) or (None, None)
        if target is None:
            if not is_topic and port.kind not in _CLIENTS:
                continue
            target = literally(port.name)
        if is_topic:
            _declare(file, entity, port, namer, target, is_sure)
        parts = (f"connect {wired(port.kind, port.name, names)} to ", text(target))
        yield line_of(place or entity, *parts, depth=1, what=f"the connection of '{port.name}'")


def _declare(
    file: File, entity: Entity, port: Port, namer: _Namer, target: Expression, is_sure: bool
) -> None:
    """Declare the topic of a port: with its ends, or as one that may have others."""
    is_global, name = namer.declared(target)
    if is_global and isinstance(name, Literally):
        file.topics.setdefault(str(name.value), []).append((port.kind, is_sure))
        return
    group = file.root if is_global else namer.group
    known = file.open_topics.setdefault(id(group), set())
    if repr(name) not in known:
        known.add(repr(name))
        line = line_of(entity, "external topic ", text(name), what="a topic")
        group.settings.setdefault("topics", []).append(line)


def topics(file: File) -> None:
    """Declare the topics whose full names are known."""
    lines = file.root.settings.setdefault("topics", [])
    for name, ends in sorted(file.topics.items()):
        sure = {kind for kind, is_sure in ends if is_sure}
        outside = "" if sure.issuperset(_TOPICS) else "external "
        several = " publishers any" if [k for k, _ in ends].count(PortKind.PUBLISHER) > 1 else ""
        lines.append(Line((f"{outside}topic {name}{several}",), "a topic", 0))
