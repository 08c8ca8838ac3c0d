"""The statements of a description or a system that an import may have as well as its user."""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Iterator
from dataclasses import dataclass
from typing import Any

from deros.diagnostics import Span
from deros.models.node import NodeType, Port
from deros.models.system import NodeInstance, Subsystem, System
from deros.names.graph_names import resolve_name


@dataclass(frozen=True, slots=True, eq=False)
class Statement:
    """A part of a model that has a name.

    Attributes:
        keys: what it is known by, the surest first. Two files mean the same thing where they share
            a key: a node may have another place in the text and the same name in the graph.
        what: its kind and name, in words.
        part: what it says, a dataclass of the model.
        span: where it is written.
        namespace: that it stands in, or that of what is in it.
    """

    keys: tuple[Hashable, ...]
    what: str
    part: Any
    span: Span
    namespace: str = "/"


def statements(model: NodeType | System) -> list[Statement]:
    """Return the statements of a model, each before those that stand in it."""
    return list(_of_node(model) if isinstance(model, NodeType) else _of_group(model, "/", ()))


def _of_node(model: NodeType) -> Iterator[Statement]:
    for port in model.ports:
        keys = ((port.kind, port.name), (port.kind, port.name.removeprefix("/"), "alike"))
        yield Statement(keys, f"{_word(port)} {port.name}", port, port.span)
    for kind, parts in (("parameter", model.parameters), ("timer", model.timers)):
        yield from _named(kind, parts, ())


def _word(port: Port) -> str:
    return port.kind.word.replace("_", " ")


def _named(kind: str, parts: Iterable[Any], path: tuple[str, ...]) -> Iterator[Statement]:
    for part in parts:
        yield Statement(((kind, path, part.name),), f"{kind} {part.name}", part, part.span)


def _of_group(
    group: System | Subsystem, namespace: str, path: tuple[str, ...]
) -> Iterator[Statement]:
    """Yield what stands in a system or a subsystem, and in what is in it."""
    if isinstance(group, System):
        yield from _named("argument", group.arguments, path)
        yield from _named("host", group.hosts, path)
    for file in group.files:
        what = f"parameters from {file.path}"
        yield Statement((("parameters from", path, file.path),), what, file, file.span)
    for made in group.made:
        yield Statement((("file", path, made.name),), f"file {made.name}", made, made.span)
    yield from _named("param", group.settings.parameters, path)
    yield from _named("env", group.settings.environment, path)
    yield from _named("remap", group.settings.remappings, path)
    for topic in group.topics:
        name = resolve_name(topic.name, namespace)
        what = f"topic {topic.name}"
        yield Statement((("topic", name),), what, topic, topic.span, namespace)
    for safety in group.safety:
        keys = (("safety", path, safety.path),)
        yield Statement(keys, f"safety {safety.path}", safety, safety.span)
    for process in group.processes:
        place = ("program", (*path, process.name))
        yield Statement((place,), f"process {process.name}", process, process.span)
    for member in group.members:
        yield from _of_member(member, namespace, (*path, member.name))


def _of_member(
    member: NodeInstance | Subsystem, namespace: str, path: tuple[str, ...]
) -> Iterator[Statement]:
    own = namespace if member.namespace is None else resolve_name(member.namespace, namespace)
    place = ("program", path)
    if isinstance(member, NodeInstance):
        word = "container" if member.is_container else "node"
        keys = (("node", resolve_name(member.name, own)), place)
        what = f"{word} {member.name}"
        yield Statement(keys, what, member, member.span, own)
        return
    word = "subsystem" if member.launch is None else "launch"
    yield Statement((place,), f"{word} {member.name}", member, member.span, own)
    yield from _of_group(member, own, path)
