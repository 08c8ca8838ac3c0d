"""What of some rules the timelines reach: verdicts of rules and of what they are made of.

The parts of a condition that count are its comparisons, and the sides of ``and`` and ``or``: each
has to be seen true and seen false, so that a slip in it can show. That a part is unknown counts as
neither. What a rule that is named is worth is counted at that rule. A behaviour has to act.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal

from deros.diagnostics import Span
from deros.rules.engine.cause_texts import Single, compared_pieces
from deros.rules.engine.engine import Engine
from deros.rules.functions.reads import strip_comments
from deros.rules.program import walk
from deros.rules.program.ir import (
    Active,
    Age,
    And,
    Begins,
    Behaviour,
    Compare,
    Condition,
    Const,
    Failsafe,
    For,
    Frequency,
    Missing,
    Not,
    Once,
    Or,
    Program,
    Rule,
    RuleRef,
    Since,
    Times,
    Truth,
    Unknown,
    Within,
)

Kind = Literal["rule", "behaviour", "side"]


@dataclass(frozen=True, slots=True)
class Gap:
    """What no timeline reaches.

    Attributes:
        kind: of what: a rule, a behaviour, or a side of a condition in one of them.
        name: of the rule or behaviour.
        span: its place.
        text: the side; empty for a rule or behaviour.
        never: the verdict that was not seen.
    """

    kind: Kind
    name: str
    span: Span
    text: str
    never: bool


@dataclass(frozen=True, slots=True)
class _Point:
    kind: Kind
    of: Rule | Behaviour
    condition: Condition

    @property
    def verdicts(self) -> tuple[bool, ...]:
        """The verdicts that have to be seen."""
        return (True,) if self.kind == "behaviour" else (True, False)


class Coverage:
    """What was seen of a program, in all timelines that it was observed in.

    Attributes:
        program: the rules.
    """

    def __init__(self, program: Program) -> None:
        """Nothing was seen yet."""
        self.program = program
        self._points = [*_points(program)]
        self._seen: set[tuple[int, bool]] = set()

    @property
    def total(self) -> int:
        """How many verdicts can be seen."""
        return sum(len(each.verdicts) for each in self._points)

    def observe(self, engine: Engine) -> None:
        """Note the verdicts as of the last event."""
        for number, point in enumerate(self._points):
            match point.of:
                case Behaviour() as behaviour if point.kind == "behaviour":
                    verdict = engine.holds(behaviour)
                case _:
                    verdict = engine.verdict(point.condition)
            if verdict is not None:
                self._seen.add((number, verdict))

    def gaps(self) -> list[Gap]:
        """Return what was not seen, in the order of the rules.

        The sides of a rule that was never true and never false are not listed.
        """
        found = []
        silent: set[str] = set()
        for number, point in enumerate(self._points):
            missing = [each for each in point.verdicts if (number, each) not in self._seen]
            name = point.of.full_name if isinstance(point.of, Rule) else point.of.name
            if point.kind == "rule" and len(missing) == len(point.verdicts):
                silent.add(name)
            elif point.kind == "side" and name in silent:
                continue
            text = condition_text(self.program, point.condition) if point.kind == "side" else ""
            found += [Gap(point.kind, name, point.of.span, text, each) for each in missing]
        return found

    @property
    def seen(self) -> int:
        """How many of the verdicts were seen."""
        wanted = enumerate(self._points)
        return sum((n, each) in self._seen for n, point in wanted for each in point.verdicts)


def _points(program: Program) -> Iterator[_Point]:
    for rule in program.rules:
        yield _Point("rule", rule, rule.condition)
        yield from (_Point("side", rule, each) for each in sides(rule.condition))
    for behaviour in walk.behaviours(program):
        yield _Point("behaviour", behaviour, behaviour.condition)
        yield from (_Point("side", behaviour, each) for each in sides(behaviour.condition))


def sides(condition: Condition) -> Iterator[Condition]:
    """Yield the parts of a condition that count, each once, but not the whole condition."""
    whole = condition
    while isinstance(whole, Not):
        whole = whole.operand
    found: dict[Condition, None] = {}
    for part in walk.parts(condition):
        if isinstance(part, And | Or):
            found.update(dict.fromkeys(map(_plain, part.operands)))
        elif not walk.operands(part):
            found[part] = None
    for each in found:
        is_fixed = isinstance(each, Truth) and isinstance(each.operand, Const)
        if each != whole and not isinstance(each, RuleRef) and not is_fixed:
            yield each


def _plain(condition: Condition) -> Condition:
    """Return what is negated: seen true the one, the other is seen false."""
    while isinstance(condition, Not):
        condition = condition.operand
    return condition


def condition_text(program: Program, condition: Condition) -> str:
    """Return a condition as its author wrote it, or nearly so."""
    match condition:
        case Truth() | Compare() | Within() | Missing() | Unknown() | Age() | Frequency():
            return _comparison_text(program, condition)
        case Not(operand=operand):
            return f"not {_inner(program, operand)}"
        case And(operands=operands):
            return " and ".join(_inner(program, each) for each in operands)
        case Or(operands=operands):
            return " or ".join(_inner(program, each) for each in operands)
        case For() | Once() | Times() | Since():
            return strip_comments(condition.span.text)
        case Begins(operand=lasting):
            return f"{_inner(program, lasting.operand)} begins"
        case Failsafe(operand=operand):
            return condition_text(program, operand)
        case RuleRef(rule=index):
            return program.rules[index].full_name
        case Active(action=index):
            return f"{program.actions[index].name}.active"


def _comparison_text(program: Program, condition: Single) -> str:
    """Return a comparison without values, and without the units of these."""
    pieces = compared_pieces(program, condition, True)
    words = ""
    for before, piece in pairwise(["", *pieces]):
        if isinstance(piece, str) and isinstance(before, str):
            words += piece
    return " ".join(words.split()).removesuffix(" is true")


def _inner(program: Program, condition: Condition) -> str:
    text = condition_text(program, condition)
    return f"({text})" if isinstance(condition, And | Or) else text
