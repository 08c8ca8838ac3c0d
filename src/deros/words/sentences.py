"""Conditions as sentences: what a rule asks, for readers who do not know the notation."""

from __future__ import annotations

from deros.models import rules
from deros.rules.functions.reads import strip_comments

_RELATIONS: dict[rules.ComparisonOperator, str] = {
    "=": "is",
    "!=": "is not",
    "<": "is below",
    "<=": "is at most",
    ">": "is above",
    ">=": "is at least",
}


def sentence(condition: rules.Condition) -> str:
    """Return what a condition asks, as a clause without a full stop."""
    match condition:
        case rules.Comparison(left, operator, right):
            return f"{_text(left)} {_RELATIONS[operator]} {_text(right)}"
        case rules.Membership():
            return _membership(condition)
        case rules.Truth(rules.Call(receiver=point, arguments=(zone,)) as call) if (
            call.function.text == "inside" and point is not None
        ):
            return f"{_text(point)} is in the zone {_text(zone)}"
        case rules.Not(rules.Truth(rules.Call(receiver=point, arguments=(zone,)) as call)) if (
            call.function.text == "inside" and point is not None
        ):
            return f"{_text(point)} is not in the zone {_text(zone)}"
        case rules.Truth(operand):
            return f"{_text(operand)} holds"
        case rules.Not(rules.Truth(operand)):
            return f"{_text(operand)} does not hold"
        case rules.Not(operand):
            return f"it is not so that {_inner(operand)}"
        case rules.And(operands):
            return " and ".join(map(_inner, operands))
        case rules.Or(operands):
            return " or ".join(map(_inner, operands))
        case rules.For(operand, duration):
            return f"{_inner(operand)}, without a break for {_text(duration)}"
        case rules.Once(operand, duration):
            return f"{_inner(operand)}, now or less than {_text(duration)} ago"
        case rules.Times(operand, count, duration):
            return f"{_inner(operand)}: it has turned so {count.value} times in {_text(duration)}"
        case rules.Since(operand, cause):
            return f"{_inner(operand)}, without a break since {_inner(cause)}"
        case rules.Begins(operand):
            return f"{_inner(operand)}, at the moment when it turns so"


def _membership(condition: rules.Membership) -> str:
    between = f"between {_text(condition.lower)} and {_text(condition.upper)}"
    excluded = [
        _text(end)
        for end, closed in (
            (condition.lower, condition.lower_closed),
            (condition.upper, condition.upper_closed),
        )
        if not closed
    ]
    without = f" ({' and '.join(excluded)} excluded)" if excluded else ""
    word = "is not" if condition.negated else "is"
    return f"{_text(condition.operand)} {word} {between}{without}"


def _inner(condition: rules.Condition) -> str:
    """Return a condition inside of another one: in parentheses where it has several parts."""
    text = sentence(condition)
    simple = isinstance(condition, rules.Comparison | rules.Membership | rules.Truth | rules.Not)
    return text if simple else f"({text})"


def _text(term: rules.Term) -> str:
    return f"`{' '.join(strip_comments(term.span.text).split())}`"
