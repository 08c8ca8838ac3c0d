"""The numbers that a term of arithmetic is computed of, with what is known of each."""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction

from deros.diagnostics import Span
from deros.interfaces.units import Unit
from deros.rules.compiler.scope.resolved import FieldKey
from deros.rules.program import formulas, ir
from deros.rules.program.bounds import rounded
from deros.rules.program.formulas import Binary, Expression, Formula, Name
from deros.rules.program.intervals import Interval


@dataclass(frozen=True, slots=True)
class Number:
    """A number within a term of arithmetic.

    Attributes:
        expression: its value.
        unit: ``None`` where it is not known.
        interval: between which ends its value lies.
        span: where it is written.
        constant: its exact value in ``unit``, if it is one.
        plain: whether it is a constant without a unit, which is in any unit.
        undeclared: where the unit is not known, the fields whose units are not.
    """

    expression: Expression
    unit: Unit | None
    interval: Interval
    span: Span
    constant: Fraction | None = None
    plain: bool = False
    undeclared: tuple[FieldKey, ...] = ()

    @property
    def is_computed(self) -> bool:
        """Whether it is computed of what messages say."""
        return not isinstance(self.expression, Name | formulas.Number)

    @property
    def offset(self) -> Fraction:
        """The zero of its scale, if that is not the zero of what it measures."""
        return self.unit.offset if self.unit is not None else Fraction(0)


def constant(number: Fraction, unit: Unit | None, span: Span, plain: bool = False) -> Number:
    """Return an exact constant."""
    value = rounded(number)
    return Number(formulas.Number(value), unit, (value, value), span, number, plain)


def scaled(value: ir.Compute, factor: float, offset: float) -> ir.Compute:
    """Return arithmetic whose result is converted to another unit."""
    formula, name = value.formula, "converted"
    converted = Binary("*", Name(name), formulas.Number(factor))
    if offset:
        converted = Binary("+", converted, formulas.Number(offset))
    assignments = (*formula.assignments, (name, formula.result))
    return replace(value, formula=Formula(assignments, converted))
