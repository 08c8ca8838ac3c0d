"""Checks for conditions that people read in another way than the language does."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations

from deros import codes
from deros.diagnostics import Diagnostic, Related, Span, report
from deros.models.rules import (
    And,
    Begins,
    Behaviour,
    Call,
    Comparison,
    Condition,
    For,
    NamePath,
    Not,
    Number,
    Once,
    Or,
    Rules,
    Since,
    Times,
    TopicPath,
    Truth,
    operands,
)
from deros.rules.compiler.scope.mentions import GAP
from deros.rules.program import ir
from deros.validators.rules_walk import RulesByName, all_terms, behaviours_of, rules_of, terms_of

_CONJUNCTION = re.compile(rf"(?:{GAP}\))*{GAP}(?:and|or)\b{GAP}")
_DEADLINE = ""
"""Stands beside topics for all deadlines: what turns true without a message."""

_TIMED = frozenset({"missing", "unknown", "age", "frequency"})
"""The functions that a deadline can change."""


def check_readings(written: Rules, program: ir.Program) -> Iterator[Diagnostic]:
    """Yield the findings about rules without errors."""
    moments = _Moments(written, program)
    for full_name, rule in rules_of(written):
        entity = full_name.partition(".")[0]
        for part in _parts(rule.condition):
            yield from _of_part(part, entity, moments)
    for behaviour in behaviours_of(written):
        for part in _parts(behaviour.condition):
            yield from _of_part(part, "", moments)
    for behaviour in written.behaviours:
        yield from _nested(behaviour, [], moments)


def _of_part(part: Condition, entity: str, moments: _Moments) -> Iterator[Diagnostic]:
    match part:
        case And():
            yield from _two_events(part, entity, moments)
            yield from _held_together(part, entity, moments)
            yield from _last_begins(part)
        case For() if moments.of(part.operand, entity).events is not None:
            yield report(
                codes.NEVER_TRUE,
                f"'{part.span.text}' is never true: what begins holds at one event only",
                part.span,
                "write 'x for T' of what lasts, 'x begins within T' of what began a short time ago",
            )
        case Once(operand=And() | Or()) | Times(operand=And() | Or()):
            yield from _within_all(part)


# Two events at one instant ----------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class _Turn:
    """What can make a condition true, and whether it is true at that instant only.

    Attributes:
        sources: the topics of such messages, and :data:`_DEADLINE`.
        events: of them those of the only instants at which it is true; ``None`` if it lasts.
    """

    sources: frozenset[str]
    events: frozenset[str] | None = None


class _Moments:
    """Tells conditions that hold at an instant from those that last, through the names of rules."""

    def __init__(self, written: Rules, program: ir.Program) -> None:
        self._names = RulesByName(written)
        self._topics = {each.name.text: each.term.topic.text for each in written.inputs}
        self._rules: dict[str, _Turn] = {}
        declared = {full_name for full_name, _ in rules_of(written)}
        for full_name in (each.full_name for each in program.rules):  # after those that it names
            if full_name in declared:
                entity, rule = self._names[full_name]
                found = self.of(rule.condition, entity)
                if rule.failsafe:  # it lasts while it is unknown, from a timeout on
                    found = _Turn(found.sources | {_DEADLINE})
                self._rules[full_name] = found

    def of(self, condition: Condition, entity: str) -> _Turn:
        """Return when a condition of an entity, or of a behaviour, turns true."""
        match condition:
            case Truth(operand=NamePath() as term) if (
                full_name := self._names.full_name(term, entity)
            ) is not None:
                return self._rules[full_name]
            case Begins():
                sources = self.of(condition.operand, entity).sources
                return _Turn(sources, sources)
            case And():
                each = [self.of(operand, entity) for operand in condition.operands]
                events = [turn.events for turn in each if turn.events is not None]
                shared = frozenset.intersection(*events) if events else None
                found = (shared or frozenset[str]().union(*events)) if events else None
                return _Turn(frozenset[str]().union(*(turn.sources for turn in each)), found)
            case Or():
                each = [self.of(operand, entity) for operand in condition.operands]
                events = [turn.events for turn in each if turn.events is not None]
                lasting = len(events) < len(each)
                return _Turn(
                    frozenset[str]().union(*(turn.sources for turn in each)),
                    None if lasting else frozenset[str]().union(*events),
                )
            case Not():
                return _Turn(self.of(condition.operand, entity).sources)
            case For() | Once() | Times():
                return _Turn(self.of(condition.operand, entity).sources | {_DEADLINE})
            case Since():
                both = (self.of(each, entity) for each in (condition.operand, condition.cause))
                return _Turn(frozenset[str]().union(*(turn.sources for turn in both)))
            case _:
                return _Turn(frozenset(self._read(condition)))

    def meant(self, condition: Condition, entity: str) -> tuple[Condition, str]:
        """Return the condition that a name stands for, and its entity; else the condition."""
        while (
            isinstance(condition, Truth)
            and isinstance(condition.operand, NamePath)
            and (full_name := self._names.full_name(condition.operand, entity)) is not None
            and not (named := self._names[full_name])[1].failsafe
        ):
            entity, condition = named[0], named[1].condition
        return condition, entity

    def _read(self, condition: Condition) -> Iterator[str]:
        """Yield the sources of a condition without operands."""
        for term in (inner for each in terms_of(condition) for inner in all_terms(each)):
            match term:
                case TopicPath():
                    yield term.topic.text
                case NamePath() if term.name.text in self._topics:
                    yield self._topics[term.name.text]
                case Call() if term.function.text in _TIMED:
                    yield _DEADLINE


def _apart(turns: list[_Turn]) -> bool:
    """Return whether two of the conditions hold at instants that never come together."""
    events = {each.events for each in turns if each.events}
    return any(not one & other for one, other in combinations(events, 2))


def _two_events(part: And, entity: str, moments: _Moments) -> Iterator[Diagnostic]:
    found = [(each, moments.of(each, entity)) for each in part.operands]
    momentary = [(each, turn) for each, turn in found if turn.events]
    if not _apart([turn for _, turn in momentary]):
        return
    proposed = " and ".join(f"({_grouped(each)} within T)" for each, _ in momentary)
    yield report(
        codes.TWO_EVENTS,
        f"'{part.span.text}' asks that both happen at the same instant, and two topics hardly ever"
        " send at one",
        part.span,
        f"write '{proposed}' of what happens shortly after one another",
    )


def _grouped(condition: Condition) -> str:
    """Return the text of a condition that ``within`` may follow."""
    simple = isinstance(condition, Begins | Truth)
    return condition.span.text if simple else f"({condition.span.text})"


def _nested(
    behaviour: Behaviour, outer: list[Condition], moments: _Moments
) -> Iterator[Diagnostic]:
    """Yield one finding per ``if`` on an event inside one on another event."""
    own = moments.of(behaviour.condition, "")
    lost = next((each for each in outer if _apart([moments.of(each, ""), own])), None)
    if lost is not None:
        yield report(
            codes.TWO_EVENTS,
            f"'{behaviour.condition.span.text}' has to happen at the same instant as the event of"
            " the 'if' around it, and two topics hardly ever send at one",
            behaviour.condition.span,
            f"write '{_grouped(lost)} within T' there, of what happened a short time ago",
            (Related(lost.span, "the 'if' around it"),),
        )
    for item in behaviour.body:
        if isinstance(item, Behaviour):
            yield from _nested(item, [*outer, behaviour.condition], moments)


# Buttons pressed together -----------------------------------------------------------------------


def _held_together(part: And, entity: str, moments: _Moments) -> Iterator[Diagnostic]:
    """Report ``(p within T) and (q within T)`` of buttons: one that is held counts all the time."""
    held: dict[str, tuple[Once, Condition]] = {}
    for each in part.operands:
        within, owner = moments.meant(each, entity)
        if isinstance(within, Once):
            button, _ = moments.meant(within.operand, owner)
            if _is_button(button):
                held.setdefault(button.span.text, (within, within.operand))
    if len(held) < 2:
        return
    proposed = " and ".join(
        f"({button.span.text} begins"
        f" {_text(within, button.span.end, within.span.end).lstrip(') ')})"
        for within, button in held.values()
    )
    yield report(
        codes.HELD_TOGETHER,
        f"'{part.span.text}' is true, too, while one is held or stuck: 'within' counts from its"
        " release",
        part.span,
        f"if they have to be pressed shortly after one another, write '{proposed}'",
    )


def _is_button(condition: Condition) -> bool:
    """Return whether a condition is a boolean field, or one that is equal to a number."""
    match condition:
        case Truth(operand=NamePath() | TopicPath()):
            return True
        case Comparison(left=NamePath() | TopicPath(), operator="=", right=Number()):
            return True
        case _:
            return False


# What 'within' covers ---------------------------------------------------------------------------


def _within_all(part: Once | Times) -> Iterator[Diagnostic]:
    """Report a ``within`` behind ``and`` or ``or`` without parentheses: it covers all of it."""
    whole = part.operand
    if whole.span.start != part.span.start or _has_open_not(whole):
        return  # in parentheses, or refused for its 'not'
    tail = _tail(whole)
    time = _text(part, whole.span.end, part.span.end)
    head = Span(part.span.source, whole.span.start, tail.start).text
    word = (
        "they must hold at one instant"
        if isinstance(whole, And)
        else "one that is over counts, too"
    )
    yield report(
        codes.WITHIN_COVERS_ALL,
        f"'{time}' covers all of '{whole.span.text}': {word}",
        part.span,
        f"write '({whole.span.text}) {time}' if that is meant, '{head}({tail.text} {time})' if it"
        f" is about '{tail.text}'",
    )


def _has_open_not(whole: Condition) -> bool:
    """Return whether an operand is a ``not`` that no parentheses hold."""
    if not isinstance(whole, And | Or):
        before = whole.span.source.text[: whole.span.start].rstrip()
        return isinstance(whole, Not) and not before.endswith("(")
    return any(_has_open_not(each) for each in whole.operands)


def _tail(whole: Condition) -> Span:
    """Return the last operand as written, with its parentheses, of nested ones the inmost."""
    tail = whole.span
    open_: Condition = whole
    while isinstance(open_, And | Or) and open_.span.end == whole.span.end:
        before, last = open_.operands[-2:]
        source = whole.span.source
        joint = _CONJUNCTION.match(source.text, before.span.end, tail.end)
        tail = Span(source, joint.end() if joint else last.span.start, whole.span.end)
        open_ = last
    return tail


def _last_begins(part: And) -> Iterator[Diagnostic]:
    """Report ``p begins and q begins within T`` without parentheses: it covers the last alone."""
    last = part.operands[-1]
    if not (isinstance(last, Once) and isinstance(last.operand, Begins)):
        return
    if last.span.end != part.span.end:
        return  # in parentheses
    momentary = [each for each in part.operands[:-1] if isinstance(each, Begins)]
    if not momentary:
        return
    begun = _text(last, last.operand.operand.span.end, last.span.end).lstrip(") ")
    time = begun.removeprefix("begins").strip()
    first = momentary[-1].span.text
    event = last.span.text.removesuffix(time).strip()
    yield report(
        codes.WITHIN_COVERS_ALL,
        f"'{time}' covers '{event}' alone: '{first}' has to happen now, after it",
        part.span,
        f"write '({first} {time}) and ({event} {time})' if they may come in either order,"
        f" '{first} and ({event} {time})' if not",
    )


def _text(part: Condition, start: int, end: int) -> str:
    return Span(part.span.source, start, end).text.strip()


def _parts(condition: Condition) -> Iterator[Condition]:
    """Yield a condition and all in it, the whole before its operands."""
    yield condition
    for operand in operands(condition):
        yield from _parts(operand)
