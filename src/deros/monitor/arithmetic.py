"""Arithmetic of the rules: checked for dimensions, and resolved into formulas of doubles.

One term becomes one formula, whatever it is nested of: its operands are fields and functions of
them, each of which may come from another topic, and units are converted within it. Constants alone
are computed exactly.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Literal

from deros import codes
from deros.diagnostics import Code, Span
from deros.interfaces import units
from deros.interfaces.types import FieldType
from deros.interfaces.units import Unit
from deros.metamodels import rules
from deros.metamodels.reading import MAX_DEPTH, too_deep
from deros.monitor import formulas, intervals, ir
from deros.monitor.bounds import rounded
from deros.monitor.formulas import Binary, Choice, Expression, Formula, Name, Relation
from deros.monitor.intervals import Interval
from deros.monitor.operations import CALLS, is_arithmetic
from deros.monitor.reads import strip_comments
from deros.monitor.resolved import AgeOf, DeclaredInput, Quantity, Resolved, Value, family
from deros.monitor.scope import Scope
from deros.monitor.term_names import describe


@dataclass(frozen=True, slots=True)
class _Number:
    """A part of a term.

    Attributes:
        expression: its value.
        unit: ``None`` where it is not known.
        interval: between which ends its value lies.
        span: where it is written.
        constant: its exact value in ``unit``, if it is one.
        plain: whether it is a constant without a unit, which is in any unit.
    """

    expression: Expression
    unit: Unit | None
    interval: Interval
    span: Span
    constant: Fraction | None = None
    plain: bool = False

    @property
    def offset(self) -> Fraction:
        """The zero of its scale, if that is not the zero of what it measures."""
        return self.unit.offset if self.unit is not None else Fraction(0)


class _FaultError(Exception):
    """A fault has been reported; the term has no value."""


class ArithmeticTerm:
    """Resolves one outermost term of arithmetic."""

    def __init__(self, scope: Scope, resolve: Callable[[rules.Term], Resolved | None]) -> None:
        """Resolve operands that are no arithmetic with ``resolve``."""
        self._scope = scope
        self._resolve = resolve
        self._operands: dict[ir.Read | ir.Apply, str] = {}
        self._inputs: list[DeclaredInput] = []
        self._assigned: dict[str, Expression] = {}
        self.unknown_while = ""
        """What makes it unknown while its operands are known, if something can."""
        self._one, self._radian = scope.units.parse("1"), scope.units.parse("rad")

    def value(self, term: rules.Term) -> Value | Quantity | None:
        """Return the value of a term, a constant if all of its operands are.

        ``None`` means that a fault has been reported.
        """
        try:
            found = self._number(term)
        except _FaultError:
            return None
        if found.constant is not None:
            unit = None if found.plain else found.unit
            return Quantity(found.constant, unit, unit, whole=False)
        formula = Formula(tuple(self._assigned.items()), found.expression)
        written = strip_comments(term.span.text)
        wording = f"({written})" if isinstance(term, rules.Arithmetic) else written
        computed = ir.Compute(formula, tuple(self._operands), wording)
        ends = intervals.ends_of(found.interval)
        return Value(computed, FieldType("float64"), found.unit, self._inputs[0], ends)

    def _number(self, term: rules.Term) -> _Number:
        if self._scope.nesting > MAX_DEPTH:
            self._scope.diagnostics.append(too_deep(term.span))
            raise _FaultError
        self._scope.nesting += 1
        try:
            match term:
                case rules.Arithmetic():
                    left, right = self._number(term.left), self._number(term.right)
                    return self._operation(term, left, right)
                case rules.Negative():
                    return self._negative(self._number(term.operand), term.span)
                case rules.Call() if is_arithmetic(term):
                    return self._call(term, self._arguments(term))
            return self._operand(term, self._resolve(term))
        finally:
            self._scope.nesting -= 1

    def _fault(self, code: Code, message: str, span: Span, hint: str = "") -> _FaultError:
        """Report a fault, and return what is to be raised."""
        self._scope.fault(code, message, span, hint)
        return _FaultError()

    # Operands -----------------------------------------------------------------------------------

    def _operand(self, term: rules.Term, found: Resolved | None) -> _Number:
        match found:
            case None:
                raise _FaultError
            case Quantity():
                unit = found.shown_in or self._one
                number = found.in_unit(found.shown_in)
                return _constant(number, unit, term.span, found.unit is None)
            case Value(expression=ir.Read() | ir.Apply() as expression) if (
                family(found.type) == "number"
            ):
                if expression not in self._operands:
                    self._operands[expression] = f"x{len(self._operands) + 1}"
                    self._inputs.append(found.input)
                name = Name(self._operands[expression])
                return _Number(name, found.unit, intervals.interval_of(found.bounds), term.span)
            case AgeOf():
                message = "'age()' is compared with a constant only"
                raise self._fault(codes.AGE_NOT_CONSTANT, message, term.span)
        message = f"arithmetic needs numbers, '{term.span.text}' is {describe(found)}"
        raise self._fault(codes.FIELD_NOT_NUMERIC, message, term.span)

    def _arguments(self, call: rules.Call) -> list[_Number]:
        name, given = call.function.text, len(call.arguments)
        least, greatest = CALLS[name]
        if not least <= given <= greatest:
            wanted = str(least) if least == greatest else f"{least} to {greatest}"
            message = f"'{name}()' takes {wanted} number{'' if wanted == '1' else 's'}"
            hint = f"of an array it is 'ARRAY.{name}()'" if name in ("min", "max") else ""
            raise self._fault(
                codes.WRONG_FUNCTION_ARGUMENT, f"{message}, {given} given", call.span, hint
            )
        return [self._number(each) for each in call.arguments]

    # Operators ----------------------------------------------------------------------------------

    def _operation(self, term: rules.Arithmetic, left: _Number, right: _Number) -> _Number:
        match term.operator:
            case "+" | "-" as operator:
                return self._sum(operator, left, right, term)
            case "*":
                return self._product(left, right, term)
            case "/":
                return self._quotient(left, right, term)

    def _sum(
        self, operator: Literal["+", "-"], left: _Number, right: _Number, term: rules.Arithmetic
    ) -> _Number:
        word = "added" if operator == "+" else "subtracted from one another"
        scales = [each.offset for each in (left, right)]
        if operator == "+" or not all(scales):  # of two temperatures there is a difference
            self._refuse_offsets(left, right)
        left, right = self._in_one_unit([left, right], term.operator_span, f"be {word}")
        unit = left.unit and replace(left.unit, offset=Fraction(0))
        if left.constant is not None and right.constant is not None:
            signed = right.constant if operator == "+" else -right.constant
            return _constant(left.constant + signed, unit, term.span, left.plain and right.plain)
        if operator == "-" and left.expression == right.expression:
            ends = (0.0, 0.0)
        else:
            second = right.interval if operator == "+" else intervals.negated(right.interval)
            ends = intervals.added(left.interval, second)
        expression = Binary(operator, self._part(left), self._part(right))
        return _Number(expression, unit, ends, term.span)

    def _product(self, left: _Number, right: _Number, term: rules.Arithmetic) -> _Number:
        left, right = self._factors(left, right)
        unit = self._combined(units.product, left, right, term)
        if left.constant is not None and right.constant is not None:
            plain = left.plain and right.plain
            return _constant(left.constant * right.constant, unit, term.span, plain)
        if left.expression == right.expression:
            ends = intervals.squared(left.interval)
        else:
            ends = intervals.multiplied(left.interval, right.interval)
        expression = Binary("*", self._part(left), self._part(right))
        return _Number(expression, unit, ends, term.span)

    def _quotient(self, left: _Number, right: _Number, term: rules.Arithmetic) -> _Number:
        if right.constant == 0:
            message = f"'{term.span.text}' has no value: it divides by zero"
            raise self._fault(codes.WRONG_OPERAND, message, term.operator_span)
        left, right = self._factors(left, right)
        unit = self._combined(units.quotient, left, right, term)
        if left.constant is not None and right.constant is not None:
            plain = left.plain and right.plain
            return _constant(left.constant / right.constant, unit, term.span, plain)
        if right.interval[0] <= 0.0 <= right.interval[1]:
            self.unknown_while = f"'{right.span.text}' is zero"
        divided = Binary("/", self._part(left), self._named(right))
        ends = intervals.divided(left.interval, right.interval)
        return _Number(formulas.guarded_division(divided), unit, ends, term.span)

    def _negative(self, operand: _Number, span: Span) -> _Number:
        self._refuse_offsets(operand)
        if operand.constant is not None:
            return _constant(-operand.constant, operand.unit, span, operand.plain)
        expression = formulas.Negative(self._part(operand))
        return _Number(expression, operand.unit, intervals.negated(operand.interval), span)

    # Functions ----------------------------------------------------------------------------------

    def _call(self, call: rules.Call, numbers: list[_Number]) -> _Number:
        name, place = call.function.text, call.function.span
        if name in ("sin", "cos", "tan"):
            found = self._of_angle(call, numbers[0])
        elif name == "sqrt":
            found = self._root(call, numbers[0])
        else:
            if name not in ("min", "max"):
                self._refuse_offsets(*numbers)
            numbers = self._in_one_unit(numbers, place, f"stand in one '{name}()'")
            found = self._of_like(call, numbers)
        if any(each.constant is None for each in numbers):
            return found
        value = formulas.number(found.expression, {})  # of constants, which have no names
        if not math.isfinite(value):
            message = f"'{call.span.text}' has no value"
            raise self._fault(codes.WRONG_OPERAND, message, call.span)
        plain = all(each.plain for each in numbers)
        return _constant(Fraction(value), found.unit, call.span, plain)

    def _of_like(self, call: rules.Call, numbers: list[_Number]) -> _Number:
        """Return a function of numbers in one unit."""
        parts = [self._named(each) for each in numbers]
        ends = [each.interval for each in numbers]
        unit = numbers[0].unit
        match call.function.text:
            case "abs":
                expression, interval = _absolute(parts[0]), intervals.absolute(ends[0])
            case "min" | "max" as name:
                expression = parts[0]
                for part in parts[1:]:
                    chosen = "least" if name == "min" else "greatest"
                    expression = formulas.guarded_call(chosen, (expression, part))
                pick = intervals.least_of if name == "min" else intervals.greatest_of
                interval = pick(*ends)
            case "atan2":
                expression = formulas.guarded_call("atan2", (parts[0], parts[1]))
                unit, interval = self._radian, (-math.pi, math.pi)
            case _:  # hypot
                expression, interval = Binary("*", parts[0], parts[0]), intervals.squared(ends[0])
                for part, each in zip(parts[1:], ends[1:], strict=True):
                    expression = Binary("+", expression, Binary("*", part, part))
                    interval = intervals.added(interval, intervals.squared(each))
                expression = formulas.guarded_call("sqrt", (expression,))
                interval = intervals.root(interval)
        return _Number(expression, unit, interval, call.span)

    def _of_angle(self, call: rules.Call, angle: _Number) -> _Number:
        name, unit = call.function.text, angle.unit
        if unit is not None and unit.exponents:
            assert self._radian is not None
            if not self._scope.units.compatible(unit, self._radian):
                message = f"'{angle.span.text}' is in {unit} ({unit.dimension}), not an angle"
                hint = f"'{name}()' takes an angle, or a plain number of radians"
                raise self._fault(codes.INCOMPATIBLE_UNITS, message, angle.span, hint)
            angle = self._converted(angle, self._radian)
        expression = formulas.guarded_call(name, (self._named(angle),))
        ends = intervals.ALL if name == "tan" else (-1.0, 1.0)
        return _Number(expression, self._one, ends, call.span)

    def _root(self, call: rules.Call, operand: _Number) -> _Number:
        self._refuse_offsets(operand)
        if operand.interval[1] < 0.0:
            message = f"'{call.span.text}' has no value: '{operand.span.text}' is below zero"
            raise self._fault(codes.WRONG_OPERAND, message, call.span)
        if operand.interval[0] < 0.0:
            self.unknown_while = f"'{operand.span.text}' is below zero"
        unit = operand.unit
        if unit is not None:
            operand = self._converted(operand, replace(unit, factor=Fraction(1)))
            unit = units.root(unit)
        expression = formulas.guarded_call("sqrt", (self._named(operand),))
        return _Number(expression, unit, intervals.root(operand.interval), call.span)

    # Units --------------------------------------------------------------------------------------

    def _in_one_unit(self, numbers: list[_Number], place: Span, what: str) -> list[_Number]:
        """Return numbers in the unit of the first that has one; ``what`` others cannot do."""
        known = [each for each in numbers if each.unit is not None and not each.plain]
        if not known:
            return numbers
        first, unit = known[0], known[0].unit
        assert unit is not None
        if any(each.unit is None for each in numbers):
            unit = units.in_bases(unit)
        for each in known:
            assert each.unit is not None
            if not self._scope.units.compatible(each.unit, unit):
                message = (
                    f"'{first.span.text}' is in {unit} ({unit.dimension}), '{each.span.text}' in"
                    f" {each.unit} ({each.unit.dimension}): they cannot {what}"
                )
                raise self._fault(codes.INCOMPATIBLE_UNITS, message, place)
        return [
            self._converted(each, unit)
            if each.unit is not None and not each.plain
            else replace(each, unit=unit, plain=False)
            for each in numbers
        ]

    def _converted(self, number: _Number, unit: Unit) -> _Number:
        source = number.unit
        assert source is not None
        scale = source.factor / unit.factor
        offset = (source.offset - unit.offset) / unit.factor
        if number.constant is not None:
            return _constant(number.constant * scale + offset, unit, number.span)
        expression, interval = number.expression, number.interval
        if scale != 1:
            factor = rounded(scale)
            expression = Binary("*", self._part(number), formulas.Number(factor))
            interval = intervals.multiplied(interval, (factor, factor))
        if offset:
            shift = rounded(offset)
            expression = Binary("+", expression, formulas.Number(shift))
            interval = intervals.added(interval, (shift, shift))
        return replace(number, expression=expression, unit=unit, interval=interval)

    def _factors(self, left: _Number, right: _Number) -> tuple[_Number, _Number]:
        """Return two factors; beside one whose unit is not known, the other is in base units."""
        self._refuse_offsets(left, right)
        if left.unit is None and right.unit is not None:
            return left, self._converted(right, units.in_bases(right.unit))
        if right.unit is None and left.unit is not None:
            return self._converted(left, units.in_bases(left.unit)), right
        return left, right

    def _combined(
        self,
        combine: Callable[[Unit, Unit], Unit | None],
        left: _Number,
        right: _Number,
        term: rules.Arithmetic,
    ) -> Unit | None:
        """Return the unit of a product or quotient; a radian beside a length is 1."""
        if left.unit is None or right.unit is None:
            return None
        found = combine(left.unit, right.unit)
        if found is None:
            message = f"the unit of '{term.span.text}' is too far from all units in use"
            raise self._fault(codes.INCOMPATIBLE_UNITS, message, term.operator_span)
        bases = {base for base, _ in found.exponents}
        return units.without_angles(found) if {"m", "rad"} <= bases else found

    def _refuse_offsets(self, *numbers: _Number) -> None:
        """Report a number on a scale with a zero of its own."""
        for each in numbers:
            if each.offset:
                message = f"'{each.span.text}' is in {each.unit}, which has a zero of its own"
                hint = "of two such numbers the difference can be computed, 'a - b > 5 K'"
                raise self._fault(codes.INCOMPATIBLE_UNITS, message, each.span, hint)

    # Formulas -----------------------------------------------------------------------------------

    def _part(self, number: _Number) -> Expression:
        """Return a number as an operand; a choice gets a name, so that it is not nested."""
        found = number.expression
        return self._assign(found) if isinstance(found, Choice) else found

    def _named(self, number: _Number) -> Expression:
        """Return a number as an operand that is written more than once."""
        return self._assign(number.expression)

    def _assign(self, expression: Expression) -> Expression:
        if isinstance(expression, Name | formulas.Number):
            return expression
        for name, value in self._assigned.items():
            if value == expression:
                return Name(name)
        name = f"part_{len(self._assigned) + 1}"
        self._assigned[name] = expression
        return Name(name)


def scaled(value: ir.Compute, factor: float, offset: float) -> ir.Compute:
    """Return arithmetic whose result is converted to another unit."""
    formula, name = value.formula, "converted"
    converted = Binary("*", Name(name), formulas.Number(factor))
    if offset:
        converted = Binary("+", converted, formulas.Number(offset))
    assignments = (*formula.assignments, (name, formula.result))
    return replace(value, formula=Formula(assignments, converted))


def _constant(number: Fraction, unit: Unit | None, span: Span, plain: bool = False) -> _Number:
    value = rounded(number)
    return _Number(formulas.Number(value), unit, (value, value), span, number, plain)


def _absolute(part: Expression) -> Expression:
    """Return the absolute value: of both zeros it is 0, and of what is unknown it is unknown."""
    zero = formulas.Number(0.0)
    return Choice(Relation(">", part, zero), part, Binary("-", zero, part))
