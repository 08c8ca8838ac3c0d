"""Checks of ``after exit of`` and ``on exit stop all``: what is waited for is there, and ends."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from deros import codes
from deros.diagnostics import Diagnostic, Related, Span, report
from deros.models.starting import AT_ONCE, After, Starting
from deros.systems.flat import FlatLaunch, FlatNode, FlatProgram, FlatSystem
from deros.systems.running.starting import Key, awaited_programs, key_of, programs_by_key
from deros.validators.findings.hints import did_you_mean, one_of


def check_starting(flat: FlatSystem) -> Iterator[Diagnostic]:
    """Yield the programs that would wait for ever, and those whose exit stops nothing."""
    known = programs_by_key(flat)
    reported: set[Span] = set()
    for program in flat.programs:
        starting = starting_of(program)
        if isinstance(program, FlatNode) and program.container is not None:
            continue  # it is loaded when its container is there
        # Of a system that is used several times, each instance would say the same.
        if starting == AT_ONCE or program.instance.name_span in reported:
            continue
        found = [*_stops_nothing(program, starting.stops_all)]
        if starting.after is not None:
            found += _waits_in_vain(program, starting.after, known)
        if found:
            reported.add(program.instance.name_span)
        yield from found


def starting_of(program: FlatProgram) -> Starting:
    """Return when a program is started; a launch file always is at once."""
    return AT_ONCE if isinstance(program, FlatLaunch) else program.instance.starting


def _is_respawned(program: FlatProgram) -> bool:
    return not isinstance(program, FlatLaunch) and program.instance.respawn is not None


def _stops_nothing(program: FlatProgram, stops_all: Span | None) -> Iterator[Diagnostic]:
    if stops_all is not None and _is_respawned(program):
        yield report(
            codes.RESPAWNED_STOPS_ALL,
            f"'{program.instance.name}' is started again when it ends ('respawn'), but its exit is"
            " to stop all",
            stops_all,
            "keep one of the two: 'respawn', or 'on exit stop all'",
        )


def _waits_in_vain(
    program: FlatProgram, after: After, known: Mapping[Key, Sequence[FlatProgram]]
) -> Iterator[Diagnostic]:
    name = program.instance.name
    found = awaited_programs(program.path, after.name, known)
    if len(found) != 1:
        yield _unclear(name, after, found, known)
        return
    (awaited,) = found
    reason = _never_ends(awaited)
    if reason is not None:
        yield report(
            codes.NEVER_EXITS,
            f"'{name}' is started when '{after.name}' has ended, but {reason}",
            after.span,
            "wait for a process of the system that ends and is not started again",
            (Related(awaited.instance.name_span, f"'{after.name}'"),),
        )
        return
    circle = _circle(program, known)
    if circle and min(map(key_of, circle)) == key_of(program):  # once for all that are in it
        names = " after ".join(f"'{each.instance.name}'" for each in (program, *circle))
        yield report(
            codes.CIRCULAR_START,
            f"none of these is ever started: {names}",
            after.span,
            "start one of them at once, or some time later: 'delay T'",
            tuple(Related(each.instance.name_span, "waits, too") for each in circle[:-1]),
        )


def _unclear(
    name: str,
    after: After,
    found: Sequence[FlatProgram],
    known: Mapping[Key, Sequence[FlatProgram]],
) -> Diagnostic:
    if found:
        return report(
            codes.UNKNOWN_AWAITED,
            f"'{name}' is started when '{after.name}' has ended, but {len(found)} have that name",
            after.name_span,
            "give them different names",
            tuple(Related(each.instance.name_span, "one of them") for each in found),
        )
    names = {each.instance.name for several in known.values() for each in several} - {name}
    inside = {"/".join(key) for key in known if key[-1] == after.name}
    hint = one_of(inside, "in subsystems, there are") or did_you_mean(
        after.name, names, one_of(names, "the system has")
    )
    return report(
        codes.UNKNOWN_AWAITED,
        f"'{name}' is started when '{after.name}' has ended, but no node or process has that name"
        " in its subsystem or around it",
        after.name_span,
        hint,
    )


def _never_ends(program: FlatProgram) -> str | None:
    """Return why a program has no end that could be waited for; ``None`` if it has one."""
    if isinstance(program, FlatLaunch):
        return "that is a launch file"
    if _is_respawned(program):
        return "that is started again when it ends ('respawn')"
    if isinstance(program, FlatNode) and program.launch is not None:
        return "that is started by a launch file"
    if isinstance(program, FlatNode) and program.process is not None:
        return f"that runs in the process of '{program.process}'"
    if isinstance(program, FlatNode) and program.container is not None:
        return f"that runs in the process of container '{program.container}'"
    return None


def _circle(program: FlatProgram, known: Mapping[Key, Sequence[FlatProgram]]) -> list[FlatProgram]:
    """Return what a program waits for, one after the other, if that ends at itself."""
    found: list[FlatProgram] = []
    each = program
    while len(found) < len(known):
        after = starting_of(each).after
        if after is None:
            break
        several = awaited_programs(each.path, after.name, known)
        if len(several) != 1:
            break
        (each,) = several
        found.append(each)
        if key_of(each) == key_of(program):
            return found
    return []
