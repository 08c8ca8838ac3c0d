"""Checks of speeds that rules compare one way round, though their fields have a sign."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from fractions import Fraction

from deros import codes
from deros.diagnostics import Diagnostic, Related, report
from deros.interfaces.fields import FieldPath
from deros.models import rules
from deros.rules.compiler.scope.resolved import FieldKey, ResolvedComparison, Value
from deros.rules.program import ir, walk
from deros.rules.program.bounds import Bounds
from deros.validators.findings.hints import SHOWN
from deros.validators.rules.losses.rules_noticed import Used
from deros.validators.rules.losses.rules_places import acted_on
from deros.validators.rules_walk import RulesByName

_METRE = {"m": Fraction(1)}
_SPEED = {
    "linear": {"m": Fraction(1), "s": Fraction(-1)},
    "angular": {"rad": Fraction(1), "s": Fraction(-1)},
}
_BACK = {
    ("linear", "x"): "backwards",
    ("linear", "y"): "to the right",
    ("angular", "x"): "the other way round",
    ("angular", "y"): "the other way round",
    ("angular", "z"): "clockwise",
}
"""The negative direction of a speed, by REP 103. Up and down are not alike: no ``linear.z``."""

_UNSIGNED = frozenset({"previous", "rate"})
"""Functions of a number that ask how it changes, not which sign it has."""


def check_signs(
    written: rules.Rules,
    program: ir.Program,
    used: Used,
    comparisons: Iterable[ResolvedComparison],
) -> Iterator[Diagnostic]:
    """Yield one finding per speed that all rules compare one way round.

    A bound that is zero or below shows that its author knows of the sign, and so does arithmetic.
    """
    speeds = _Speeds(written, program, comparisons)
    speeds.look_at(used)
    for each in speeds.found.values():
        if each.one_way and not each.both_ways:
            yield _finding(written, each)


def check_latencies(
    program: ir.Program, comparisons: Iterable[ResolvedComparison]
) -> Iterator[Diagnostic]:
    """Yield one finding per topic of whose latency all bounds are positive.

    A stamp in the future makes it negative, which none of them tells from a fresh message. What is
    computed of it, as its absolute value, shows that its author knows of the sign.
    """
    found: dict[str, list[ResolvedComparison]] = {}
    for comparison in sorted(comparisons, key=lambda each: each.condition.span.start):
        match comparison.operand.expression:
            case ir.Apply(function="latency", input=index):
                found.setdefault(program.inputs[index].topic, []).append(comparison)
    computed = {
        program.inputs[part.input].topic
        for value in walk.values(walk.conditions(program))
        for part in walk.terms(value)
        if part != value and isinstance(part, ir.Apply) and part.function == "latency"
    }
    for topic, latencies in found.items():
        if topic not in computed and not any(map(_asks_for_future, latencies)):
            yield _unasked_future(latencies[0].condition)


def _asks_for_future(comparison: ResolvedComparison) -> bool:
    """Return whether a comparison tells a negative number from small ones that are positive."""
    bounds = comparison.bounds
    if bounds is None:
        return True
    ends = [each for each in (bounds.lower, bounds.upper) if math.isfinite(each)]
    return len(ends) == 2 or any(each <= 0 for each in ends)


def _unasked_future(condition: rules.Comparison | rules.Membership) -> Diagnostic:
    term = next(each for each in _sides(condition) if isinstance(each, rules.Call))
    hint = f"ask '{term.span.text} < 0 sec', too"
    if isinstance(condition, rules.Comparison) and term is condition.left:
        word = "not in" if condition.operator in (">", ">=") else "in"
        hint = f"write '{term.span.text} {word} [0 sec, {condition.right.span.text}]'"
    return report(
        codes.UNASKED_FUTURE,
        f"a stamp in the future makes '{term.span.text}' negative, and no rule asks for that: the"
        " message counts as a fresh one",
        condition.span,
        hint,
    )


@dataclass(slots=True)
class _Speed:
    """How rules look at a speed.

    Attributes:
        back: its negative direction.
        one_way: the comparisons with positive bounds.
        both_ways: whether anything looks at it in another way.
    """

    back: str
    one_way: list[ResolvedComparison] = field(default_factory=list)
    both_ways: bool = False


@dataclass(frozen=True, slots=True)
class _Part:
    """A condition that behaviours depend on.

    Attributes:
        entity: that of its rule; empty in a behaviour.
        positive: whether something is done where it is true, not where it is false.
        near: whether it counts only together with a distance: a speed towards something is meant.
    """

    condition: rules.Condition
    entity: str
    positive: bool
    near: bool


class _Speeds:
    """Finds how behaviours, and the rules that they depend on, look at speeds."""

    def __init__(
        self,
        written: rules.Rules,
        program: ir.Program,
        comparisons: Iterable[ResolvedComparison],
    ) -> None:
        self.found: dict[FieldKey, _Speed] = {}
        self._written = written
        self._program = program
        self._names = RulesByName(written)
        # The models are trees that live as long as this: identity distinguishes equal comparisons.
        self._comparisons = {id(each.condition): each for each in comparisons}
        self._measuring: set[str] = set()
        for rule in program.rules:  # a rule comes after those that it names
            if rule.early_of is None:
                entity, its = self._names[rule.full_name]
                if self._measures(its.condition, entity):
                    self._measuring.add(rule.full_name)

    def look_at(self, used: Used) -> None:
        """Look at all conditions that behaviours depend on."""
        self._follow(list(self._of_behaviours()))
        conditions = [each.condition for each in used.rules]
        conditions += [each.condition for each in walk.behaviours(self._program)]
        for condition in conditions:
            for part in walk.parts(condition):
                for key in self._read_otherwise(part):
                    if key in self.found:
                        self.found[key].both_ways = True

    def _of_behaviours(self) -> Iterator[_Part]:
        resets = {each.reset_by.text for each in self._written.actions if each.reset_by}
        resets -= {self._program.actions[index].name for index in acted_on(self._program)}

        def descend(behaviour: rules.Behaviour, near: bool) -> Iterator[_Part]:
            inner = [each for each in behaviour.body if isinstance(each, rules.Behaviour)]
            calls = [each for each in behaviour.body if isinstance(each, rules.ActionCall)]
            called = [each.action.text for each in calls]
            releases = bool(called) and resets.issuperset(called)
            # What is done near something may be done in what is nested here, or around it.
            together = near or any(self._measures(each.condition, "") for each in inner)
            yield _Part(behaviour.condition, "", not releases, together)
            near = near or self._measures(behaviour.condition, "")
            for each in inner:
                yield from descend(each, near)

        for behaviour in self._written.behaviours:
            yield from descend(behaviour, near=False)

    def _follow(self, open_: list[_Part]) -> None:
        seen: set[tuple[str, bool, bool]] = set()
        while open_:
            part = open_.pop()
            match condition := part.condition:
                case rules.Comparison() | rules.Membership():
                    self._compared(part)
                case rules.Truth(operand=rules.NamePath() as term):
                    name = self._names.full_name(term, part.entity)
                    if name is not None and (name, part.positive, part.near) not in seen:
                        seen.add((name, part.positive, part.near))
                        entity, rule = self._names[name]
                        open_.append(_Part(rule.condition, entity, part.positive, part.near))
                case rules.Not(operand=operand):
                    open_.append(_Part(operand, part.entity, not part.positive, part.near))
                case _:
                    together = isinstance(condition, rules.And | rules.Since)
                    near = part.near or (together and self._measures(condition, part.entity))
                    operands = rules.operands(condition)
                    open_ += (_Part(each, part.entity, part.positive, near) for each in operands)

    def _measures(self, condition: rules.Condition, entity: str) -> bool:
        """Return whether a condition, or a rule that it names, compares a distance."""
        open_ = [condition]
        while open_:
            inner = open_.pop()
            open_ += rules.operands(inner)
            found = self._comparisons.get(id(inner))
            unit = found.operand.unit if found is not None else None
            if unit is not None and dict(unit.exponents) == _METRE:
                return True
        return any(name in self._measuring for _, name in self._names.named_by(condition, entity))

    def _compared(self, part: _Part) -> None:
        """Note how a comparison with constant numbers looks at a speed."""
        comparison = self._comparisons.get(id(part.condition))
        if comparison is None or comparison.satisfying is None:
            return
        key = self._key(comparison.operand.expression)
        back = _negative_way(comparison.operand, key[1]) if key is not None else ""
        if key is None or not back or part.near:
            return
        speed = self.found.setdefault(key, _Speed(back))
        least, has_end = _least(comparison.satisfying, part.positive)
        if least <= 0:
            speed.both_ways = True
        elif not has_end:
            speed.one_way.append(comparison)

    def _key(self, value: ir.ValueExpression) -> FieldKey | None:
        """Return the field that a value is, if it is one."""
        if not isinstance(value, ir.Read):
            return None
        leaf = self._program.leaves[value.leaf]
        return self._program.inputs[leaf.input].topic, leaf.path

    def _read_otherwise(self, part: ir.Condition) -> Iterator[FieldKey]:
        """Yield the fields that a condition itself compares with more than constants."""
        values = walk.changing(walk.compared(part))
        if any(isinstance(each, ir.Apply) and each.function == "previous" for each in values):
            return  # it asks whether a value changes
        for value in values:
            is_change = isinstance(value, ir.Apply) and value.function in _UNSIGNED
            if is_change or (isinstance(value, ir.Read) and len(values) == 1):
                continue
            for index in walk.leaves(value):
                key = self._key(ir.Read(index))
                if key is not None:
                    yield key


def _negative_way(value: Value, path: FieldPath) -> str:
    """Return the negative direction of a velocity; nothing for any other field."""
    assert value.input is not None
    kind = value.input.type
    if (kind.package, kind.name, path[0]) == ("sensor_msgs", "JointState", "velocity"):
        return "the other way round"
    if len(path) < 2 or value.unit is None:
        return ""
    vector, axis = str(path[-2]).removesuffix("_velocity"), str(path[-1])
    is_speed = dict(value.unit.exponents) == _SPEED.get(vector)
    return _BACK.get((vector, axis), "") if is_speed else ""


def _least(bounds: Bounds, positive: bool) -> tuple[Fraction | float, bool]:
    """Return the least number for which something is done, and whether there is a greatest one.

    Where nothing is done while a condition is true, it is done for the numbers outside its bounds.
    """
    if bounds.outside != positive:
        return bounds.lower, bounds.upper != math.inf
    return (bounds.upper, False) if bounds.lower == -math.inf else (-math.inf, True)


def _finding(written: rules.Rules, speed: _Speed) -> Diagnostic:
    speed.one_way.sort(key=lambda each: each.condition.span.start)
    first = speed.one_way[0]
    span = first.condition.span
    is_below = first.satisfying is not None and first.satisfying.lower == -math.inf
    others = dict.fromkeys(each.condition.span for each in speed.one_way[1:])
    others.pop(span, None)
    terms = _sides(first.condition)
    return report(
        codes.ONE_WAY_ONLY,
        f"'{span.text}' is {'true' if is_below else 'false'} at any speed {speed.back}, and no rule"
        " that a behaviour depends on looks that way",
        span,
        f"where both ways count, write '{_absolute(written, first.condition)}'",
        (
            *(Related(each, "nor does this") for each in list(others)[:SHOWN]),
            *(
                Related(each.span, "declared here")
                for each in written.constants
                if each.name.text in [term.span.text.lstrip("-") for term in terms]
            ),
        ),
    )


def _sides(condition: rules.Comparison | rules.Membership) -> tuple[rules.Term, ...]:
    if isinstance(condition, rules.Comparison):
        return condition.left, condition.right
    return condition.operand, condition.lower, condition.upper


def _absolute(written: rules.Rules, condition: rules.Comparison | rules.Membership) -> str:
    """Return a comparison with the absolute value of the field that it reads."""
    constants = {each.name.text for each in written.constants}
    for term in _sides(condition):
        is_name = isinstance(term, rules.NamePath) and term.name.text not in constants
        if is_name or isinstance(term, rules.TopicPath):
            end = term.span.end - condition.span.start
            text = condition.span.text
            return f"{text[:end]}.abs(){text[end:]}"
    return condition.span.text
