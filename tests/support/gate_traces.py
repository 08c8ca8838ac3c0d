"""Random gates and what happens to them, many at a time: for gates that have to be compiled."""

from __future__ import annotations

import math
import random
import struct
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any, Literal

from hypothesis import strategies as st

from deros.interfaces.fields import ResolvedField, resolve
from deros.interfaces.types import FLOAT_TYPES, INTEGER_RANGES, FieldType, InterfaceType
from deros.rules.program.commands import LAYOUT, QUATERNION, TIME, Message, zero
from deros.rules.program.ir import Gate, GateLine, Limit
from tests.support.gates import (
    ACTIONS,
    CALLS,
    COMMANDS,
    NUMBERS,
    QUIET,
    READINGS,
    STORE,
    Happening,
    Path,
    happenings,
    message_type,
    opened,
    random_sources,
    random_stop,
    span,
    with_open_end,
)
from tests.support.messages import random_paths

Trace = list[tuple[int, Happening]]
"""What happens, and when, in nanoseconds."""

MORE_COMMANDS: Mapping[str, tuple[Path, ...]] = {
    **COMMANDS,
    "geometry_msgs.Point32": (("x",), ("y",)),
    "geometry_msgs.PoseStamped": (("pose", "position", "x"),),
    "sensor_msgs.Joy": (("axes", 0), ("buttons", 1)),
    "std_msgs.UInt64": (("data",),),
    "test_msgs.BoundedSequences": (("float32_values", 0), ("int8_values", 2)),
    "test_msgs.MultiNested": (("array_of_arrays", 1, "uint16_values", 2),),
}
"""Types of commands, and the fields of each that random limits speak of."""

_WAITS = (0, 0, 0, 1, 1, 2, 3, 4, 5, 7, 10, 12, 25, 60, -1, -5)
_TAME = (-3.0, -1.0, -0.5, -0.0, 0.0, 0.25, 0.5, 1.0, 3.0)
_LATER = (False,) * 19 + (True,)


def random_gate(rng: random.Random, name: str, paths: Sequence[Path] | None = None) -> Gate:
    """Return a gate; its times are a few nanoseconds, so that instants coincide often.

    Its limits speak of fields out of ``paths``, those of :data:`MORE_COMMANDS` unless given.
    """
    paths = MORE_COMMANDS[name] if paths is None else paths
    sources = random_sources(rng)
    lines: list[GateLine] = []
    for number in range(2, 2 + rng.randint(1, 6)):
        limits = _limits(rng, name, paths)
        stop = None if limits else random_stop(rng, message_type(name), paths)
        latches = not limits and rng.random() < 0.3
        if limits and rng.random() < 0.2 and not any(line.is_standing for line in lines):
            standing = opened(rng, limits) if rng.random() < 0.7 else limits
            lines.append(GateLine(None, None, None, standing, span(number)))
        elif rng.random() < 0.15:
            action, wait_ns = rng.randrange(len(ACTIONS)), rng.randint(1, 30)
            lines.append(GateLine(action, None, None, (), span(number), wait_ns=wait_ns))
        elif rng.random() < 0.5:
            action = rng.randrange(len(ACTIONS))
            lines.append(GateLine(action, None, None, limits, span(number), latches, stop))
        else:
            lost: Literal["heartbeat", "input"] = rng.choice(("heartbeat", "input"))
            lost_ns = 0 if lost == "input" and sources[0].silent_ns else rng.randint(1, 60)
            lines.append(GateLine(None, lost, lost_ns, limits, span(number), latches, stop))
    return Gate(
        index=0,
        sources=sources,
        target="/robot/command",
        type=message_type(name),
        period_ns=rng.randint(1, 12),
        lines=tuple(lines),
        span=span(1),
        resume_on_zero=rng.random() < 0.4,
    )


