"""Checks of names in a system description: valid in ROS 2, declared once, imports used."""

from __future__ import annotations

from collections.abc import Iterator

from deros import codes
from deros.diagnostics import Diagnostic, Related, Span, report
from deros.interfaces.store import InterfaceStore
from deros.interfaces.units import UnitRegistry
from deros.models.system import NodeInstance, Subsystem, System
from deros.names.names import (
    check_namespace,
    check_node_name,
    check_topic_name,
    is_too_long,
)
from deros.systems.flat import FlatNode, FlatSystem, FlatTopic
from deros.systems.groups import groups_of
from deros.validators.node.field_units import check_field_unit
from deros.validators.node.interfaces import type_finding
from deros.validators.wiring.graph import is_one_gate


def check_names(flat: FlatSystem, store: InterfaceStore) -> Iterator[Diagnostic]:
    """Yield the findings about names that ``flat.system`` itself writes, not its imports."""
    system = flat.system
    yield from _refused(check_node_name(system.name), system.name, system.name_span)
    # The name of a declared topic is checked where it is declared, not again at every wiring.
    known = frozenset(topic.declaration.name for topic in flat.topics)
    yield from _members(system.members, known)
    yield from _topics(flat, store)
    yield from _full_names(flat)
    yield from _unused_imports(system)
    yield from _one_full_name(flat)


def refused_names(system: System) -> Iterator[Diagnostic]:
    """Yield the topics, namespaces and names of ends in a system's own file that ROS 2 rejects."""
    topics = [each for _, group in groups_of(system) for each in group.topics]
    for each in topics:
        yield from _refused(check_topic_name(each.name), each.name, each.name_span)
    yield from _members(system.members, frozenset(each.name for each in topics))


def _refused(fault: str | None, name: str, span: Span | None) -> Iterator[Diagnostic]:
    if fault is not None and span is not None:
        yield report(
            codes.INVALID_SYSTEM_NAME, f"ROS 2 rejects the name '{name}': it {fault}", span
        )


def _members(
    members: tuple[NodeInstance | Subsystem, ...], known: frozenset[str]
) -> Iterator[Diagnostic]:
    seen: dict[str, Subsystem] = {}
    for member in members:
        if member.namespace is not None:
            fault = check_namespace(member.namespace)
            yield from _refused(fault, member.namespace, member.namespace_span)
        yield from _refused(check_node_name(member.name), member.name, member.name_span)
        if isinstance(member, NodeInstance):
            for wiring in member.wirings:
                if wiring.target not in known:
                    fault = check_topic_name(wiring.target)
                    yield from _refused(fault, wiring.target, wiring.target_span)
            if member.into is not None and member.into.braces is None:
                name = member.into.container
                fault = "names no node" if name == "/" else check_namespace(name)
                yield from _refused(fault, name, member.into.container_span)
            continue
        first = seen.setdefault(member.name, member)
        if first is not member:
            what = "subsystem" if first.launch is None else "launch file"
            hint = "give one of them another name, or put their nodes into one subsystem"
            yield report(
                codes.DUPLICATE_SUBSYSTEM,
                f"there is already a {what} '{member.name}' here",
                member.name_span,
                hint=hint if member.launch is None else "give it another name, with 'as NAME'",
                related=(Related(first.name_span, "the first one"),),
            )
        yield from _members(member.members, known)


def _topics(flat: FlatSystem, store: InterfaceStore) -> Iterator[Diagnostic]:
    """Check the topics that this file declares: names, pinned types, each declared once."""
    seen: dict[str, FlatTopic] = {}
    units = UnitRegistry()
    for topic in flat.topics:
        declaration = topic.declaration
        if declaration.span.source is not flat.system.source:
            continue
        fault = check_topic_name(declaration.name)
        if fault is None and declaration.name.startswith("~"):
            fault = "is private ('~'), and only a topic of a node can be"
        yield from _refused(fault, declaration.name, declaration.name_span)
        if declaration.type is not None and declaration.type_span is not None:
            missing = list(type_finding(store, declaration.type, declaration.type_span))
            yield from missing
            if not missing:
                for each in declaration.units:
                    yield from check_field_unit(declaration.type, each, store, units)
        first = seen.setdefault(topic.name, topic)
        if first is not topic:
            yield report(
                codes.DUPLICATE_TOPIC,
                f"topic '{topic.name}' is declared twice",
                declaration.name_span,
                hint="keep one of the two declarations",
                related=(Related(first.declaration.name_span, "the first declaration"),),
            )


