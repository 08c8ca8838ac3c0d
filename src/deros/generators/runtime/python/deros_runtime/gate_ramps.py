"""The ramps of a gate: how far fields have fallen to zero."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf

from .gate_limits import Values
from .gate_table import Stop


def fallen(value: float, by: float) -> float:
    """Return a number nearer to zero; one of an integer field is cut to an integer."""
    start = float(value)
    end = max(start - by, 0.0) if start > 0 else min(start + by, 0.0)
    if abs(end) >= abs(start):
        return value
    return int(end) if isinstance(value, int) else end


def filled(values: Values, form: Values | None) -> Values:
    """Return values with zeros where a command of that form has the field."""
    if form is None:
        return values
    return tuple(
        type(has)(0) if value is None and has is not None else value
        for value, has in zip(values, form, strict=True)
    )


class Ramps:
    """Finds where fields are that go to zero; all times are in nanoseconds."""

    def __init__(self, fields: Sequence[str], start: int) -> None:
        """Start with fields that are at zero."""
        self._fields = fields
        self._from: Values = (None,) * len(fields)  # what was executed when they began to fall
        self._fell = [0.0] * len(fields)  # before _since
        self._since = [start] * len(fields)

    def begin(self, t: int, before: Stop | None, executed: Values | None) -> None:
        """Begin to fall from the command being executed, or go on from where the fields are."""
        if executed is not None:
            self._from, self._fell = executed, [0.0] * len(executed)
            self._since = [t] * len(self._fields)
        else:
            self._fell = self._drops(before, t)
            # What a late call has published is where its fields are at the end of the call.
            self._since = [max(t, since) for since in self._since]

    def go_on(self, t: int, number: int, value: float | None) -> None:
        """Let a field fall on from a value; None: it is at zero, as one is that never passed."""
        values = list(self._from)
        before = values[number]
        if before is not None:
            values[number] = type(before)(0) if value is None else value
        self._from = tuple(values)
        self._fell[number] = 0.0
        self._since[number] = t

    def falling(self, stop: Stop, t: int) -> Values:
        """Return where the fields are that fall along a ramp; None for all others."""
        return tuple(
            fallen(value, drop) if value is not None and drop < inf else None
            for value, drop in zip(self._from, self._drops(stop, t), strict=True)
        )

    def _drops(self, stop: Stop | None, t: int) -> list[float]:
        """Return how far each field has fallen by t at the most; without a ramp, all the way."""
        ramps = stop.ramps if stop else {}
        return [
            fell + ramps[name] * max(t - since, 0) / 1e9 if name in ramps else inf
            for name, fell, since in zip(self._fields, self._fell, self._since, strict=True)
        ]
