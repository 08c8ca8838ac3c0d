"""Changes of system descriptions (``*.system``): of what runs, not of how it is written."""

from __future__ import annotations

from collections.abc import Iterator

from deros.diff.changes import Aspect, Change, PartKind, breaking, changed, compare
from deros.diff.channels import compare_channels
from deros.diff.expressions import expression_text
from deros.diff.nodes import parameter_aspects, parameter_text
from deros.diff.programs import compare_programs
from deros.diff.symbolic import Version
from deros.diff.texts import value_text
from deros.models.arguments import Expression
from deros.models.node import Parameter
from deros.models.starting import Host
from deros.models.system import System

SYSTEM: PartKind[System] = PartKind(
    "system",
    lambda s: s.name,
    lambda s: s.name_span,
    (
        Aspect("name", lambda s: s.name, breaking("systems that use it, and rules")),
        Aspect("description", lambda s: s.description, say=value_text),
    ),
    lambda _: "",
    removed=lambda _: "systems that use it, and rules",
)

ARGUMENT: PartKind[Parameter] = PartKind(
    "argument",
    lambda a: a.name,
    lambda a: a.name_span,
    parameter_aspects(),
    parameter_text,
    removed=lambda _: "whoever gives it a value gives one that is not declared",
    added=lambda a: "" if a.has_default else "it has to be given, and nobody does so yet",
)


def _text(plain: str, computed: Expression | None) -> str:
    return plain if computed is None else expression_text(computed)


HOST: PartKind[Host] = PartKind(
    "host",
    lambda h: h.name,
    lambda h: h.name_span,
    (
        Aspect("address", lambda h: _text(h.address, h.address_from)),
        Aspect("setup", lambda h: _text(h.setup, h.setup_from)),
        Aspect("description", lambda h: h.description, say=value_text),
    ),
    lambda h: _text(h.address, h.address_from),
    removed=lambda _: "whoever starts what is on it, by host:=NAME",
)


def compare_systems(old: System, new: System) -> Iterator[Change]:
    """Yield the changes from one version of a system to another.

    Raises:
        TooManyCombinations: of the arguments that the conditions of one of them depend on.
    """
    yield from changed(SYSTEM, old, new)
    yield from compare(ARGUMENT, old.arguments, new.arguments)
    yield from compare(HOST, old.hosts, new.hosts)
    before, after = Version(old), Version(new)
    yield from compare_programs(before, after)
    yield from compare_channels(before, after)
