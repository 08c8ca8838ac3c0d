"""On which computer each program of a system is started.

To whatever starts it, a system with hosts is one with a further argument, ``host``: what is placed
on a host is there for that host, and for ``all``. Checks see the whole system, as it runs.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TypeVar

from deros.diagnostics import Span
from deros.models.arguments import Argument, Condition, Literally, OneOf, both
from deros.models.common import Name
from deros.models.node import Parameter, ParameterType
from deros.models.programs import ProcessInstance
from deros.models.system import NodeInstance, SafetyInstance, Subsystem, System

HOST = "host"
"""The argument that says on which computer a system is started."""
EVERYWHERE = "all"
"""Its value where everything is started on one."""

_Placed = TypeVar("_Placed", NodeInstance, SafetyInstance, ProcessInstance, Subsystem)
Member = NodeInstance | SafetyInstance | ProcessInstance | Subsystem


def placed(system: System) -> System:
    """Return a system whose programs are there for the hosts that they are on.

    Args:
        system: as written; of systems that it uses, the places are those that it gives them.
    """
    if not system.hosts:
        return system
    argument = Parameter(
        HOST,
        ParameterType.STRING,
        None,
        system.hosts[0].span,
        system.hosts[0].name_span,
        choices=(EVERYWHERE, *(each.name for each in system.hosts)),
        description="The computer that this is started on; all: everything on this one",
    )
    found = _group(system, system.host)
    return replace(found, arguments=(argument, *system.arguments), is_computed=True)


_Group = TypeVar("_Group", System, Subsystem)


def _group(group: _Group, around: Name | None) -> _Group:
    return replace(
        group,
        members=tuple(
            _placed(each, around) if isinstance(each, NodeInstance) else _subsystem(each, around)
            for each in group.members
        ),
        safety=tuple(_placed(each, around) for each in group.safety),
        processes=tuple(_placed(each, around) for each in group.processes),
    )


def _subsystem(part: Subsystem, around: Name | None) -> Subsystem:
    return _placed(part, around) if _is_one(part) else _group(part, part.host or around)


def _is_one(part: Subsystem) -> bool:
    """Return whether a subsystem is as a whole on one host."""
    return part.system is not None or part.launch is not None


def _placed(part: _Placed, around: Name | None) -> _Placed:
    if isinstance(part, NodeInstance) and part.inside is not None:
        return part  # where the program is in whose process it is
    host = part.host or around
    return part if host is None else replace(part, when=both(part.when, _is_on(host)))


def _is_on(host: Name) -> Condition:
    span: Span = host.span
    choices = Literally(EVERYWHERE, span), Literally(host.text, span)
    return OneOf(Argument(HOST, span), choices, span)


def programs_of(system: System) -> Iterator[tuple[Member, Name | None]]:
    """Yield the programs, launch files and used systems of a system, with their hosts."""
    yield from _programs(system, system.host)


def _programs(
    group: System | Subsystem, around: Name | None
) -> Iterator[tuple[Member, Name | None]]:
    for member in (*group.members, *group.safety, *group.processes):
        host = member.host or around
        if isinstance(member, Subsystem) and not _is_one(member):
            yield from _programs(member, host)
        elif not isinstance(member, NodeInstance) or member.inside is None:
            yield member, host
