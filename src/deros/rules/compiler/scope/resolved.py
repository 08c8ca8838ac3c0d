"""What the terms of the rules turn out to be, once their names are resolved."""

from __future__ import annotations

from dataclasses import dataclass, field
from decimal import Decimal
from fractions import Fraction

from deros.diagnostics import Span
from deros.interfaces.fields import FieldPath
from deros.interfaces.types import (
    FLOAT_TYPES,
    INTEGER_RANGES,
    STRING_TYPES,
    Constant,
    FieldType,
    InterfaceType,
    MessageDefinition,
)
from deros.interfaces.units import Unit
from deros.models import rules
from deros.rules.program import ir
from deros.rules.program.bounds import Bounds

FieldKey = tuple[str, FieldPath]
"""A field of all messages of a topic: the topic, and the path from the root of its message."""


@dataclass(frozen=True, slots=True)
class Quantity:
    """A constant number.

    Attributes:
        value: exact, in ``unit``.
        unit: as written; ``None`` for a plain number.
        shown_in: the unit in which it stands where nothing asks for another one: the one it was
            written in, or that of the conversion function around it.
        whole: whether it is written as an integer.
    """

    value: Fraction
    unit: Unit | None
    shown_in: Unit | None
    whole: bool

    def in_unit(self, target: Unit | None) -> Fraction:
        """Return the exact value in ``target``; the units must be compatible.

        A plain number is in any unit already, and where no unit is known it stands as shown.
        """
        unit = target or self.shown_in
        if self.unit is None or unit is None:
            return self.value
        base = self.value * self.unit.factor + self.unit.offset
        return (base - unit.offset) / unit.factor


@dataclass(frozen=True, slots=True)
class Plain:
    """A constant boolean or text."""

    value: bool | str


@dataclass(frozen=True, slots=True)
class MessageConstant:
    """A constant of a message definition, used by name."""

    constant: Constant


@dataclass(frozen=True, slots=True)
class Mounted:
    """Where a sensor is on the robot, in metres, and the cosine and sine of its yaw.

    Its coordinates are those of the robot, turned by the yaw about where it is.
    """

    x: Fraction
    y: Fraction
    cosine: Fraction
    sine: Fraction

    def seen(self, x: Fraction, y: Fraction) -> tuple[Fraction, Fraction]:
        """Return a place on the robot in the coordinates of the sensor, in metres."""
        along, across = x - self.x, y - self.y
        return (
            along * self.cosine + across * self.sine,
            across * self.cosine - along * self.sine,
        )


@dataclass(slots=True)
class DeclaredInput:
    """An input line, or a topic term in a rule, with its topic's type found.

    ``index`` is its place in the program, given when something first reads it. ``zero_is_free``: a
    laser scanner's range of 0 means that nothing is there. ``needs_one_publisher``: it is unknown
    while there are several. ``mounted``: where a laser scanner is on the robot, if that is said.
    """

    name: str
    topic: str
    type: InterfaceType
    path: FieldPath
    timeout_ns: int | None
    span: Span
    index: int | None = None
    zero_is_free: bool = False
    needs_one_publisher: bool = False
    mounted: Mounted | None = None


@dataclass(frozen=True, slots=True)
class Part:
    """A part of an input's message that is not a single value: a message or an array."""

    input: DeclaredInput
    path: FieldPath  # from the root of the message
    type: FieldType
    message: MessageDefinition | None  # the one whose field it is


@dataclass(frozen=True, slots=True)
class Value:
    """A single value read from an input, or a number computed of tunable constants.

    Attributes:
        expression: how the monitor computes it.
        type: a primitive.
        unit: ``None`` when no unit is known.
        input: what it is read from; ``None`` if tunable constants are all that it comes from.
        bounds: least and greatest value that it can have.
        message: the message whose constants may be compared with it by name.
        turn: of an angle that jumps by a full turn where it begins anew, that turn in its unit.
        undeclared: where no unit is known, the fields whose units are not.
    """

    expression: ir.ValueExpression
    type: FieldType
    unit: Unit | None
    input: DeclaredInput | None
    bounds: tuple[Fraction | float, Fraction | float]
    message: MessageDefinition | None = None
    turn: float | None = None
    undeclared: tuple[FieldKey, ...] = ()

    @property
    def is_integer(self) -> bool:
        """Whether it takes integer values only."""
        return self.type.base in INTEGER_RANGES

    @property
    def is_tuned(self) -> bool:
        """Whether it is known when the monitor starts: it comes from tunable constants alone."""
        return self.input is None


