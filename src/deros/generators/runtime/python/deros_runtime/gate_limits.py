"""
The limits of a gate: which line decides a field, and values within them.

Of limits that stand, ends may be numbers that messages or parameters give. An upper end below zero
counts as zero, and so does a lower one above it: a limit never makes the robot move. Where the
lower end is greater than the upper one, both are zero.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import copysign, inf, isnan
import struct

from .gate_sources import NEVER
from .gate_table import Bound, Limit, Line, OpenLimit, Table

Limits = tuple[Limit | None, ...]  # of the table's fields; None: no limit
Values = tuple[float | None, ...]  # of the same fields; None: not in the message


def kept(values: Values, limits: Limits) -> Values:
    """Return values within their limits."""
    return tuple(map(_kept, values, limits))


def _kept(value: float | None, limit: Limit | None) -> float | None:
    if value is None or limit is None or limit[0] <= value <= limit[1]:
        return value
    return limit[0] if value < limit[0] else limit[1]


def limit_of(name: str, applying: Sequence[Line]) -> Limit | None:
    """Return what the first line that names a field says; a line that stops names all fields."""
    first = next((line for line in applying if line.stop or name in line.limits), None)
    return None if first is None else first.limits.get(name)


def held(value: float, kind: str) -> float:
    """Return a number as a field of a type holds it: cut to an integer, and within its range."""
    if kind == 'float64':
        return value
    if kind == 'float32':
        try:
            single: float = struct.unpack('f', struct.pack('f', value))[0]
        except OverflowError:
            single = copysign(inf, value)
        return single
    is_signed, bits = kind[0] != 'u', int(kind.lstrip('uint'))
    least, greatest = (
        (-(1 << bits - 1), (1 << bits - 1) - 1) if is_signed else (0, (1 << bits) - 1)
    )
    return int(min(max(value, least), greatest))


class StandingLimits:
    """Finds the limits that always hold; all times are in nanoseconds."""

    def __init__(self, table: Table, parameters: Mapping[str, float]) -> None:
        """Start without a message; parameters are those that bounds name."""
        standing = [line for line in table.lines if line.is_standing]
        self._fixed: Limits = tuple(limit_of(name, standing) for name in table.fields)
        bounds = {name: limit for line in standing for name, limit in line.bounds.items()}
        self._open = {
            number: bounds[name] for number, name in enumerate(table.fields) if name in bounds
        }
        self._types = {
            number: next(end.kind for end in limit if isinstance(end, Bound))
            for number, limit in self._open.items()
        }
        self._parameters = parameters
        self._times = [each.silent_ns for each in table.inputs]
        self.limits = self._fixed
        self.unknown = (True,) * len(table.inputs)  # of each input, whether it is
        self.forget()

    def forget(self) -> None:
        """Forget all messages."""
        self._numbers: list[float | None] = [None] * len(self._times)
        self._arrived = [-NEVER] * len(self._times)

    def take(self, t: int, numbers: Mapping[int, float | None]) -> None:
        """Take the numbers of some inputs; None, or NaN: unknown."""
        for number, value in numbers.items():
            known = None if value is None or isnan(value) else float(value)
            self._numbers[number], self._arrived[number] = known, t

    def settle(self, t: int) -> None:
        """Find the limits at t."""
        if not self._open:
            return
        for number in range(len(self._times)):
            if self._due(number) <= t:
                self._numbers[number] = None
        self.unknown = tuple(value is None for value in self._numbers)
        self.limits = tuple(
            self._limit(self._open[number], self._types[number]) if number in self._open else fixed
            for number, fixed in enumerate(self._fixed)
        )

    @property
    def due(self) -> int:
        """Return when a number becomes unknown, if no other one comes."""
        return min(map(self._due, range(len(self._times))), default=NEVER)

    def rounded(self, values: Values) -> Values:
        """Return values as messages hold them, of the fields whose limits can change."""
        return tuple(
            held(value, self._types[number])
            if value is not None and self._types.get(number) == 'float32'
            else value
            for number, value in enumerate(values)
        )

    def _due(self, number: int) -> int:
        silent = self._times[number]
        is_lasting = self._numbers[number] is None or not silent
        return NEVER if is_lasting else self._arrived[number] + silent

    def _limit(self, limit: OpenLimit, kind: str) -> Limit:
        lower, upper = limit
        least, greatest = self._value(lower), self._value(upper)
        if least > greatest:
            return held(0.0, kind), held(0.0, kind)
        return (
            held(least if least < 0 else 0.0, kind) if isinstance(lower, Bound) else lower,
            held(greatest if greatest > 0 else 0.0, kind) if isinstance(upper, Bound) else upper,
        )

    def _value(self, end: float | Bound) -> float:
        if not isinstance(end, Bound):
            return float(end)
        if end.number is None:
            return self._parameters[end.parameter] * end.factor
        number = self._numbers[end.number]
        return 0.0 if number is None else number * end.factor
