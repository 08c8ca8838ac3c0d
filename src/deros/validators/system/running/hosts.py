"""Checks of hosts: each program is on one that is there, and with what it cannot be parted from."""

from __future__ import annotations

import re
from collections.abc import Iterator

from deros import codes
from deros.diagnostics import Diagnostic, Related, Span, report
from deros.models.common import Name
from deros.models.starting import Host
from deros.models.system import SafetyInstance, Subsystem, System
from deros.names.names import check_identifier
from deros.systems.flat import FlatLaunch, FlatNode, FlatProgram, FlatSystem
from deros.systems.groups import groups_of, members_of
from deros.systems.running.placement import EVERYWHERE, HOST, Member, programs_of
from deros.systems.running.starting import awaited_programs, programs_by_key
from deros.validators.findings.hints import did_you_mean, one_of

_TAKEN = {EVERYWHERE: "it stands for all hosts", "exit": "'on exit' means something else"}

_NO_ADDRESS = re.compile(r"-|.*[\s\x00-\x1f\x7f]|$", re.DOTALL)


def check_hosts(system: System) -> Iterator[Diagnostic]:
    """Yield what is wrong with the hosts of a system, and with where it has its programs."""
    yield from _declared(system)
    known = {each.name for each in system.hosts}
    for place in _places(system):
        if place.text not in known:
            yield report(
                codes.UNKNOWN_HOST,
                f"the system declares no host '{place}'",
                place.span,
                did_you_mean(place.text, known, one_of(known, "its hosts"))
                or f"declare it: 'host {place} \"ADDRESS\"'",
            )
    if not system.hosts:
        return
    for member, host in programs_of(system):
        if isinstance(member, Subsystem) and member.system is not None and member.system.hosts:
            yield _placed_twice(member, member.system)
        if host is None:
            yield report(
                codes.UNPLACED_PROGRAM,
                f"{_called(member)} is on no host",
                _place(member),
                f"write 'on {system.hosts[0].name}' behind it, or behind the name of a group or of"
                " the system",
            )


def _declared(system: System) -> Iterator[Diagnostic]:
    first: dict[str, Host] = {}
    for each in system.hosts:
        fault = check_identifier(each.name)
        if fault is not None or each.name in _TAKEN:
            why = f"it {fault}" if fault is not None else _TAKEN[each.name]
            message = f"'{each.name}' cannot be the name of a host: {why}"
            yield report(codes.INVALID_SYSTEM_NAME, message, each.name_span)
        if each.address_from is None and _NO_ADDRESS.match(each.address):
            yield report(
                codes.UNFIT_ADDRESS,
                f"'{each.address}' is no address: "
                + ("an option" if each.address.startswith("-") else "several words, or none"),
                each.span,
                "write what ssh takes: a name or an address in the network, or 'user@name'",
            )
        if first.setdefault(each.name, each) is not each:
            yield report(
                codes.DUPLICATE_SETTING,
                f"host '{each.name}' is declared twice",
                each.name_span,
                "keep one of the two",
                (Related(first[each.name].name_span, "the first one"),),
            )
    for argument in system.arguments if system.hosts else ():
        if argument.name == HOST:
            yield report(
                codes.DUPLICATE_ARGUMENT,
                f"a system with hosts has an argument '{HOST}': on which of them it is started",
                argument.name_span,
                "give this argument another name",
                (Related(system.hosts[0].name_span, "a host"),),
            )


def _places(system: System) -> Iterator[Name]:
    groups = [group for _, group in groups_of(system)]
    members = [each for group in groups for each in members_of(group)]
    for part in (*groups, *members):
        if part.host is not None:
            yield part.host


def _placed_twice(member: Subsystem, used: System) -> Diagnostic:
    return report(
        codes.HOSTS_APART,
        f"system '{used.name}' has hosts of its own, and one that is used is where the system that"
        " uses it has it",
        member.system_span or member.name_span,
        "remove the hosts there, and place its subsystems as systems of their own",
        (Related(used.hosts[0].name_span, "its host"),),
    )


def _called(member: Member) -> str:
    if isinstance(member, SafetyInstance):
        return f"the safety node of '{member.path}'"
    return f"'{member.name}'"


def _place(member: Member) -> Span:
    return member.path_span if isinstance(member, SafetyInstance) else member.name_span


def check_places(flat: FlatSystem) -> Iterator[Diagnostic]:
    """Yield the programs that are parted from what they are loaded into, or wait for."""
    if not flat.system.hosts:
        return
    containers = {node.full_name: node for node in flat.nodes if node.instance.is_container}
    known = programs_by_key(flat)
    for program in flat.programs:
        if isinstance(program, FlatLaunch):
            continue
        if isinstance(program, FlatNode) and program.container is not None:
            container = containers.get(program.container)
            if container is not None and container.host != program.host:
                yield _apart(program, container, "is loaded into", program.instance.name_span)
            continue
        after = program.instance.starting.after
        found = awaited_programs(program.path, after.name, known) if after is not None else []
        if after is not None and len(found) == 1 and found[0].host != program.host:
            yield _apart(program, found[0], "waits for the exit of", after.span)


def _apart(program: FlatProgram, other: FlatProgram, what: str, place: Span) -> Diagnostic:
    return report(
        codes.HOSTS_APART,
        f"'{program.instance.name}' {what} '{other.instance.name}', and is on another host:"
        f" '{program.host}', not '{other.host}'",
        place,
        f"write 'on {other.host}' at '{program.instance.name}'",
        (Related(other.instance.name_span, f"'{other.instance.name}'"),),
    )
