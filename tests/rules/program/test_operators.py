"""Rows of temporal operators, held against what they mean, read from the whole history."""

from __future__ import annotations

import ast
from collections.abc import Sequence
from dataclasses import replace
from itertools import product

import pytest
from hypothesis import given
from hypothesis import strategies as st

from deros.rules.program.operators import (
    FOR,
    NEVER,
    OPERATORS,
    SINCE,
    TIMES,
    WITHIN,
    Remembered,
    TemporalOperator,
    Verdict,
    conjunction,
    disjunction,
)

History = Sequence[tuple[int, Verdict, Verdict]]
"""Events: each with its time and the verdicts of the operands."""

DURATION, COUNT = 4, 2
VERDICTS = st.sampled_from((True, False, None))
HISTORIES = st.lists(st.tuples(st.integers(0, 3), VERDICTS, VERDICTS), min_size=1, max_size=12)
NAMES = {"p", "q", "now", "T", "N", "NEVER", "LONG_AGO", "came", "before", "either", "both"}

SLIPS = {
    "for is exclusive": (FOR, "verdict", ">=", ">"),
    "for starts over at every event": (FOR, "update", "if due == NEVER", "if True"),
    "for outlasts its operand": (FOR, "update", "NEVER if p is not True else ", ""),
    "unknown counts as false": (FOR, "verdict", "p if p is not True", "False if p is not True"),
    "within is inclusive": (WITHIN, "verdict", "<", "<="),
    "within starts over at every event": (WITHIN, "update", "if until == NEVER", "if True"),
    "within ends at once": (WITHIN, "verdict", "True if now < until else p", "p"),
    "times needs a turn more": (TIMES, "update", "[-N:]", "[-N - 1:]"),
    "times counts what stays true": (TIMES, "update", " or turns[0]", ""),
    "times is inclusive": (TIMES, "verdict", "now < turns", "now <= turns"),
    "times forgets while unknown": (TIMES, "verdict", "None if p is None else False", "False"),
    "times is unknown first": (TIMES, "verdict", "True if", "None if p is None else True if"),
    "since forgets": (SINCE, "verdict", "before", "False"),
    "since needs no operand": (SINCE, "verdict", "both(p, before)", "before"),
    "since keeps without the operand": (SINCE, "update", "both(p, kept)", "kept"),
}


def _timed(drawn: History) -> History:
    """Return a history with times instead of the steps between them."""
    now = 0
    found: list[tuple[int, Verdict, Verdict]] = []
    for step, p, q in drawn:
        now += step
        found.append((now, p, q))
    return found


def _played(row: TemporalOperator, history: History) -> list[Verdict]:
    remembered: Remembered = row.memory.initial
    verdicts: list[Verdict] = []
    for now, p, q in history:
        names: dict[str, Remembered] = {"p": p, "q": q, "now": now, "T": DURATION, "came": True}
        names["N"] = COUNT
        remembered, verdict = row.step(remembered, names)
        verdicts.append(verdict)
    return verdicts


def _lasting(history: History) -> Verdict:
    """Return the verdict of ``p for T`` after a history: how long has it been true?"""
    now, p, _ = history[-1]
    if p is not True:
        return p
    since = now
    for t, each, _ in reversed(history):
        if each is not True:
            break
        since = t
    return now - since >= DURATION


def _recent(history: History) -> Verdict:
    """Return the verdict of ``p within T`` after a history: when did it last cease?"""
    now, p, _ = history[-1]
    last = [n for n, (_, each, _) in enumerate(history) if each is True]
    if not last or last[-1] == len(history) - 1:
        return p
    ceased = history[last[-1] + 1][0]
    return True if now - ceased < DURATION else p


def _since(history: History) -> Verdict:
    """Return the verdict of ``p since q`` after a history: was there a cause, and ``p`` after?"""
    causes = (
        conjunction(q, *(p for _, p, _ in history[number + 1 :]))
        for number, (_, _, q) in enumerate(history)
    )
    return disjunction(*causes)


def _counted(history: History) -> Verdict:
    """Return the verdict of ``p N times within T`` after a history: when did it turn true?"""
    now, p, _ = history[-1]
    before = (None, *(each for _, each, _ in history))
    turns = [t for (t, each, _), last in zip(history, before, strict=False) if each and not last]
    if sum(now - t < DURATION for t in turns) >= COUNT:
        return True
    return None if p is None else False


MEANINGS = {"for": _lasting, "within": _recent, "times": _counted, "since": _since}


def _differs(row: TemporalOperator, drawn: History) -> bool:
    history = _timed(drawn)
    meant = [MEANINGS[row.word](history[: n + 1]) for n in range(len(history))]
    return _played(row, history) != meant


@pytest.mark.parametrize("word", OPERATORS)
@given(drawn=HISTORIES)
def test_row_has_its_meaning(word: str, drawn: History) -> None:
    """At every event the verdict is what the whole history says."""
    assert not _differs(OPERATORS[word], drawn)


@pytest.mark.parametrize("slip", SLIPS)
def test_slip_in_a_row_is_found(slip: str) -> None:
    """A row with a slip differs on some short history."""
    row, part, right, wrong = SLIPS[slip]
    text = getattr(row, part)
    assert right in text
    changed = replace(row, **{part: text.replace(right, wrong)})
    second = (True, None) if "q" in row.update else (None,)
    events = product((0, 2, 4), (True, False, None), second)
    length = 3 if "q" in row.update else 4
    assert any(_differs(changed, history) for history in product(events, repeat=length))


@pytest.mark.parametrize("word", OPERATORS)
def test_row_names_only_what_there_is(word: str) -> None:
    """A target that prints a row meets the documented names, and the row's own memory."""
    row = OPERATORS[word]
    for text in (row.update, row.verdict):
        read = {each.id for each in ast.walk(ast.parse(text)) if isinstance(each, ast.Name)}
        assert read <= NAMES | {row.memory.name}


def test_times_are_deadlines_until_they_are_over() -> None:
    """A row that remembers a time has a deadline; a verdict is none, nor is never."""
    assert FOR.deadline(7) == 7
    assert FOR.deadline(NEVER) is None
    assert SINCE.deadline(True) is None
    assert TIMES.deadline((True, (7, 9))) == 7
    assert TIMES.deadline((False, ())) is None