@dataclass(frozen=True, slots=True)
class AgeOf:
    """``age()`` of an input."""

    input: DeclaredInput


@dataclass(frozen=True, slots=True)
class FrequencyOf:
    """``frequency()`` of the last so many messages of an input."""

    input: DeclaredInput
    messages: int


@dataclass(frozen=True, slots=True)
class MissingOf:
    """``missing()`` of an input."""

    input: DeclaredInput


@dataclass(frozen=True, slots=True)
class UnknownOf:
    """``unknown()`` of an input or, with ``function``, of that function of it."""

    input: DeclaredInput
    function: ir.Apply | None


@dataclass(frozen=True, slots=True)
class EntriesHold:
    """``any()`` or ``all()`` of entries: a comparison of how many satisfy a condition."""

    input: DeclaredInput
    condition: ir.Compare
    function: ir.Apply


@dataclass(frozen=True, slots=True)
class InsideOf:
    """``inside()`` of a point: whether it is in a zone."""

    input: DeclaredInput
    condition: ir.Compare


Fixed = Quantity | Plain | MessageConstant
"""What is known before the monitor runs."""

Resolved = (
    Fixed | Part | Value | AgeOf | FrequencyOf | MissingOf | UnknownOf | EntriesHold | InsideOf
)


@dataclass(frozen=True, slots=True)
class ResolvedComparison:
    """A comparison of the rules with its types, as the checks of value ranges need it.

    Attributes:
        condition: what it comes from.
        operand: the value on its left side (a constant on the left has been moved to the right).
        bounds: which numbers satisfy it; ``None`` where no constant number decides that.
        exact: whether it tests floating-point values for equality.
        other: of a comparison of two values, the operator and the value on the right.
        possible: of one with tunable constants, the numbers for which it can be true, whatever
            they are set to, and those for which it can be false.
    """

    condition: rules.Comparison | rules.Membership = field(compare=False)
    operand: Value
    bounds: Bounds | None
    exact: bool
    other: tuple[ir.Operator, Value] | None = None
    possible: tuple[Bounds, Bounds] | None = None

    @property
    def satisfying(self) -> Bounds | None:
        """Which numbers satisfy it, for some values of its tunable constants if it has any."""
        return self.possible[0] if self.possible is not None else self.bounds


@dataclass(frozen=True, slots=True)
class AppliedFunction:
    """A function of a message or of an array, or arithmetic, where it is written.

    Attributes:
        expression: what the monitor computes.
        type: of what it is applied to.
        span: of the whole.
        unknown_while: of arithmetic, what makes it unknown while its operands are known.
    """

    expression: ir.Apply | ir.Compute
    type: FieldType
    span: Span = field(compare=False, repr=False)
    unknown_while: str = ""


def family(kind: FieldType) -> str:
    """Return what a single value is compared as: ``number``, ``boolean`` or ``text``."""
    if kind.base in STRING_TYPES:
        return "text"
    return "boolean" if kind.base == "bool" else "number"


def family_of(value: bool | float | str) -> str:
    """Return what a constant is compared as: ``number``, ``boolean`` or ``text``."""
    if isinstance(value, str):
        return "text"
    return "boolean" if isinstance(value, bool) else "number"


def is_written_whole(value: Decimal) -> bool:
    """Return whether a number is written as an integer: ``3``, not ``3.0``."""
    exponent = value.as_tuple().exponent
    return isinstance(exponent, int) and exponent >= 0


def is_float(kind: FieldType) -> bool:
    """Return whether a single value is a floating-point number."""
    return kind.base in FLOAT_TYPES