def _full_names(flat: FlatSystem) -> Iterator[Diagnostic]:
    """Yield full names that are too long."""
    own = flat.system.source
    for topic in flat.topics:
        if topic.declaration.span.source is own:
            yield from _long(topic.declaration.name, topic.name, topic.declaration.name_span)
    for node in flat.nodes:
        if node.instance.span.source is not own:
            continue
        yield from _long(node.instance.name, node.full_name, node.instance.name_span)
        for port in node.ports:
            place = port.wiring.target_span if port.wiring else node.instance.name_span
            yield from _long(port.wiring.target if port.wiring else "", port.topic, place)


def _long(written: str, full: str, span: Span) -> Iterator[Diagnostic]:
    if is_too_long(full) and not is_too_long(written):
        message = f"'{full}' is longer than a full name can be in ROS 2"
        yield report(codes.INVALID_SYSTEM_NAME, message, span, hint="shorten the namespaces")


def _unused_imports(system: System) -> Iterator[Diagnostic]:
    used = set(_used_files(system.members))
    if None in used:
        return  # the node whose type is not known may be the one that an import is there for
    defining = {t.source.path for t in system.node_types.values()}
    defining.update(s.source.path for s in system.systems.values())
    for line in system.imports:
        # A file that defines nothing has a separate finding; it is not also reported as unused.
        files = defining.intersection(line.files)
        if files and used.isdisjoint(files):
            yield report(
                codes.UNUSED_IMPORT,
                f'the import of "{line.path}" is not used',
                line.span,
                hint="remove the import, or add the node that it was meant for",
            )


def _used_files(members: tuple[NodeInstance | Subsystem, ...]) -> Iterator[str | None]:
    """Yield the files that the members' types come from, ``None`` for a type that is not known."""
    for member in members:
        if isinstance(member, NodeInstance):
            yield member.type.source.path if member.type is not None else None
            continue
        if member.system_name is not None:
            yield member.system.source.path if member.system is not None else None
        yield from _used_files(member.members)


def _one_full_name(flat: FlatSystem) -> Iterator[Diagnostic]:
    seen: dict[str, FlatNode] = {}
    for node in flat.nodes:
        first = seen.setdefault(node.full_name, node)
        if first is node or _is_matter_of_import(flat.system, first, node):
            continue
        if is_one_gate(first, node):
            continue
        yield report(
            codes.DUPLICATE_NODE_NAME,
            f"two nodes are called '{node.full_name}'",
            _place(flat.system, node),
            hint="rename one, or give it or its subsystem a namespace",
            related=(Related(_place(flat.system, first), "the other one"),),
        )


def _is_matter_of_import(system: System, first: FlatNode, second: FlatNode) -> bool:
    """Return whether two nodes collide within one imported file, whose own check reports them."""
    source = second.instance.span.source
    return (
        source is not system.source
        and first.instance.span.source is source
        and first.instance.name_span != second.instance.name_span
    )


def _place(system: System, node: FlatNode) -> Span:
    """Return where ``system`` adds the node: itself, or by using an imported system."""
    if node.instance.span.source is system.source:
        return node.instance.name_span
    members: tuple[NodeInstance | Subsystem, ...] = system.members
    for name in node.path:
        group = next(m for m in members if isinstance(m, Subsystem) and m.name == name)
        if group.system_name is not None:
            return group.name_span
        members = group.members
    return node.instance.name_span
