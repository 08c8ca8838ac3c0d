"""Tunable constants: numbers of the rules that each safety node may set, within an interval.

They are parameters of the safety node, so that rules as written tell them as well as a program.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from decimal import Decimal
from fractions import Fraction

from deros.diagnostics import Span
from deros.interfaces.units import Unit, UnitRegistry, rounded
from deros.models.common import Interval, Value
from deros.models.node import Parameter, ParameterType
from deros.models.rules import Constant, Negative, Number, Rules, Term


@dataclass(frozen=True, slots=True)
class TunableConstant:
    """A tunable constant, all numbers in the unit of its value.

    Attributes:
        name: of the constant, and of the parameter.
        default: its value where the node does not set it.
        lower, upper: the least and the greatest value that it can be set to.
        unit: as written; empty for a plain number.
        description: what it is for, for people.
    """

    name: str
    default: float
    lower: float
    upper: float
    unit: str
    span: Span = field(compare=False, repr=False)
    description: str = ""

    def refusal(self, value: object) -> str:
        """Return why the constant cannot have a value; nothing if it can."""
        if isinstance(value, bool) or not isinstance(value, int | float):
            return f"{value!r} is not a number"
        return "" if self.lower <= value <= self.upper else f"{value} is outside {self.interval}"

    @property
    def interval(self) -> str:
        """The interval as text, with its unit."""
        return f"[{self.lower}, {self.upper}]{f' {self.unit}' if self.unit else ''}"


def tunable_parameter(constant: TunableConstant) -> Parameter:
    """Return the parameter that a tunable constant is.

    Node descriptions do not know the units that rules define: such a one is in its description.
    """
    unit, description = constant.unit or None, constant.description
    if unit is not None and UnitRegistry().parse(unit) is None:
        unit, description = None, f"{description} (in {unit})".lstrip()
    return Parameter(
        constant.name,
        ParameterType.DOUBLE,
        constant.default,
        constant.span,
        constant.span,
        unit=unit,
        interval=Interval(constant.lower, constant.upper),
        read_only=True,
        description=description,
    )


def tunables_of(rules: Rules) -> tuple[TunableConstant, ...]:
    """Return the tunable constants of rules as written, without those that are faulty."""
    return tuple(_tunables(rules))


def _tunables(rules: Rules) -> Iterator[TunableConstant]:
    registry: UnitRegistry | None = None
    names: set[str] = set()
    for each in rules.constants:
        if each.tunable is None or each.name.text in names:
            continue
        names.add(each.name.text)
        registry = registry or UnitRegistry(rules.own_units)
        found = tunable_constant(each, registry)
        if isinstance(found, TunableConstant):
            yield found


@dataclass(frozen=True, slots=True)
class TunableFault:
    """What is wrong with a tunable constant, and the place."""

    message: str
    span: Span
    hint: str = ""


def tunable_constant(written: Constant, units: UnitRegistry) -> TunableConstant | TunableFault:
    """Return a tunable constant, or the first fault of it."""
    tunable, name = written.tunable, written.name
    assert tunable is not None
    default = _number(written.value)
    if default is None:
        message = f"the tunable constant '{name}' has no number as its value"
        hint = "write the number itself, with its unit: what is tuned is a single number"
        return TunableFault(message, written.value.span, hint)
    if not tunable.closed:
        message = f"'{name}' may be set to both ends of its interval"
        return TunableFault(message, tunable.interval_span, "write the ends in '[' and ']'")
    unit = _unit(default, units)
    if isinstance(unit, TunableFault):
        return unit
    ends: list[Fraction] = []
    for term in (tunable.lower, tunable.upper):
        number = _number(term)
        if number is None:
            message = f"the ends of the interval of '{name}' are numbers, '{term.span.text}' is not"
            return TunableFault(message, term.span)
        end = _in_unit(number, tunable.unit, default.unit, unit, units)
        if isinstance(end, TunableFault):
            return end
        ends.append(end)
    lower, upper = ends
    value = Fraction(default.value)
    if not lower < upper:
        message = f"the interval {tunable.interval_span.text} leaves nothing to tune"
        hint = "write the lesser end first" if lower > upper else ""
        return TunableFault(message, tunable.interval_span, hint)
    if not lower <= value <= upper:
        where = f"{tunable.interval_span.text}{f' {tunable.unit}' if tunable.unit else ''}"
        message = f"the value '{written.value.span.text}' is outside the interval {where}"
        return TunableFault(message, written.value.span)
    least, middle, greatest = map(rounded, (lower, value, upper))
    if math.isinf(least) or math.isinf(greatest):
        message = f"the interval of '{name}' has ends that no double holds"
        return TunableFault(message, tunable.interval_span)
    unit_text = default.unit or ""
    return TunableConstant(
        name.text, middle, least, greatest, unit_text, written.span, tunable.description
    )


def in_unit_of(
    constant: TunableConstant, value: Value, unit: str | None, rules: Rules
) -> float | None:
    """Return a number in the unit of a constant, where ``unit`` follows it; ``None`` if it cannot.

    Without a unit it is in that of the constant.
    """
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    if unit is None:
        return float(value)
    registry = UnitRegistry(rules.own_units)
    source, target = registry.parse(unit), registry.parse(constant.unit or "1")
    if source is None or target is None or not registry.compatible(source, target):
        return None
    return registry.convert(Decimal(str(value)), source, target)


def _number(term: Term) -> Number | None:
    """Return a number as written, with its sign."""
    match term:
        case Number():
            return term
        case Negative(operand=Number() as number):
            return Number(-number.value, term.span, number.unit, number.unit_span)
    return None


def _unit(number: Number, units: UnitRegistry) -> Unit | TunableFault | None:
    if number.unit is None:
        return None
    found = units.parse(number.unit)
    if found is None:
        message = f"unknown unit '{number.unit}'"
        return TunableFault(message, number.unit_span or number.span)
    return found


def _in_unit(
    number: Number, common: str | None, wanted: str | None, unit: Unit | None, units: UnitRegistry
) -> Fraction | TunableFault:
    """Return an end of an interval in the unit of the value; ``common`` is that of both ends."""
    text = number.unit or common
    if text is None and unit is None:
        return Fraction(number.value)
    if text is None:
        message = f"the interval has no unit, the value is in {wanted}"
        return TunableFault(
            message, number.span, f"write the unit after the interval: '] {wanted}'"
        )
    found = units.parse(text)
    place = number.unit_span or number.span
    if found is None:
        return TunableFault(f"unknown unit '{text}'", place)
    if unit is None:
        message = f"the interval is in {text}, the value is a plain number"
        return TunableFault(message, place, "write the unit after the value, too")
    if not units.compatible(found, unit):
        message = (
            f"the interval is in {text} ({found.dimension}), the value in {wanted}"
            f" ({unit.dimension})"
        )
        return TunableFault(message, place)
    return (Fraction(number.value) * found.factor + found.offset - unit.offset) / unit.factor
