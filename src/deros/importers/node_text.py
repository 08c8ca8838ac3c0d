"""Node descriptions as imports write them: two parts, and what is left out in comments."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from deros.generators.node.description import quoted_text
from deros.interfaces.durations import duration_text
from deros.interfaces.types import InterfaceType
from deros.models.common import QosProfile
from deros.models.node import PortKind

_KEYWORDS = {
    PortKind.PUBLISHER: "topic",
    PortKind.SUBSCRIPTION: "topic",
    PortKind.SERVICE: "service",
    PortKind.CLIENT: "client",
    PortKind.ACTION: "action",
    PortKind.ACTION_CLIENT: "action",
}

UNKNOWN_PACKAGE = "unknown_package"
"""The package of a node whose source does not name it."""


def head(
    name: str,
    package: str,
    program: str,
    why: str = "",
    description: str = "",
    plugin: str = "",
) -> str:
    """Return the part of a description that people write.

    Args:
        name: of the node type.
        package: where its program is.
        program: its executable.
        why: a comment for whoever reads it; empty for none.
        description: of the node; empty for none.
        plugin: the class that a container loads; empty for none.
    """
    comment = f"// {why}\n" if why else ""
    text = f" {quoted_text(description)}" if description else ""
    line = f"plugin {quoted_text(plugin)}" if plugin else f"executable {quoted_text(program)}"
    return f"{comment}node {name} : {package}{text}\n{line}\n"


def body(
    *,
    lifecycle: bool,
    parameters: Sequence[str],
    ports: Sequence[tuple[PortKind, str]],
    left_out: Iterable[str],
) -> str:
    """Return the part that is imported.

    Args:
        lifecycle: whether the node is managed.
        parameters: the lines of their section, its keyword among them; empty for no section.
        ports: the line of each, see :func:`port_line`.
        left_out: what the description does not say, and why.
    """
    sections: list[Sequence[str]] = [["lifecycle"]] if lifecycle else []
    if parameters:
        sections.append(parameters)
    for kind in PortKind:
        lines = [f"  {line}" for of, line in ports if of is kind]
        if lines:
            sections.append([kind.value, *lines])
    if comments := [f"// {each}" for each in left_out]:
        sections.append(comments)
    text = "\n\n".join("\n".join(lines) for lines in sections)
    return f"{text}\n" if text else ""


def port_line(
    kind: PortKind,
    name: str,
    of_type: InterfaceType,
    qos: QosProfile | None,
    description: str = "",
) -> str:
    """Return the line that declares a port."""
    text = f" {quoted_text(description)}" if description else ""
    return f"{_KEYWORDS[kind]} {name} : {of_type.short}{qos_clause(qos)}{text}"


def wired(kind: PortKind, name: str, ports: Iterable[str]) -> str:
    """Return a port as a wiring names it, where ``ports`` are the names of all of its node.

    Its kind stands before a name that another port has, too. Behind a kind, the word ``to`` would
    not be read as a name.
    """
    names = [each.removeprefix("/") for each in ports]
    if names.count(name.removeprefix("/")) == 1:
        return name
    return f'{kind.word} "to"' if name == "to" else f"{kind.word} {name}"


def qos_clause(profile: QosProfile | None) -> str:
    """Return the policies of a port with a blank before them; nothing for none."""
    if profile is None:
        return ""
    words = [profile.preset, profile.reliability, profile.durability]
    if profile.keep_all:
        words.append("keep_all")
    if profile.depth is not None:
        words.append(f"depth {profile.depth}")
    if profile.deadline_ns is not None:
        words.append(f"deadline {duration_text(profile.deadline_ns)}")
    if profile.lifespan_ns is not None:
        words.append(f"lifespan {duration_text(profile.lifespan_ns)}")
    if profile.liveliness is not None:
        words.append(f"liveliness {profile.liveliness}")
    if profile.lease_ns is not None:
        words.append(f"lease {duration_text(profile.lease_ns)}")
    stated = [word for word in words if word]
    return " ".join([" qos", *stated]) if stated else ""
