"""Arguments that are given, as they are, to parameters and to arguments of used systems.

Other values are seen where they are computed; here, all that a user may choose has to fit.
"""

from __future__ import annotations

import contextlib
import itertools
from collections.abc import Iterator
from dataclasses import dataclass
from types import NoneType

from deros import codes
from deros.diagnostics import Code, Diagnostic, Related, report
from deros.interfaces.units import UnitRegistry, is_same
from deros.models.arguments import (
    Argument,
    Compared,
    Condition,
    Expression,
    Literally,
    arguments_in,
)
from deros.models.common import Interval
from deros.models.node import Parameter
from deros.models.system import GroupSettings, Subsystem, System
from deros.systems.arguments.assignments import space_of
from deros.systems.arguments.diagrams import TooManyCombinations
from deros.systems.arguments.evaluate import CannotEvaluate
from deros.systems.arguments.scopes import Scope
from deros.systems.groups import not_covered, settled_parameters


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
                    given = _Given(passed.value, target, what, codes.UNFIT_ARGUMENT)
                    yield from given.check(arguments, conditions)
            yield from _narrower(member, arguments, conditions, groups)
            continue
        of_groups = not_covered(settled_parameters(member), [each.parameters for each in groups])
        for setting in (*member.parameters, *(each for _, each in of_groups)):
            target = member.type.parameter_for(setting.name) if member.type else None
            if target is not None and not isinstance(setting.value_from, tuple | NoneType):
                what = f"parameter '{setting.name}'"
                given = _Given(setting.value_from, target, what, codes.PARAMETER_OUT_OF_RANGE)
                yield from given.check(arguments, (*conditions, *_optional(setting.when)))


def arguments_of(part: Subsystem) -> tuple[Parameter, ...]:
    """Return the arguments of the system that a subsystem uses, if it is known."""
    return part.system.arguments if part.system is not None else ()


def _optional(condition: Condition | None) -> tuple[Condition, ...]:
    return () if condition is None else (condition,)


@dataclass(frozen=True, slots=True)
class _Given:
    """What a parameter, or an argument of a used system, gets."""

    value: Expression
    target: Parameter
    what: str
    code: Code

    def check(
        self, arguments: tuple[Parameter, ...], conditions: tuple[Condition, ...]
    ) -> Iterator[Diagnostic]:
        """Yield how an argument that is given as it is does not fit, where ``conditions`` hold."""
        name = self.value.name if isinstance(self.value, Argument) else None
        argument = next((each for each in arguments if each.name == name), None)
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
        inner, outer = argument.interval, self.target.interval
        if inner is None or outer is None or _within(inner, outer):
            return
        if not conditions or self._leaves(argument, inner, outer, arguments, conditions):
            yield report(
                self.code,
                f"argument '{argument.name}' may be {inner.clause()}, {self.what} {outer.clause()}",
                self.value.span,
                f"give '{argument.name}' bounds within those",
                related,
            )

    def _leaves(
        self,
        argument: Parameter,
        inner: Interval,
        outer: Interval,
        arguments: tuple[Parameter, ...],
        conditions: tuple[Condition, ...],
    ) -> bool:
        """Return whether the argument may leave the outer interval while the conditions hold."""
        scope, use = Scope(arguments), Argument(argument.name, self.value.span)
        limits = (
            Compared("=", use, Literally(each, use.span), use.span)
            for each in (inner.lower, inner.upper, outer.lower, outer.upper)
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
            allowed = [values[argument.name] for values, both in classes if both & mask]
        except TooManyCombinations:  # which is reported as such, as the conditions decide parts
            return False
        return any(not isinstance(each, str) and each not in outer for each in allowed)


def _same_unit(one: str, other: str) -> bool:
    units = UnitRegistry()
    first, second = units.parse(one), units.parse(other)
    return first is None or second is None or is_same(first, second)


def _within(inner: Interval, outer: Interval) -> bool:
    low = inner.lower > outer.lower or (
        inner.lower == outer.lower and (outer.lower_closed or not inner.lower_closed)
    )
    high = inner.upper < outer.upper or (
        inner.upper == outer.upper and (outer.upper_closed or not inner.upper_closed)
    )
    return low and high
