"""How to tell why a condition is true, false, on its way or unknown: plans, without any values.

For an ``or`` the causes are those of the true operands, for an ``and`` of all, for a ``for`` its
operand's, with the duration behind them; ``not`` asks why its operand is false. A :data:`Plan`
holds all of that which does not depend on values; the reference interprets it, and the generators
emit it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from deros.interfaces.durations import seconds_text
from deros.rules.engine.cause_texts import Lasting, Piece, compared_pieces, joined, unknowns
from deros.rules.engine.early import chain_of, triggering_resettable
from deros.rules.functions.reads import Term, plain_term, strip_comments, term_name
from deros.rules.program import walk
from deros.rules.program.ir import (
    Active,
    Age,
    And,
    Begins,
    Behaviour,
    Compute,
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
    RuleRef,
    Since,
    Times,
    Truth,
    Unknown,
)

_LONGEST_TEXT = 40
_MORE = " …"
_LEVELS = 2
"""From so many rules below one another on, a cause names a rule without that rule's causes."""

Suffix = tuple[Piece, ...]
"""What follows each cause: for how long."""


@dataclass(frozen=True, slots=True)
class Say:
    """A cause, where a condition is true, or (``holds`` false) is false.

    ``pieces`` are texts, and between them terms that stand for their values.
    """

    condition: Condition
    holds: bool
    pieces: tuple[Piece, ...]


@dataclass(frozen=True, slots=True)
class SayRule:
    """A cause, where a rule is true, or (``holds`` false) is false: a ``head``, and why it is.

    Where rules name rules that name rules, the innermost are named without their own causes
    (:func:`plan_of_rule`): otherwise the text could double with each rule in between.
    """

    rule: int
    holds: bool
    head: tuple[Piece, ...]


@dataclass(frozen=True, slots=True)
class AllOf:
    """The causes of all parts, where each of them has some."""

    parts: tuple[Plan, ...]


@dataclass(frozen=True, slots=True)
class AnyOf:
    """The causes of all parts that have some."""

    parts: tuple[Plan, ...]


@dataclass(frozen=True, slots=True)
class During:
    """The causes of a part of an interval, of a ``since`` or of a ``within``.

    They are some where the interval has lasted long enough or, if not ``reached``, where it has
    begun and has not; and where the ``since`` or ``within`` is true or, if not ``reached``, false.
    """

    interval: For | Since | Once
    reached: bool
    part: Plan

    @property
    def is_sure(self) -> bool:
        """Whether the part is as it is told then; either side of a ``since`` need not be."""
        return not isinstance(self.interval, Since)


@dataclass(frozen=True, slots=True)
class OrUnknown:
    """The causes of a part or, where it has none, the cause that some of the terms are unknown.

    If all of them are known, the ``results`` that are not are named: what is computed of them, and
    each ``since`` that does not know what was before.
    """

    part: Plan
    terms: tuple[Term, ...]
    results: tuple[Compute | Since, ...]


Plan = Say | SayRule | AllOf | AnyOf | During | OrUnknown
"""How to tell why a condition is true, or why it is false; where it is not, there is no cause."""


@dataclass(frozen=True, slots=True)
class Reading:
    """What may be unknown, if the ``rule`` that reads it is; ``None``: the behaviour itself does.

    ``term`` is ``None`` for what has no value of its own and is unknown as the rule is.
    """

    rule: int | None
    name: str
    term: Term | None


@dataclass(frozen=True, slots=True)
class NoValue:
    """Why a behaviour is unknown: the terms without a value of the first tier that has some."""

    tiers: tuple[tuple[Reading, ...], ...]
    otherwise: str


