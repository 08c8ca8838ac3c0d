"""What the page of a system holds, as plain data for :mod:`json`.

What is computed from arguments is a tree, see :mod:`deros.report.page.expressions`: that is what a
field of type ``Json`` may be. Lists of ``findings`` are positions in :attr:`Contents.findings`.
"""

from __future__ import annotations

from dataclasses import dataclass

from deros.diagnostics import Span
from deros.report.page.expressions import Json


@dataclass(frozen=True, slots=True)
class Place:
    """Where something is written; lines count from 1."""

    file: str
    line: int


@dataclass(frozen=True, slots=True)
class Argument:
    """An argument of the system, as a switch of the page.

    Attributes:
        default: its value, or the tree that it is computed from; ``None``: it has to be given.
        usual: the value that the page shows first where it has no default.
        choices: the values that it may have, if they are listed.
        bounds: of a number: lower, upper, and whether each of these belongs to it.
        limits: the same in words.
    """

    name: str
    type: str
    default: Json
    usual: Json
    choices: tuple[Json, ...]
    bounds: tuple[Json, Json, bool, bool] | None
    limits: str
    unit: str
    description: str


@dataclass(frozen=True, slots=True)
class Lookup:
    """What is looked up where the system is started, with the text that stands for it."""

    key: str
    usual: str | bool


@dataclass(frozen=True, slots=True)
class Port:
    """A port of a node, and the end that it has in the ROS graph.

    Attributes:
        channel: ``topic``, ``service`` or ``action``.
        feeds: whether data or requests leave the node here.
        directed: whether that is known; of a parameter that no port claims, it is not.
        to: the graph name that it is connected to.
        qos: its policies in words; of a topic only.
        assumed: whether the QoS is only assumed, because nothing states one.
        wired: whether the system connects it.
        units: such as ``"ranges [m]"``.
    """

    name: str
    kind: str
    channel: str
    feeds: bool
    directed: bool
    to: Json
    type: str
    qos: str
    assumed: bool
    wired: bool
    units: tuple[str, ...]
    description: str
    place: Place
    findings: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Program:
    """A node of the system, or another process.

    Attributes:
        kind: ``node``, ``safety`` (a node made of rules) or ``process``.
        full_name: in the ROS graph; of a process, with its subsystems.
        path: the subsystems that hold it.
        when: the condition under which it is there in this form.
        type: of a node; of a process, what it runs.
        host: the computer that it runs on, if the system says so.
        declared: where the type is described; ``None`` if no import defines it.
    """

    kind: str
    name: str
    full_name: Json
    path: tuple[str, ...]
    when: Json
    type: Json
    package: str
    executable: str
    host: str
    lifecycle: bool
    description: str
    parameters: tuple[tuple[str, Json], ...]
    ports: tuple[Port, ...]
    place: Place
    declared: Place | None
    findings: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Topic:
    """A declared topic; ``type`` and ``qos`` are empty if it pins none."""

    name: Json
    path: tuple[str, ...]
    when: Json
    type: str
    qos: str
    external: bool
    units: tuple[str, ...]
    description: str
    place: Place
    findings: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Group:
    """A subsystem; ``system`` is the system that it uses, if any."""

    path: tuple[str, ...]
    system: str
    description: str
    place: Place
    findings: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Finding:
    """A finding of the check.

    Attributes:
        others: other places that are relevant.
        where: the values of arguments with which it was found, if it depends on any.
    """

    code: str
    slug: str
    severity: str
    message: str
    hint: str
    place: Place
    others: tuple[tuple[Place, str], ...]
    where: tuple[tuple[str, Json], ...]


@dataclass(frozen=True, slots=True)
class Contents:
    """All that a page shows; ``note`` says what it cannot."""

    name: str
    description: str
    version: str
    note: str
    arguments: tuple[Argument, ...]
    lookups: tuple[Lookup, ...]
    groups: tuple[Group, ...]
    programs: tuple[Program, ...]
    topics: tuple[Topic, ...]
    findings: tuple[Finding, ...]


def place_of(span: Span) -> Place:
    """Return where a span begins."""
    return Place(span.file, span.line)