def with_bounds(rng: random.Random, gate: Gate) -> Gate:
    """Return a gate that always keeps to limits as well, whose ends others give."""
    name = f"{gate.type.package}.{gate.type.name}"
    limits = [
        with_open_end(rng, limit)
        for path in MORE_COMMANDS[name]
        for limit in opened(rng, _limits(rng, name, (path, path)))[:1]
    ]
    lines = tuple(line for line in gate.lines if not line.is_standing)
    standing = GateLine(None, None, None, tuple(limits), span(9))
    return replace(gate, lines=(*lines, *((standing,) if limits else ())))


def _limits(rng: random.Random, name: str, paths: Sequence[Path]) -> tuple[Limit, ...]:
    limits = []
    for path in [each for each in paths if rng.random() < 0.5]:
        found = resolve(STORE, message_type(name), path)
        assert isinstance(found, ResolvedField)
        lower, upper = rng.randint(-2, 0), rng.randint(0, 2)
        if INTEGER_RANGES.get(str(found.type.base), (-1, 1))[0] == 0:
            lower = 0
        ends = (lower / 2, upper / 2) if found.type.is_float else (lower, upper)
        limits.append(Limit(path, found.type, *ends))
    return tuple(limits)


def limitable(rng: random.Random, kind: InterfaceType) -> list[Path]:
    """Return some fields of a message type that a limit may speak of."""
    found = []
    for path in (path for _ in range(4) for path in random_paths(STORE, kind, rng)):
        field = resolve(STORE, kind, path)
        assert isinstance(field, ResolvedField)
        whole = {TIME, LAYOUT, QUATERNION}.intersection(field.around)
        if field.type.is_number and not whole and path not in found:
            found.append(path)
    return found


def random_trace(rng: random.Random, gate: Gate, start_ns: int) -> Trace:
    """Return what happens to a gate: commands good and bad, states, heartbeats, the time alone.

    Some calls come late, and some show that the clock stepped back.
    """
    t_ns = start_ns
    trace: Trace = []
    if rng.random() < 0.5:
        happenings = [*lively(rng, gate)]
    else:
        happenings = [*(QUIET if rng.random() < 0.6 else ())]
        happenings += [_happening(rng, gate) for _ in range(rng.randint(1, 30))]
    for each in happenings:
        t_ns = max(0, t_ns + each.wait_ns)
        trace.append((t_ns, each))
    return trace


def lively(rng: random.Random, gate: Gate) -> Iterator[Happening]:
    """Yield a life in which much passes: the heartbeat advances, and nearly all is good."""
    for counter in range(1, rng.randint(20, 60)):
        wait_ns = rng.choice((0, 1, 2, 3, 5, 8))
        if rng.random() < 0.03:
            wait_ns = rng.choice((-50, 40, 200))
        call = rng.choices(("heartbeat", "command", "state", "reset", "advance"), (6, 5, 5, 1, 3))[
            0
        ]
        if gate.inputs and rng.random() < 0.2:
            call = "reading"
        if call == "command":
            message = random_message(rng, gate.type, wild=rng.random() < 0.03)
            yield Happening(wait_ns, call, message, source=rng.randrange(len(gate.sources)))
        elif call == "state":
            topic = rng.choice(("/stop", "/go", "/mode"))
            value = rng.randint(0, 3) if topic == "/mode" else rng.random() < 0.4
            is_trusted = rng.random() < 0.95
            yield Happening(wait_ns, call, {"data": value}, topic, is_trusted=is_trusted)
        elif call == "reading":
            topic = rng.choice(sorted(READINGS))
            yield Happening(wait_ns, call, _read(rng, topic), topic)
        else:
            yield Happening(wait_ns, call, counter=counter if call == "heartbeat" else 0)


def lives(gate: Gate) -> st.SearchStrategy[list[Happening]]:
    """Draw what happens to a gate: little that passes, or a lively trace."""
    found = st.randoms(use_true_random=False).map(lambda rng: [*lively(rng, gate)])
    return st.one_of(happenings(gate), found)