def plan_of_behaviour(program: Program, behaviour: Behaviour, holds: bool = True) -> Plan:
    """Return the plan of a behaviour's causes: the outermost condition first, each part once.

    Those of an early behaviour tell how long what it waits for has lasted. If not ``holds``, they
    are the causes of what is false of its condition and those around it.
    """
    everyone = {each.index: each for each in walk.behaviours(program)}
    planner = _Planner(program, frozenset())
    chain = chain_of(everyone, behaviour.index)
    if not holds:
        return _any_of([planner.plan(each.condition, False, ()) for each in chain])
    if behaviour.early_of is None:
        return _all_of([planner.plan(each.condition, True, ()) for each in chain])
    chain = chain_of(everyone, behaviour.early_of)
    written = [each.condition for each in chain]
    early = [behaviour.condition]
    if len(written) > 1 and isinstance(behaviour.condition, And):
        early = list(behaviour.condition.operands)
    pairs = zip(early, written, strict=True)
    return _all_of([planner.plan(each, True, (), of) for each, of in pairs])


def plan_of_rule(program: Program, index: int, holds: bool) -> Plan:
    """Return the plan of a rule's causes; they go through no more than two further rules."""
    rule = program.rules[index]
    written = None if rule.early_of is None else program.rules[rule.early_of].condition
    named = _named(rule.condition)
    shortened = frozenset(each for each in named if _has_levels(program, each, _LEVELS))
    return _Planner(program, shortened).plan(rule.condition, holds, (), written)


def plan_of_unknown(program: Program, behaviour: Behaviour) -> NoValue:
    """Return the plan of what is unknown while the condition of a behaviour is."""
    everyone = {each.index: each for each in walk.behaviours(program)}
    readings: list[dict[Reading, None]] = [{}, {}, {}]
    seen: set[int] = set()

    def note(tier: int, rule: int | None, term: Term) -> None:
        readings[tier][Reading(rule, term_name(program, term), term)] = None

    for each in chain_of(everyone, behaviour.index):
        for part, rule in walk.parts_below(program, each.condition, seen):
            match part:
                case Missing() | Unknown() | Active() | Frequency():  # never unknown itself
                    pass
                case Age():
                    note(0, rule, plain_term(part))
                case Since():
                    readings[2][Reading(rule, since_text(part), None)] = None
                case _:
                    for term in walk.changing(walk.terminals(part)):
                        note(0, rule, term)
                    for result in walk.uncertain(part):
                        note(1, rule, result)
    tiers = tuple(tuple(each) for each in readings if each)
    return NoValue(tiers, "nothing has been evaluated yet")


def telling_unknown(program: Program) -> list[Behaviour]:
    """Return the behaviours, early ones among them, of which it is told what is unknown."""
    asked = set(triggering_resettable(program))
    return [each for each in walk.behaviours(program) if each.index in asked]


def told_rules(program: Program) -> frozenset[tuple[int, bool]]:
    """Return the rules, and which verdict of each, whose causes somebody may ask for.

    Those are the causes of each rule as written, while it is true, and what the plans of these and
    of the behaviours name.
    """
    open_ = [(each.index, True) for each in program.rules if each.early_of is None]
    for behaviour in walk.behaviours(program):
        open_ += _rules_in(plan_of_behaviour(program, behaviour))
    found: set[tuple[int, bool]] = set()
    while open_:
        asked = open_.pop()
        if asked not in found:
            found.add(asked)
            open_ += _rules_in(plan_of_rule(program, *asked))
    return frozenset(found)


def _rules_in(plan: Plan) -> Iterator[tuple[int, bool]]:
    match plan:
        case AllOf(parts=parts) | AnyOf(parts=parts):
            for each in parts:
                yield from _rules_in(each)
        case During(part=part) | OrUnknown(part=part):
            yield from _rules_in(part)
        case SayRule(rule=rule, holds=holds):
            yield rule, holds


def _has_levels(program: Program, index: int, levels: int) -> bool:
    """Return whether so many rules stand below one another below a rule."""
    if not levels:
        return True
    named = _named(program.rules[index].condition)
    return any(_has_levels(program, each, levels - 1) for each in named)


def _named(condition: Condition) -> set[int]:
    return set(walk.rules_in(condition))


# Planning -----------------------------------------------------------------------------------------


