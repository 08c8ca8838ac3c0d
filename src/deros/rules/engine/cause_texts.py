"""The texts of causes: comparisons with their values, and how long an interval has lasted."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from deros.interfaces.durations import seconds_text
from deros.rules.compiler.wordings import constant
from deros.rules.functions.reads import Term, plain_term, term_name, terms, told_beside
from deros.rules.program import walk
from deros.rules.program.ir import (
    OPPOSITE,
    Active,
    Age,
    Apply,
    Compare,
    Compute,
    Condition,
    Const,
    For,
    Frequency,
    Missing,
    Program,
    Scale,
    Since,
    Truth,
    Tuned,
    Unknown,
    ValueExpression,
    Within,
    Wording,
    Zone,
)


@dataclass(frozen=True, slots=True)
class Lasting:
    """How long an interval has lasted, or how much of its duration ``remains``, in seconds."""

    interval: For
    remains: bool = False


@dataclass(frozen=True, slots=True)
class Beams:
    """How many beams of a sector are blind, of which ``share`` is; nothing if none are."""

    share: Apply


Piece = str | Term | Lasting | Beams
"""A part of a cause: a text, or what stands for its value."""


def beams_text(share: float | None) -> str:
    """Return what follows a cause about a sector: " (27 % of its beams blind)", or nothing."""
    if not share:
        return ""
    return f" ({max(1, int(100.0 * share + 0.5))} % of its beams blind)"


def beams_of(term: Term) -> tuple[Beams, ...]:
    """Return what is told beside a term, if that is one of a sector."""
    return tuple(Beams(told) for told in told_beside(term) if told.function == "blind")


Single = Truth | Compare | Within | Missing | Unknown | Age | Frequency | Active
"""A condition that is one cause."""


def compared_pieces(program: Program, condition: Single, holds: bool) -> list[Piece]:
    """Return the pieces of a comparison that is true or, if not ``holds``, false."""
    terms = dict.fromkeys(walk.terminals(condition))
    beams = [beams for each in terms for beams in beams_of(each)]
    return [*_single(program, condition, holds), *beams]


def _single(program: Program, condition: Single, holds: bool) -> list[str | Term]:
    match condition:
        case Truth(operand=Const() as fixed):
            return [constant(fixed.value)]
        case Truth():
            return [f"{_name(program, condition.operand)} is {str(holds).lower()}"]
        case Missing() | Unknown():
            return [f"{'' if holds else 'not '}{term_name(program, condition)}"]
        case Active():
            name = program.actions[condition.action].name
            return [f"{name} is {'' if holds else 'not '}active"]
        case Compare(left=Compute(zone=Zone() as zone) as inside):
            return _in_zone(program, inside, zone, holds)
        case Compare():
            return _compared(program, condition, holds)
        case Within():
            return _within(program, condition, holds)
        case Age():
            shown = condition.wording
            operator = shown.operator if shown else condition.operator
            bound = shown.right[0] if shown else seconds_text(condition.bound_ns)
            value = _valued(program, plain_term(condition), shown.unit if shown else "")
            return [*value, f" {operator if holds else OPPOSITE[operator]} {bound}"]
        case Frequency():
            return _frequency(program, condition, holds)


def _in_zone(program: Program, inside: Compute, zone: Zone, holds: bool) -> list[str | Term]:
    """Return the pieces of a point in a zone: the point, its coordinates, and where it is."""
    x, y = inside.operands
    point = term_name(program, x).removesuffix(".x")
    where = "inside" if holds else "outside"
    return [f"{point} (", x, ", ", y, f") {zone.unit} is {where} {zone.name}"]


def _frequency(program: Program, condition: Frequency, holds: bool) -> list[str | Term]:
    """Return the pieces of a frequency; without a wording, its bound is one of time."""
    shown = condition.wording
    operator = shown.operator if shown else "<="
    bound = shown.right[0] if shown else f"{condition.messages} in {condition.elapsed_ns} ns"
    value = _valued(program, plain_term(condition), shown.unit if shown else "")
    return [*value, f" {operator if holds else OPPOSITE[operator]} {bound}"]


def _compared(program: Program, condition: Compare, holds: bool) -> list[str | Term]:
    shown = condition.wording
    operator = shown.operator if shown else condition.operator
    operator = operator if holds else OPPOSITE[operator]
    unit, bound = (shown.unit, shown.right[0]) if shown else ("", "")
    left = _side(program, condition.left, unit)
    right = _side(program, condition.right, bound)
    if operator == "=" and isinstance(condition.right, Const):  # the value is no news then
        left = [_name(program, condition.left)]
    elif operator == "=" and isinstance(condition.left, Const):
        right = [_name(program, condition.right)]
    return [*left, f" {operator} ", *right]


def _within(program: Program, condition: Within, holds: bool) -> list[str | Term]:
    closed = (condition.lower_closed, condition.upper_closed)
    brackets = ("[" if closed[0] else "(") + ("]" if closed[1] else ")")
    shown = condition.wording or Wording("=", "", ("", ""), brackets)
    return [
        *_side(program, condition.operand, shown.unit),
        f" {'' if holds else 'not '}in {shown.brackets[0]}",
        *_side(program, condition.lower, shown.right[0]),
        ", ",
        *_side(program, condition.upper, shown.right[1]),
        shown.brackets[1],
    ]


def _side(program: Program, value: ValueExpression, shown: str) -> list[str | Term]:
    """Return one side: a constant as ``shown``, all else with its value and ``shown`` as unit."""
    if isinstance(value, Const):
        return [shown or constant(value.value)]
    return _valued(program, _term(value), shown)


def _valued(program: Program, term: Term, unit: str) -> list[str | Term]:
    among = [told for told in told_beside(term) if told.function == "points"]
    if among:
        return [f"{term_name(program, term)} ", term, " of ", *among, " points"]
    return [f"{term_name(program, term)} ", term, f" {unit}" if unit else ""]


def _name(program: Program, value: ValueExpression) -> str:
    return constant(value.value) if isinstance(value, Const) else term_name(program, _term(value))


def _term(value: ValueExpression) -> Term:
    """Return the value that is read, before its conversion into the unit of another one."""
    while isinstance(value, Scale):
        value = value.operand
    assert not isinstance(value, Const)
    return value.as_written if isinstance(value, Tuned) else value


def joined(pieces: Iterable[Piece]) -> tuple[Piece, ...]:
    """Return pieces, with adjacent texts joined."""
    found: list[Piece] = []
    for piece in pieces:
        if isinstance(piece, str) and found and isinstance(last := found[-1], str):
            found[-1] = last + piece
        elif piece != "":
            found.append(piece)
    return tuple(found)


def unknowns(
    program: Program, condition: Condition
) -> tuple[tuple[Term, ...], tuple[Compute | Since, ...]]:
    """Return the terms that a condition reads, and what can be unknown while these are known.

    Both are those of the rules that it names, too. Tunable constants are known, and not among them.
    A ``since`` comes after what is computed.
    """
    read = tuple(each for each in terms(program, condition) if not isinstance(each, Tuned))
    named = walk.with_named(condition, program.rules)
    parts = [part for each in named for part in walk.parts(each)]
    computed = [each for part in parts for each in walk.uncertain(part)]
    sinces = [part for part in parts if isinstance(part, Since)]
    return read, tuple(dict.fromkeys([*computed, *sinces]))