def _happening(rng: random.Random, gate: Gate) -> Happening:
    kind = gate.type
    wait_ns = rng.randint(100, 3000) if rng.choice(_LATER) else rng.choice(_WAITS)
    call = rng.choice((*CALLS, *(("reading",) * 4 if gate.inputs else ())))
    if call == "command":
        fate = rng.random()
        message: Message | None
        if fate > 0.7:
            message = zero(
                STORE, kind, random_message(rng, kind, wild=False), t_ns=rng.randint(0, 9)
            )
        else:
            message = None if fate < 0.1 else random_message(rng, kind, wild=fate < 0.25)
        return Happening(wait_ns, call, message, source=rng.randrange(len(gate.sources)))
    if call == "state":
        topic = rng.choice(("/stop", "/go", "/mode", "/mode"))
        value = rng.randint(0, 3) if topic == "/mode" else rng.random() < 0.5
        message = None if rng.random() < 0.2 else {"data": value}
        return Happening(wait_ns, call, message, topic, is_trusted=rng.random() < 0.75)
    if call == "reading":
        topic = rng.choice(sorted(READINGS))
        return Happening(wait_ns, call, None if rng.random() < 0.2 else _read(rng, topic), topic)
    return Happening(wait_ns, call, counter=rng.randint(1, 4) if call == "heartbeat" else 0)


def _read(rng: random.Random, topic: str) -> Message:
    """Return a message with a number for limits, as it arrives: rounded if its type does that."""
    value = rng.choice(NUMBERS)
    is_short = READINGS[topic].endswith(".Float32")
    return {"data": _as_float32(value) if is_short else value}


def _as_float32(value: float) -> float:
    (held,) = struct.unpack("f", struct.pack("f", value))
    assert isinstance(held, float)
    return held


def random_message(rng: random.Random, kind: InterfaceType, *, wild: bool) -> dict[str, Any]:
    """Return a message as plain data, with one float of it NaN or infinite if it is ``wild``."""
    message = dict(_fields(rng, kind))
    if wild:
        _spoil(rng, kind, message)
    return message


def _fields(rng: random.Random, kind: InterfaceType) -> Iterator[tuple[str, Any]]:
    definition = STORE.message(kind)
    assert definition is not None, kind
    for name, field in definition.fields:
        if not field.is_array:
            yield name, _value(rng, field)
            continue
        longest = min(field.size or 3, 3)
        length = field.size if field.array == "fixed" else rng.randint(0, longest)
        yield name, [_value(rng, field.element) for _ in range(length or 0)]


def _value(rng: random.Random, field: FieldType) -> Any:
    if isinstance(field.base, InterfaceType):
        return dict(_fields(rng, field.base))
    if field.base in FLOAT_TYPES:
        return rng.choice(_TAME)
    if field.base == "bool":
        return rng.random() < 0.5
    if field.base in INTEGER_RANGES:
        least, greatest = INTEGER_RANGES[field.base]
        return rng.randint(max(least, -9), min(greatest, 9))
    return rng.choice(("", "a b", "\u00e9"))[: field.string_bound]


def _spoil(rng: random.Random, kind: InterfaceType, message: dict[str, Any]) -> None:
    """Make one float a number that is none, or very large or small; if there is one."""
    places = list(_floats(kind, message))
    if not places:
        return
    holder, key, base = rng.choice(places)
    value = rng.choice((math.nan, math.inf, -math.inf, 1e300, -5e-324, rng.uniform(-9, 9)))
    if base == "float32" and math.isfinite(value):
        value = _as_float32(max(-1e38, min(1e38, value)))
    holder[key] = value


def _floats(kind: InterfaceType, message: dict[str, Any]) -> Iterator[tuple[Any, Any, str]]:
    definition = STORE.message(kind)
    assert definition is not None, kind
    for name, field in definition.fields:
        holder: Any = message[name] if field.is_array else message
        keys = range(len(holder)) if field.is_array else (name,)
        for key in keys:
            if isinstance(field.base, InterfaceType):
                yield from _floats(field.base, holder[key])
            elif field.base in FLOAT_TYPES:
                yield holder, key, field.base
