"""Numbers in ACSL.

An equation of doubles in ACSL is one of real numbers, which says nothing of NaN. So operations are
those of IEEE 754, and two numbers are the same by ``same()``: equal under any function of them.
"""

from __future__ import annotations


def constant(value: float | str) -> str:
    """Return a constant as a double."""
    return f"(double){value!r}" if isinstance(value, float) else f"(double){value}"


def of(operation: str, first: str, second: str) -> str:
    """Return an operation on two doubles, rounded as C rounds it."""
    return f"\\{operation}_double({first}, {second})"


ONE, ZERO = constant(1.0), constant(0.0)
INFINITY, NAN = of("div", ONE, ZERO), of("div", ZERO, ZERO)
