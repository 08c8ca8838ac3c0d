"""Arguments that are given, as they are, to parameters and to arguments of used systems.

Other values are seen where they are computed; here, all that a user may choose has to fit.
"""

from __future__ import annotations

import contextlib
import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass

from deros import codes
from deros.diagnostics import Code, Diagnostic, Related, report
from deros.interfaces.units import UnitRegistry, is_same
from deros.models.arguments import (
    Argument,
    Chosen,
    Compared,
    Condition,
    Expression,
    Literally,
    Not,
    arguments_in,
)
from deros.models.common import Interval, Scalar
from deros.models.node import Parameter, ParameterType
from deros.models.system import GroupSettings, ParameterSetting, Subsystem, System
from deros.systems.arguments.assignments import space_of
from deros.systems.arguments.diagrams import TooManyCombinations
from deros.systems.arguments.evaluate import CannotEvaluate
from deros.systems.arguments.scopes import Scope
from deros.systems.groups import not_covered, settled_parameters
from deros.validators.node.values import is_numeric, show

_UNBOUNDED = Interval(-math.inf, math.inf)


def check_given(system: System) -> Iterator[Diagnostic]:
    """Yield where an argument is given, as it is, to what has another unit or narrower bounds."""
    yield from _narrower(system, system.arguments, (), ())


def _narrower(
    part: System | Subsystem,
    arguments: tuple[Parameter, ...],
    present: tuple[Condition, ...],
    around: tuple[GroupSettings, ...],
) -> Iterator[Diagnostic]:
    """Yield what an argument is given to as it is, in another unit or with narrower bounds.

    Args:
        part: a system, or a subsystem in it.
        arguments: of the system.
        present: the conditions of the part and of what holds it.
        around: the settings of the groups that hold it, the innermost first.
    """
    groups = (part.settings, *around)
    for member in part.members:
        conditions = (*present, *_optional(member.when))
        if isinstance(member, Subsystem):
            targets = {each.name: each for each in arguments_of(member)}
            for passed in member.passed:
                target = targets.get(passed.name.text)
                if target is not None:
                    what = f"argument '{target.name}' of '{member.system_name}'"
                    for use, there in _as_it_is(passed.value, conditions):
                        given = _Given(use, target, what, codes.UNFIT_ARGUMENT)
                        yield from given.check(arguments, there)
            yield from _narrower(member, arguments, conditions, groups)
            continue
        of_groups = not_covered(settled_parameters(member), [each.parameters for each in groups])
        for setting in (*member.parameters, *(each for _, each in of_groups)):
            target = member.type.parameter_for(setting.name) if member.type else None
            if target is None:
                continue
            what = f"parameter '{setting.name}'"
            for value, when in _values(setting, target):
                present = (*conditions, *_optional(setting.when), *_optional(when))
                for use, there in _as_it_is(value, present):
                    given = _Given(use, target, what, codes.PARAMETER_OUT_OF_RANGE)
                    yield from given.check(arguments, there)


def arguments_of(part: Subsystem) -> tuple[Parameter, ...]:
    """Return the arguments of the system that a subsystem uses, if it is known."""
    return part.system.arguments if part.system is not None else ()


def _optional(condition: Condition | None) -> tuple[Condition, ...]:
    return () if condition is None else (condition,)


def _values(
    setting: ParameterSetting, target: Parameter
) -> Iterator[tuple[Expression, Condition | None]]:
    """Yield the value that is set, or the elements of a list, each with its condition."""
    found = setting.value_from
    if found is None or isinstance(found, tuple) is not target.type.is_array:
        return
    elements = found if isinstance(found, tuple) else (found,)
    yield from zip(elements, setting.element_conditions or (None,) * len(elements), strict=True)


def _as_it_is(
    value: Expression, conditions: tuple[Condition, ...]
) -> Iterator[tuple[Argument, tuple[Condition, ...]]]:
    """Yield each argument that may be the value, with the conditions under which it is."""
    if isinstance(value, Argument):
        yield value, conditions
    elif isinstance(value, Chosen):
        yield from _as_it_is(value.chosen, (*conditions, value.condition))
        otherwise = Not(value.condition, value.span)
        yield from _as_it_is(value.otherwise, (*conditions, otherwise))


