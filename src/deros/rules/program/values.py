"""Values of the intermediate form: what is read from messages or actions, and computed of it.

They are part of :mod:`deros.rules.program.ir`, from where they are imported.
"""

from __future__ import annotations

import math
import struct
from dataclasses import dataclass, field

from deros.diagnostics import Span
from deros.interfaces.fields import FieldPath
from deros.interfaces.types import FLOAT_TYPES, FieldType, InterfaceType
from deros.rules.program.formulas import Expression, Formula
from deros.rules.program.zones import Zone

Scalar = bool | int | float | str

RECEIPT = ("received()",)
"""The path of a leaf that no field is: when the message was received, on the clock of its stamps.

It is in nanoseconds, an ``int64``.
"""

PUBLISHER = ("publisher()",)
"""The path of a leaf that no field is: that the topic has one publisher, else it is absent."""


def place_among_arguments(path: FieldPath) -> int:
    """Return a key that puts what is no field before the fields of a message, in a fixed order."""
    return (RECEIPT, PUBLISHER, path).index(path)


# What is read from messages ---------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Leaf:
    """One primitive field, or array, that the rules read from an input's message.

    Attributes:
        index: its place in :attr:`Program.leaves`.
        input: index of the input it belongs to.
        path: from the message's root: field names, indices and keys of arrays.
        type: a primitive or an array; of messages only where nothing but its length is asked for.
        nan_is_unknown: whether a NaN here makes the input unknown (see :class:`Input`).
    """

    index: int
    input: int
    path: FieldPath
    type: FieldType
    nan_is_unknown: bool = True

    @property
    def can_be_absent(self) -> bool:
        """Whether there are messages without it: an element of an array, the one publisher."""
        return self.path == PUBLISHER or any(not isinstance(step, str) for step in self.path)

    @property
    def is_field(self) -> bool:
        """Whether it is in the message, and not what is known beside it."""
        return self.path not in (RECEIPT, PUBLISHER)

    @property
    def can_be_nan(self) -> bool:
        """Whether a value of the field can make the input unknown."""
        return self.nan_is_unknown and self.type.base in FLOAT_TYPES


@dataclass(frozen=True, slots=True)
class Input:
    """A value observed on a topic: named by an ``input`` line, or a topic term used in a rule.

    It is unknown until the first message, after ``timeout_ns`` without one, and as soon as a
    message carries a NaN in a leaf with ``nan_is_unknown``, or lacks a leaf (an index or a key that
    its array does not have, the one publisher); such a message does not count for the timeout. One
    with a timeout is *awaited* from the start, or from a backward step of the clock, until its
    first message that counts, or until it is missing.
    """

    index: int
    name: str
    topic: str
    type: InterfaceType
    path: FieldPath
    leaves: tuple[int, ...]
    timeout_ns: int | None
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Active:
    """The condition that an action is active; never unknown.

    It is that of the same event: what names an action is evaluated after all that triggers or
    resets it (:mod:`deros.rules.program.rounds`).
    """

    action: int
    span: Span = field(compare=False, repr=False)


# Values -----------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Const:
    """A constant value."""

    value: Scalar


@dataclass(frozen=True, slots=True)
class Read:
    """The present value of a leaf; unknown while its input is."""

    leaf: int


@dataclass(frozen=True, slots=True)
class Apply:
    """A function of the function table applied to values, in the order that its row declares.

    ``state`` numbers the functions that remember something between messages (``rate``); it is
    ``None`` for the others. ``entry`` is the condition of ``matches``, whose arguments are arrays:
    a formula of ``names``, the entries at one index, numbers rounded to doubles. Its value is at
    how many indices the condition holds; unknown if the arrays are empty or differ in length.
    ``zone`` is that of ``points_in``, in the coordinates of the sensor.
    """

    function: str
    arguments: tuple[ValueExpression, ...]
    input: int
    state: int | None = None
    entry: Expression | None = None
    wording: str = field(default="", compare=False, repr=False)  # of the entry, as written
    zone: Zone | None = None

    @property
    def names(self) -> tuple[str, ...]:
        """The names of the arguments in the condition on entries."""
        return tuple(f"x{number}" for number, _ in enumerate(self.arguments, 1))


@dataclass(frozen=True, slots=True)
class Scale:
    """``operand * factor + offset``: the conversion of a field into the other side's unit.

    An offset of 0 is not added: it would make 0 of -0.
    """

    operand: ValueExpression
    factor: float
    offset: float = 0.0


@dataclass(frozen=True, slots=True)
class Tuned:
    """The value of a tunable constant, as a double; never unknown.

    It is ``value * factor + offset``, of which an offset of 0 is not added, after the sign has been
    changed (``negated``). If ``single``, it is rounded to a ``float32``, as the field is that it is
    compared with.
    """

    constant: int  # its place in :attr:`Program.tunables`
    negated: bool = False
    factor: float = 1.0
    offset: float = 0.0
    single: bool = False

    @property
    def as_written(self) -> Tuned:
        """The same in the unit of the constant, as causes show it."""
        return Tuned(self.constant, self.negated)

    def of(self, value: float) -> float:
        """Return the value for that of the constant."""
        result = (-value if self.negated else value) * self.factor
        result = result + self.offset if self.offset else result
        return as_float32(result) if self.single else result


def as_float32(value: float) -> float:
    """Return the nearest number that a ``float32`` holds; infinity beyond their range."""
    try:
        narrow: float = struct.unpack("<f", struct.pack("<f", value))[0]
    except OverflowError:
        return math.copysign(math.inf, value)
    return narrow


@dataclass(frozen=True, slots=True)
class Compute:
    """Arithmetic on numbers, which may come from several inputs: a formula of doubles.

    ``operands`` are its names ``x1``, ``x2`` and so on, each rounded to a double; tunable constants
    among them are as written. It is unknown where one of them is, and where the formula has no
    value, as a quotient with the divisor zero. With a ``zone`` it is whether the point with the
    coordinates ``x1`` and ``x2`` is in that zone, as 1 or 0.
    """

    formula: Formula
    operands: tuple[Read | Apply | Tuned, ...]
    wording: str = field(default="", compare=False, repr=False)  # as written
    zone: Zone | None = None

    @property
    def names(self) -> tuple[str, ...]:
        """The names of the operands in the formula."""
        return tuple(f"x{number}" for number, _ in enumerate(self.operands, 1))

    @property
    def is_fixed(self) -> bool:
        """Whether it is of tunable constants alone, so that it never changes."""
        return all(isinstance(each, Tuned) for each in self.operands)


ValueExpression = Const | Read | Apply | Scale | Compute | Tuned