class _Planner:
    """Plans the causes of conditions; the ``shortened`` rules are named without their causes."""

    def __init__(self, program: Program, shortened: frozenset[int]) -> None:
        self._program = program
        self._shortened = shortened

    def plan(
        self, condition: Condition, holds: bool, suffix: Suffix, written: Condition | None = None
    ) -> Plan:
        """Return the plan of the causes of a condition that is true or, if not ``holds``, false.

        Args:
            condition: the condition.
            holds: whether it is true.
            suffix: what follows each cause.
            written: of an early condition, the one that it is the early one of.
        """
        if isinstance(written, For) and not isinstance(condition, For):
            if not holds:  # nothing comes
                return self.plan(condition, False, suffix, written.operand)
            return self._of_coming(condition, written, suffix)
        parts = _operands(condition)
        of = _operands(written) if written is not None else (None,) * len(parts)
        match condition:
            case Not():
                return self.plan(parts[0], not holds, suffix, of[0])
            case And() | Or():
                plans = [self.plan(*each) for each in _pairs(parts, holds, suffix, of)]
                return _all_of(plans) if isinstance(condition, And) is holds else _any_of(plans)
            case For():
                return self._of_interval(condition, holds, suffix, of[0])
            case Once() if holds and condition.duration_ns:  # what made it true may be gone
                text = _shortened(strip_comments(condition.span.text))
                return Say(condition, True, joined((text, *suffix)))
            case Once():
                part = self.plan(parts[0], holds, suffix, of[0])
                return During(condition, False, part) if condition.duration_ns else part
            case Times():
                text = _shortened(strip_comments(condition.span.text))
                return Say(condition, holds, joined(("" if holds else "not ", text, *suffix)))
            case Begins():
                word = " as of now" if holds else " already"
                part = self.plan(parts[0], True, (word, *suffix), of[0])
                during = During(condition.operand, not holds, part)
                if holds:
                    return during
                return _any_of([during, self.plan(parts[0], False, suffix, of[0])])
            case Since():
                return self._of_since(condition, holds, suffix, of)
            case Failsafe():
                part = self.plan(parts[0], holds, suffix, of[0])
                if not holds:
                    return part
                return OrUnknown(part, *unknowns(self._program, parts[0]))
            case RuleRef():
                return self._of_rule(condition, holds, suffix)
            case _:
                pieces = compared_pieces(self._program, condition, holds)
                return Say(condition, holds, joined((*pieces, *suffix)))

    def _of_rule(self, condition: RuleRef, holds: bool, suffix: Suffix) -> Plan:
        rules = self._program.rules
        rule = rules[condition.rule]
        name = (rule if rule.early_of is None else rules[rule.early_of]).full_name
        head = ("" if holds else "not ", name, *suffix)
        if condition.rule in self._shortened:
            return Say(condition, holds, joined(head))
        return SayRule(condition.rule, holds, joined((*head, ": ")))

    def _of_coming(self, condition: Condition, written: For, suffix: Suffix) -> Plan:
        """Return the plan of an early condition in the place of an interval that has to last."""
        inside = written.operand
        if not written.duration_ns:
            return self.plan(condition, True, suffix, inside)
        if self._has_wait(condition, inside):  # it begins when those in it have lasted
            then = (f", then for {_duration(written)}", *suffix)
            return self.plan(condition, True, then, inside)
        lasted, left = Lasting(written), Lasting(written, remains=True)
        soon = (" for ", lasted, " s, long enough in ", left, " s", *suffix)
        return _any_of(
            [
                During(
                    written, True, self.plan(condition, True, _further(written, suffix), inside)
                ),
                During(written, False, self.plan(condition, True, soon, inside)),
            ]
        )

    def _has_wait(self, condition: Condition, written: Condition) -> bool:
        """Return whether an early condition is true earlier than the one that is written."""
        if isinstance(written, For) and not isinstance(condition, For):
            return written.duration_ns > 0 or self._has_wait(condition, written.operand)
        if isinstance(condition, RuleRef):
            return self._program.rules[condition.rule].early_of is not None
        pairs = zip(_operands(condition), _operands(written), strict=True)
        return any(self._has_wait(*each) for each in pairs)

    def _of_interval(
        self, condition: For, holds: bool, suffix: Suffix, written: Condition | None
    ) -> Plan:
        """Return the plan of an interval; nested ones add the same amount of text at each level."""
        if holds:
            further = _further(condition, suffix)
            whole = self.plan(condition.operand, True, further, written)
            return During(condition, True, whole) if condition.duration_ns else whole
        operand = self.plan(condition.operand, False, suffix, written)
        if not condition.duration_ns:
            return operand
        if any(isinstance(part, For) for part in walk.parts(condition.operand)):
            shown = _shortened(strip_comments(condition.span.text))
            short: Plan = Say(Truth(Const(True)), True, joined((f"not yet {shown}", *suffix)))
        else:
            less = (f" for less than {_duration(condition)}", *suffix)
            short = self.plan(condition.operand, True, less, written)
        return _any_of([During(condition, False, short), operand])

    def _of_since(
        self, condition: Since, holds: bool, suffix: Suffix, of: tuple[Condition | None, ...]
    ) -> Plan:
        """Return the plan of both sides; the operand has the cause, as written, behind it."""
        cause = self.plan(condition.cause, holds, suffix, of[1])
        text = _text(suffix)
        is_deep = " since " in text or text.endswith(_MORE)
        further = (_MORE,) if is_deep else (f" since {_shortened(condition.wording)}", *suffix)
        behind = further if holds else suffix
        operand = self.plan(condition.operand, holds, behind, of[0])
        if not holds:
            return During(condition, False, _any_of([cause, operand]))
        return _any_of([cause, During(condition, True, operand)])


