"""Arithmetic of the rules: checked for dimensions, and resolved into formulas of doubles.

One term becomes one formula, whatever it is nested of: its operands are fields and functions of
them, each of which may come from another topic, and units are converted within it. Constants alone
are computed exactly.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from typing import Literal

from deros import codes
from deros.diagnostics import Code, Span
from deros.interfaces import units
from deros.interfaces.types import FieldType
from deros.interfaces.units import Unit
from deros.metamodels.reading import MAX_DEPTH, too_deep
from deros.models import rules
from deros.rules.compiler.scope.field_units import plain_beside
from deros.rules.compiler.scope.resolved import (
    AgeOf,
    DeclaredInput,
    FrequencyOf,
    Quantity,
    Resolved,
    Value,
    family,
)
from deros.rules.compiler.scope.scope import Scope
from deros.rules.compiler.terms.arithmetic_number import Number, constant
from deros.rules.compiler.terms.operations import CALLS, is_arithmetic
from deros.rules.compiler.terms.term_names import describe
from deros.rules.functions.reads import strip_comments
from deros.rules.program import formulas, intervals, ir
from deros.rules.program.bounds import rounded
from deros.rules.program.formulas import Binary, Choice, Expression, Formula, Name, Relation


class _FaultError(Exception):
    """A fault has been reported; the term has no value."""


class ArithmeticTerm:
    """Resolves one outermost term of arithmetic."""

    def __init__(self, scope: Scope, resolve: Callable[[rules.Term], Resolved | None]) -> None:
        """Resolve operands that are no arithmetic with ``resolve``."""
        self._scope = scope
        self._resolve = resolve
        self._operands: dict[ir.Read | ir.Apply | ir.Tuned, str] = {}
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
        if computed.is_fixed and (self.unknown_while or math.inf in (-ends[0], ends[1])):
            why = f" while {self.unknown_while}" if self.unknown_while else ""
            message = f"'{written}' has no value{why}, and its constants can be tuned so"
            self._scope.fault(codes.BAD_TUNABLE, message, term.span, "narrow their intervals")
            return None
        return Value(
            computed,
            FieldType("float64"),
            found.unit,
            self._inputs[0] if self._inputs else None,
            ends,
            undeclared=found.undeclared,
        )

    def _number(self, term: rules.Term) -> Number:
        if self._scope.nesting > MAX_DEPTH:
            self._scope.diagnostics.append(too_deep(term.span))
            raise _FaultError
        self._scope.nesting += 1
        try:
            match term:
                case rules.Arithmetic():
                    left, right = self._number(term.left), self._number(term.right)
                    return _open(self._operation(term, left, right), [left, right])
                case rules.Negative():
                    operand = self._number(term.operand)
                    return _open(self._negative(operand, term.span), [operand])
                case rules.Call() if is_arithmetic(term):
                    numbers = self._arguments(term)
                    return _open(self._call(term, numbers), numbers)
            return self._operand(term, self._resolve(term))
        finally:
            self._scope.nesting -= 1

    def _fault(self, code: Code, message: str, span: Span, hint: str = "") -> _FaultError:
        """Report a fault, and return what is to be raised."""
        self._scope.fault(code, message, span, hint)
        return _FaultError()

    # Operands -----------------------------------------------------------------------------------

    def _operand(self, term: rules.Term, found: Resolved | None) -> Number:
        match found:
            case None:
                raise _FaultError
            case Quantity():
                unit = found.shown_in or self._one
                number = found.in_unit(found.shown_in)
                return constant(number, unit, term.span, found.unit is None)
            case Value(expression=ir.Read() | ir.Apply() | ir.Tuned() as expression) if (
                family(found.type) == "number"
            ):
                if expression not in self._operands:
                    self._operands[expression] = f"x{len(self._operands) + 1}"
                    self._inputs += [found.input] if found.input is not None else []
                return Number(
                    Name(self._operands[expression]),
                    found.unit,
                    intervals.interval_of(found.bounds),
                    term.span,
                    undeclared=found.undeclared,
                )
            case AgeOf():
                message = "'age()' is compared with a constant only"
                raise self._fault(codes.AGE_NOT_CONSTANT, message, term.span)
            case FrequencyOf():
                message = "'frequency()' is compared with a constant only"
                raise self._fault(codes.BAD_FREQUENCY, message, term.span)
        message = f"arithmetic needs numbers, '{term.span.text}' is {describe(found)}"
        raise self._fault(codes.FIELD_NOT_NUMERIC, message, term.span)

    def _arguments(self, call: rules.Call) -> list[Number]:
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

    def _operation(self, term: rules.Arithmetic, left: Number, right: Number) -> Number:
        match term.operator:
            case "+" | "-" as operator:
                return self._sum(operator, left, right, term)
            case "*":
                return self._product(left, right, term)
            case "/":
                return self._quotient(left, right, term)

    def _sum(
        self, operator: Literal["+", "-"], left: Number, right: Number, term: rules.Arithmetic
    ) -> Number:
        word = "added" if operator == "+" else "subtracted from one another"
        scales = [each.offset for each in (left, right)]
        if operator == "+" or not all(scales):  # of two temperatures there is a difference
            self._refuse_offsets(left, right)
        left, right = self._in_one_unit([left, right], term.operator_span, f"be {word}")
        unit = left.unit and units.without_offset(left.unit)
        if left.constant is not None and right.constant is not None:
            signed = right.constant if operator == "+" else -right.constant
            return constant(left.constant + signed, unit, term.span, left.plain and right.plain)
        if operator == "-" and left.expression == right.expression:
            ends = (0.0, 0.0)
        else:
            second = right.interval if operator == "+" else intervals.negated(right.interval)
            ends = intervals.added(left.interval, second)
        expression = Binary(operator, self._part(left), self._part(right))
        return Number(expression, unit, ends, term.span)

    def _product(self, left: Number, right: Number, term: rules.Arithmetic) -> Number:
        self._factors(left, right)
        unit = self._combined(units.product, left, right, term)
        if left.constant is not None and right.constant is not None:
            plain = left.plain and right.plain
            return constant(left.constant * right.constant, unit, term.span, plain)
        if left.expression == right.expression:
            ends = intervals.squared(left.interval)
        else:
            ends = intervals.multiplied(left.interval, right.interval)
        expression = Binary("*", self._part(left), self._part(right))
        return Number(expression, unit, ends, term.span)

    def _quotient(self, left: Number, right: Number, term: rules.Arithmetic) -> Number:
        if right.constant == 0:
            message = f"'{term.span.text}' has no value: it divides by zero"
            raise self._fault(codes.WRONG_OPERAND, message, term.operator_span)
        self._factors(left, right)
        unit = self._combined(units.quotient, left, right, term)
        if left.constant is not None and right.constant is not None:
            plain = left.plain and right.plain
            return constant(left.constant / right.constant, unit, term.span, plain)
        if right.interval[0] <= 0.0 <= right.interval[1]:
            self.unknown_while = f"'{right.span.text}' is zero"
        divided = Binary("/", self._part(left), self._named(right))
        ends = intervals.divided(left.interval, right.interval)
        return Number(formulas.guarded_division(divided), unit, ends, term.span)

    def _negative(self, operand: Number, span: Span) -> Number:
        self._refuse_offsets(operand)
        if operand.constant is not None:
            return constant(-operand.constant, operand.unit, span, operand.plain)
        expression = formulas.Negative(self._part(operand))
        return Number(expression, operand.unit, intervals.negated(operand.interval), span)

    # Functions ----------------------------------------------------------------------------------

    def _call(self, call: rules.Call, numbers: list[Number]) -> Number:
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
        return constant(Fraction(value), found.unit, call.span, plain)

    def _of_like(self, call: rules.Call, numbers: list[Number]) -> Number:
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
        return Number(expression, unit, interval, call.span)

    def _of_angle(self, call: rules.Call, angle: Number) -> Number:
        name, unit = call.function.text, angle.unit
        assert self._radian is not None
        if unit is None:
            self._scope.field_units.use(angle.undeclared, self._radian, angle.span)
        elif unit.exponents:
            if not self._scope.units.compatible(unit, self._radian):
                message = f"'{angle.span.text}' is in {unit} ({unit.dimension}), not an angle"
                hint = f"'{name}()' takes an angle, or a plain number of radians"
                raise self._fault(codes.INCOMPATIBLE_UNITS, message, angle.span, hint)
            angle = self._converted(angle, self._radian)
        expression = formulas.guarded_call(name, (self._named(angle),))
        ends = intervals.ALL if name == "tan" else (-1.0, 1.0)
        return Number(expression, self._one, ends, call.span)

    def _root(self, call: rules.Call, operand: Number) -> Number:
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
        return Number(expression, unit, intervals.root(operand.interval), call.span)

    # Units --------------------------------------------------------------------------------------

    def _in_one_unit(self, numbers: list[Number], place: Span, what: str) -> list[Number]:
        """Return numbers in the unit of the first that has one; ``what`` others cannot do."""
        known = [each for each in numbers if each.unit is not None and not each.plain]
        if not known:
            return numbers
        first, unit = known[0], known[0].unit
        assert unit is not None
        for each in numbers:
            if each.plain:
                self._refuse_hidden(each, first)
            elif each.unit is None and units.is_one(unit):
                self._scope.field_units.use(each.undeclared, None, each.span)
            elif each.unit is None:
                raise self._undeclared_beside(each, first)
            elif not self._scope.units.compatible(each.unit, unit):
                message = (
                    f"'{first.span.text}' is in {unit} ({unit.dimension}), '{each.span.text}' in"
                    f" {each.unit} ({each.unit.dimension}): they cannot {what}"
                )
                raise self._fault(codes.INCOMPATIBLE_UNITS, message, place)
            elif any(
                one.is_computed and units.is_difference_of(one.unit, other.unit)
                for one, other in ((each, first), (first, each))
            ):
                message = (
                    f"one of '{first.span.text}' and '{each.span.text}' is a temperature, the"
                    f" other a difference of temperatures: they cannot {what}"
                )
                raise self._fault(codes.INCOMPATIBLE_UNITS, message, place)
        return [
            self._converted(each, unit)
            if each.unit is not None and not each.plain
            else replace(each, unit=unit, plain=False)
            for each in numbers
        ]

    def _converted(self, number: Number, unit: Unit) -> Number:
        source = number.unit
        assert source is not None
        scale = source.factor / unit.factor
        offset = (source.offset - unit.offset) / unit.factor
        if number.constant is not None:
            return constant(number.constant * scale + offset, unit, number.span)
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

    def _factors(self, left: Number, right: Number) -> None:
        """Report two numbers of which there is no product."""
        self._refuse_offsets(left, right)
        for one, other in ((left, right), (right, left)):
            unit = other.unit
            if one.unit is None and unit is not None and not units.is_one(unit):
                raise self._undeclared_beside(one, other)

    def _undeclared_beside(self, number: Number, quantity: Number) -> _FaultError:
        """Report a number without a known unit beside one that has one."""
        units_of = self._scope.field_units
        self._scope.diagnostics += units_of.undeclared(
            number.undeclared, quantity.span.text, number.span
        )
        return _FaultError()

    def _refuse_hidden(self, plain: Number, other: Number) -> None:
        """Report a plain number beside what is computed in a unit that nobody sees."""
        assert other.unit is not None
        assert plain.constant is not None
        if not other.is_computed:
            return
        found = list(plain_beside(plain.constant, other.span.text, other.unit, plain.span))
        if found:
            self._scope.diagnostics += found
            raise _FaultError

    def _combined(
        self,
        combine: Callable[[Unit, Unit], Unit | None],
        left: Number,
        right: Number,
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

    def _refuse_offsets(self, *numbers: Number) -> None:
        """Report a number on a scale with a zero of its own."""
        for each in numbers:
            if each.offset:
                message = f"'{each.span.text}' is in {each.unit}, which has a zero of its own"
                hint = "of two such numbers the difference can be computed, 'a - b > 5 K'"
                raise self._fault(codes.INCOMPATIBLE_UNITS, message, each.span, hint)

    # Formulas -----------------------------------------------------------------------------------

    def _part(self, number: Number) -> Expression:
        """Return a number as an operand; a choice gets a name, so that it is not nested."""
        found = number.expression
        return self._assign(found) if isinstance(found, Choice) else found

    def _named(self, number: Number) -> Expression:
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


def _open(number: Number, operands: list[Number]) -> Number:
    """Return what is computed of operands, with the fields whose units keep its own unknown."""
    if number.unit is not None:
        return number
    fields = dict.fromkeys(field for each in operands for field in each.undeclared)
    return replace(number, undeclared=tuple(fields))


def _absolute(part: Expression) -> Expression:
    """Return the absolute value: of both zeros it is 0, and of what is unknown it is unknown."""
    zero = formulas.Number(0.0)
    return Choice(Relation(">", part, zero), part, Binary("-", zero, part))
