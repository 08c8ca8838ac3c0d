"""Timing monitors in turns."""

from __future__ import annotations

import gc
import statistics
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from support.summary import percentile
from support.throughput_rivals import Contender
from support.throughput_rules import Message

_TURN = 0.2
"""Seconds that a turn may take; of slow monitors it is given the first part of the drive."""

_LEAST = 40
"""Messages that it is given in any case."""

_BUDGET = 6.0
"""Seconds after which a monitor has no further turn."""


@dataclass(frozen=True, slots=True)
class Timing:
    """What a message costs, in nanoseconds.

    Attributes:
        messages: how many a turn had.
        cost: processor time per message, the median of the turns.
        median, percent_99: time that single messages took; in C they take less than the clock.
    """

    messages: int
    cost: float
    median: float | None
    percent_99: float | None


@dataclass(frozen=True, slots=True)
class Memory:
    """What a monitor in C takes, in bytes.

    Attributes:
        state: the struct.
        sections: what its code has in .text, .rodata, .data and .bss, where a tool tells.
    """

    state: int
    sections: Mapping[str, int] | None


@dataclass(frozen=True, slots=True)
class Row:
    """A line of the table; no timing, but why, where a monitor is not written or not installed.

    Attributes:
        language: what it is written in; it stands beside what is generated in the same.
    """

    rules: int
    name: str
    timing: Timing | None
    language: str = "Python"
    memory: Memory | None = None
    why: str = "not measured"


def measure(
    contenders: Mapping[str, Contender], drive: Sequence[Message], repeat: int
) -> dict[str, Timing]:
    """Let each monitor take the drive in turns, ``repeat`` times; return what that cost.

    Those that take long, be it only to set up, have fewer turns, but one at least.
    """
    parts = {name: _part(contender, drive) for name, contender in contenders.items()}
    turns: dict[str, list[_Turn]] = {name: [] for name in contenders}
    spent = dict.fromkeys(contenders, 0.0)
    for _ in range(repeat):
        for name, contender in contenders.items():
            if spent[name] < _BUDGET:
                start = time.monotonic()
                turns[name].append(_turn(contender, parts[name]))
                spent[name] += time.monotonic() - start
    made = {}
    for name, part in parts.items():
        times = sorted(each for turn in turns[name] for each in turn.singles)
        cost = statistics.median(turn.cost for turn in turns[name])
        made[name] = Timing(len(part), cost, percentile(times, 0.5), percentile(times, 0.99))
    return made


@dataclass(frozen=True, slots=True)
class _Turn:
    cost: float
    singles: list[float]


def _part(contender: Contender, drive: Sequence[Message]) -> Sequence[Message]:
    """Return as much of the drive as a monitor takes in a turn."""
    each = _turn(contender, drive[:_LEAST]).cost / 1e9
    return drive[: max(_LEAST, int(_TURN / each))]


def _turn(contender: Contender, drive: Sequence[Message]) -> _Turn:
    """Time the calls of the first part together, those of the rest one by one."""
    calls = contender(drive)
    most = len(calls) * 3 // 4
    first, rest = calls[:most], calls[most:]
    singles = []
    now = time.perf_counter_ns
    gc.collect()
    gc.disable()
    try:
        start = time.process_time_ns()
        for function, arguments in first:
            function(*arguments)
        cost = (time.process_time_ns() - start) / len(first)
        for function, arguments in rest:
            start = now()
            function(*arguments)
            singles.append(float(now() - start))
    finally:
        gc.enable()
    return _Turn(cost, singles)
