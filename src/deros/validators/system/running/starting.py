"""Checks of ``after`` and ``on exit stop all``: what is waited for is there, and ends."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from deros import codes
from deros.diagnostics import Diagnostic, Related, Span, report
from deros.models.starting import AT_ONCE, After, Ready
from deros.names.names import check_topic_name
from deros.systems.flat import FlatLaunch, FlatNode, FlatProgram, FlatSystem
from deros.systems.running.readiness import StartOrder, starting_of
from deros.systems.running.starting import Key, awaited_programs, key_of
from deros.validators.findings.hints import did_you_mean, one_of


def check_starting(flat: FlatSystem) -> Iterator[Diagnostic]:
    """Yield the programs that would wait for ever, and those whose exit stops nothing."""
    order = StartOrder(flat)
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
            found += _waits_in_vain(program, starting.after, order)
        if starting.ready is not None:
            found += _never_ready(program, starting.ready, order)
        if found:
            reported.add(program.instance.name_span)
        yield from found


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


def _waits_in_vain(program: FlatProgram, after: After, order: StartOrder) -> Iterator[Diagnostic]:
    found = awaited_programs(program.path, after.name, order.known)
    if len(found) != 1:
        yield _unclear(program.instance.name, after, found, order.known)
        return
    (awaited,) = found
    reason = _never_ends(awaited)
    if reason is not None:
        yield report(
            codes.NEVER_EXITS,
            f"{_started(program, after)}, but {reason}",
            after.span,
            "wait for a process of the system that ends and is not started again",
            (Related(awaited.instance.name_span, f"'{after.name}'"),),
        )
        return
    yield from _in_circle(program, after.span, order)


def _never_ready(program: FlatProgram, ready: Ready, order: StartOrder) -> Iterator[Diagnostic]:
    if not ready.names_program:
        fault = "is that of the program itself" if ready.name.startswith("~") else None
        fault = fault or check_topic_name(ready.name)
        if fault is not None:
            message = f"nothing can wait for the {ready.kind} '{ready.name}': it {fault}"
            yield report(codes.INVALID_SYSTEM_NAME, message, ready.name_span)
            return
    else:
        found = awaited_programs(program.path, ready.name, order.known)
        if len(found) != 1:
            yield _unclear(program.instance.name, ready, found, order.known)
            return
        (awaited,) = found
        reason = _not_in_graph(awaited, ready)
        if reason is not None:
            yield report(
                codes.NEVER_READY,
                f"{_started(program, ready)}, but {reason[0]}",
                ready.span,
                reason[1],
                (Related(awaited.instance.name_span, f"'{ready.name}'"),),
            )
            return
    yield from _in_circle(program, ready.span, order)


def _not_in_graph(program: FlatProgram, ready: Ready) -> tuple[str, str] | None:
    """Return why a program is never ready, and what to do; ``None`` if it may be."""
    if not isinstance(program, FlatNode):
        what = "a launch file" if isinstance(program, FlatLaunch) else "a process, and not a node"
        return f"that is {what}", "wait for one of its services or topics: 'after service NAME'"
    if ready.kind == "active" and program.type is not None and not program.type.lifecycle:
        return (
            "that is not a managed node",
            f"wait until it is there, 'after node {ready.name}', or write 'lifecycle' in the"
            f" description of '{program.type.name}'",
        )
    return None


def _in_circle(program: FlatProgram, place: Span, order: StartOrder) -> Iterator[Diagnostic]:
    circle = _circle(program, order)
    if circle and min(map(key_of, circle)) == key_of(program):  # once for all that are in it
        names = " after ".join(f"'{each.instance.name}'" for each in (program, *circle))
        yield report(
            codes.CIRCULAR_START,
            f"none of these is ever started: {names}",
            place,
            "start one of them at once, or some time later: 'delay T'",
            tuple(Related(each.instance.name_span, "waits, too") for each in circle[:-1]),
        )


def _started(program: FlatProgram | str, wait: After | Ready) -> str:
    name = program if isinstance(program, str) else program.instance.name
    state = "has ended"
    if isinstance(wait, Ready):
        state = "is active" if wait.kind == "active" else "is in the ROS graph"
    return f"'{name}' is started when '{wait.name}' {state}"


def _unclear(
    name: str,
    wait: After | Ready,
    found: Sequence[FlatProgram],
    known: Mapping[Key, Sequence[FlatProgram]],
) -> Diagnostic:
    if found:
        return report(
            codes.UNKNOWN_AWAITED,
            f"{_started(name, wait)}, but {len(found)} have that name",
            wait.name_span,
            "give them different names",
            tuple(Related(each.instance.name_span, "one of them") for each in found),
        )
    names = {each.instance.name for several in known.values() for each in several} - {name}
    inside = {"/".join(key) for key in known if key[-1] == wait.name}
    hint = one_of(inside, "in subsystems, there are") or did_you_mean(
        wait.name, names, one_of(names, "the system has")
    )
    return report(
        codes.UNKNOWN_AWAITED,
        f"{_started(name, wait)}, but no node or process has that name in its subsystem or around"
        " it",
        wait.name_span,
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


def _circle(program: FlatProgram, order: StartOrder) -> list[FlatProgram]:
    """Return what a program waits for, one after the other, if that ends at itself."""
    ways = order.before(program)
    seen: set[Key] = set()
    while ways:
        way = ways.pop(0)
        if key_of(way[-1]) == key_of(program):
            return list(way)
        if key_of(way[-1]) not in seen:
            seen.add(key_of(way[-1]))
            ways += ((*way, *further) for further in order.before(way[-1]))
    return []
