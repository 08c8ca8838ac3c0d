"""The limits of a gate: which line decides a field, and values within them."""

from __future__ import annotations

from collections.abc import Sequence

from .gate_table import Limit, Line

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
