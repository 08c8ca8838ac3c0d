"""Integers that are calculated for parameters, and may not have 64 bits, as ROS 2 wants them."""

from __future__ import annotations

import operator
from collections.abc import Iterator, Mapping

from deros.generators.system.computed import Computed
from deros.generators.system.expressions import python_expression
from deros.generators.system.launch.substitutions import Substitutions
from deros.generators.system.launch.terms import Substitution, Term
from deros.generators.system.launched import LaunchView
from deros.generators.system.programs import ProcessView
from deros.generators.system.view import ProgramView, SystemView
from deros.interfaces.types import INT64
from deros.models.arguments import (
    Argument,
    Calculation,
    Chosen,
    Condition,
    Expression,
    Literally,
    Opposite,
)
from deros.models.node import Parameter, ParameterType
from deros.systems.arguments.evaluate import expression_type

_LEAST, _MOST = INT64[0], INT64[-1]
_CALCULATE = {"+": operator.add, "-": operator.sub, "*": operator.mul}
_Range = tuple[float, float]


def overflow_checks(
    view: SystemView, made: Substitutions
) -> Iterator[tuple[Term, Condition | None]]:
    """Yield what fails where an integer, or one on the way to it, has more than 64 bits.

    Each stands with the condition under which it is needed.
    """
    arguments = {each.name: each for each in view.arguments}
    for program, what, found in _calculated(view):
        check = _check(found, what, arguments, made)
        if check is not None:
            yield check, program.when


def _calculated(view: SystemView) -> Iterator[tuple[ProgramView, str, Expression]]:
    """Yield what the values of parameters are calculated from, each with its program and place."""
    for program in view.programs:
        within = () if isinstance(program, LaunchView) else program.inside
        own = () if isinstance(program, ProcessView) else program.parameters
        for name, settings in ((program.name, own), *((e.name, e.parameters) for e in within)):
            for parameter, value in settings:
                for each in value if isinstance(value, tuple) else (value,):
                    if isinstance(each, Computed) and not isinstance(each.pieces[0], str):
                        yield program, f"parameter {parameter} of {name}", each.pieces[0]


def where(condition: Term, holding: Term, otherwise: Term) -> Term:
    """Return a choice, of which the other part is not evaluated."""
    return Substitution("IfElseSubstitution", ((condition,), (holding,), (otherwise,)))


def _check(
    found: Expression, what: str, arguments: Mapping[str, Parameter], made: Substitutions
) -> Term | None:
    if isinstance(found, Chosen):
        both = [_check(e, what, arguments, made) for e in (found.chosen, found.otherwise)]
        if both == [None, None]:
            return None
        return where(made.truth(found.condition), both[0] or "", both[1] or "")
    types = {name: each.type for name, each in arguments.items()}
    steps = [
        python_expression(each, made.hole)
        for each in _steps(found)
        if expression_type(each, types) is ParameterType.INTEGER and not _fits(each, arguments)
    ]
    if not steps:
        return None
    said = f"raise ValueError({f'{what} is no integer of 64 bits'!r})"
    listed = f"{', '.join(steps)},"
    return made.evaluated(f"all(-2**63 <= e < 2**63 for e in ({listed})) or exec({said!r})")


def _steps(found: Expression) -> Iterator[Expression]:
    """Yield what is calculated, what it is calculated from first."""
    match found:
        case Calculation(left=left, right=right):
            yield from (*_steps(left), *_steps(right), found)
        case Opposite(operand):
            yield from (*_steps(operand), found)


def _fits(found: Expression, arguments: Mapping[str, Parameter]) -> bool:
    least, most = _range(found, arguments)
    return least >= _LEAST and most <= _MOST


def _range(found: Expression, arguments: Mapping[str, Parameter]) -> _Range:
    """Return the least and the greatest value that an integer may have."""
    match found:
        case Literally(int() as value):
            return value, value
        case Argument(name):
            declared = arguments[name]
            if declared.choices is not None:
                numbers = [each for each in declared.choices if not isinstance(each, str)]
                return min(numbers), max(numbers)
            bounds = declared.interval
            least, most = (_LEAST, _MOST) if bounds is None else (bounds.lower, bounds.upper)
            return max(least, _LEAST), min(most, _MOST)
        case Opposite(operand):
            least, most = _range(operand, arguments)
            return -most, -least
        case Chosen(chosen=one, otherwise=other):
            both = (*_range(one, arguments), *_range(other, arguments))
            return min(both), max(both)
        case Calculation(word, left, right) if word in _CALCULATE:
            ends = [
                _CALCULATE[word](one, other)
                for one in _range(left, arguments)
                for other in _range(right, arguments)
            ]
            return min(ends), max(ends)
    return _LEAST - 1, _MOST + 1
