"""The times of an input's last messages, which its frequencies look at."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from deros.rules.program import walk
from deros.rules.program.ir import Frequency, Program


def frequencies_of(program: Program, index: int) -> list[Frequency]:
    """Return what is compared of the frequencies of one input, each once."""
    found: dict[Frequency, None] = {}
    for condition in walk.conditions(program):
        if isinstance(condition, Frequency) and condition.input == index:
            found[condition] = None
    return list(found)


def shift_lines(stamps: Sequence[str]) -> Iterator[str]:
    """Yield the statements that add a message to those of an input, the last one first."""
    for later, earlier in zip(stamps[-2::-1], stamps[:0:-1], strict=True):
        yield f"  m->{earlier} = m->{later};"
    if stamps:
        yield f"  m->{stamps[0]} = m->now;"


def deadline_lines(program: Program, index: int, stamps: Sequence[str]) -> Iterator[str]:
    """Yield the statements that schedule when the frequencies of an input turn low."""
    for each in frequencies_of(program, index):
        end = f"m->{stamps[each.messages - 1]} + INT64_C({each.elapsed_ns})"
        yield f"  m->due = ahead(m->now, m->due, {end});"