@dataclass(frozen=True, slots=True)
class _Given:
    """What a parameter, or an argument of a used system, gets."""

    value: Argument
    target: Parameter
    what: str
    code: Code

    def check(
        self, arguments: tuple[Parameter, ...], conditions: tuple[Condition, ...]
    ) -> Iterator[Diagnostic]:
        """Yield how an argument that is given as it is does not fit, where ``conditions`` hold."""
        argument = next((each for each in arguments if each.name == self.value.name), None)
        if argument is None:
            return
        related = (
            Related(argument.name_span, "the argument"),
            Related(self.target.span, self.what),
        )
        units = argument.unit, self.target.unit
        if units[0] and units[1] and not _same_unit(units[0], units[1]):
            yield report(
                codes.INCOMPATIBLE_UNITS,
                f"argument '{argument.name}' is in {units[0]}, {self.what} in {units[1]}",
                self.value.span,
                f"declare '{argument.name}' in {units[1]}, or calculate",
                related,
            )
        if _fits_always(argument, self.target):
            return
        if self._leaves(argument, arguments, conditions):
            outer = _allowed(self.target)
            hint = "bounds" if self.target.choices is None else "a one_of"
            yield report(
                self.code,
                f"argument '{argument.name}' may be {_allowed(argument)}, {self.what} {outer}",
                self.value.span,
                f"give '{argument.name}' {hint} within those",
                related,
            )

    def _leaves(
        self,
        argument: Parameter,
        arguments: tuple[Parameter, ...],
        conditions: tuple[Condition, ...],
    ) -> bool:
        """Return whether the argument may be what the target refuses while the conditions hold."""
        scope, use = Scope(arguments), Argument(argument.name, self.value.span)
        limits = (
            Compared("=", use, Literally(each, use.span), use.span)
            for each in (*_limits(argument), *_limits(self.target), *(self.target.choices or ()))
        )
        uses = itertools.chain(*map(arguments_in, conditions))
        used = {argument.name, *(each.name for each in uses)}
        told_apart = ((scope, each) for each in (*conditions, *limits))
        space = space_of(arguments, used, told_apart)
        mask = space.everything
        try:
            for each in conditions:
                with contextlib.suppress(CannotEvaluate):  # which is reported as such
                    mask &= space.where(each, scope)
            classes = space.classes([argument.name])
            allowed = [
                scope.values(values)[argument.name] for values, both in classes if both & mask
            ]
        except TooManyCombinations:  # which is reported as such, as the conditions decide parts
            return False
        return any(_refuses(self.target, each) for each in allowed)


def _same_unit(one: str, other: str) -> bool:
    units = UnitRegistry()
    first, second = units.parse(one), units.parse(other)
    return first is None or second is None or is_same(first, second)


def _fits_always(argument: Parameter, target: Parameter) -> bool:
    """Return whether each value of an argument fits; what is checked by others does."""
    is_number = is_numeric(argument.type)
    if any(each.interval is not None and each.interval.is_empty for each in (argument, target)):
        return True  # none is allowed, which is reported where that is declared
    if argument.choices is not None or argument.type is ParameterType.BOOL:
        return True  # they are combinations, each of which is checked
    if is_number is not is_numeric(target.type):
        return True  # which is a wrong type
    if target.choices is not None:
        return False
    outer = target.interval if is_number else None
    return outer is None or _within(argument.interval or _UNBOUNDED, outer)


def _refuses(target: Parameter, value: Scalar) -> bool:
    if target.choices is not None and value not in target.choices:
        return True
    bounds = target.interval
    return bounds is not None and not isinstance(value, str) and value not in bounds


def _limits(declared: Parameter) -> tuple[float, ...]:
    found = declared.interval
    return () if found is None else tuple(filter(math.isfinite, (found.lower, found.upper)))


def _allowed(declared: Parameter) -> str:
    """Return what an argument or a parameter may be."""
    if declared.choices is not None:
        return f"one of {', '.join(map(show, declared.choices))}"
    if declared.interval is not None:
        return declared.interval.clause()
    return "any number" if is_numeric(declared.type) else "any text"


def _within(inner: Interval, outer: Interval) -> bool:
    low = inner.lower > outer.lower or (
        inner.lower == outer.lower and (outer.lower_closed or not inner.lower_closed)
    )
    high = inner.upper < outer.upper or (
        inner.upper == outer.upper and (outer.upper_closed or not inner.upper_closed)
    )
    return low and high