def since_text(condition: Since) -> str:
    """Return a ``since`` as written, cut short."""
    return _shortened(strip_comments(condition.span.text))


def _operands(condition: Condition) -> tuple[Condition, ...]:
    """Return the conditions that a condition consists of; of ``begins`` the one that begins."""
    match condition:
        case Not() | For() | Once() | Times() | Failsafe():
            return (condition.operand,)
        case Begins():
            return (condition.operand.operand,)
        case And() | Or():
            return condition.operands
        case Since():
            return (condition.operand, condition.cause)
        case _:
            return ()


def _pairs(
    parts: tuple[Condition, ...], holds: bool, suffix: Suffix, of: Iterable[Condition | None]
) -> Iterator[tuple[Condition, bool, Suffix, Condition | None]]:
    for part, written in zip(parts, of, strict=True):
        yield part, holds, suffix, written


def _further(interval: For, suffix: Suffix) -> Suffix:
    """Return the suffix of the operand of an interval that has lasted; a deep one is cut short."""
    text = _text(suffix)
    is_deep = text.count(" for ") > 1 or text.endswith(_MORE)
    return (f" for {_duration(interval)}", *((_MORE,) if is_deep else suffix))


def _duration(interval: For) -> str:
    return interval.wording or seconds_text(interval.duration_ns)


def _text(suffix: Suffix) -> str:
    return "".join(each for each in suffix if isinstance(each, str))


def _shortened(text: str) -> str:
    return f"{text[:_LONGEST_TEXT]}{_MORE if len(text) > _LONGEST_TEXT else ''}"


def _all_of(plans: list[Plan]) -> Plan:
    flat: dict[Plan, None] = {}
    for each in plans:
        flat.update(dict.fromkeys(each.parts if isinstance(each, AllOf) else (each,)))
    return next(iter(flat)) if len(flat) == 1 else AllOf(tuple(flat))


def _any_of(plans: list[Plan]) -> Plan:
    flat: dict[Plan, None] = {}
    for each in plans:
        flat.update(dict.fromkeys(each.parts if isinstance(each, AnyOf) else (each,)))
    return next(iter(flat)) if len(flat) == 1 else AnyOf(tuple(flat))
