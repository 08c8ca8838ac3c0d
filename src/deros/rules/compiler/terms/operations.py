"""The operators and functions of arithmetic in rules, and their table for the documentation."""

from __future__ import annotations

from deros.models import rules

CALLS = {
    "sqrt": (1, 1),
    "sin": (1, 1),
    "cos": (1, 1),
    "tan": (1, 1),
    "abs": (1, 1),
    "atan2": (2, 2),
    "hypot": (2, 3),
    "min": (2, 8),
    "max": (2, 8),
}
"""The functions of arithmetic, with the least and the greatest number of their operands."""


def is_arithmetic(term: rules.Term) -> bool:
    """Return whether a term is an operation or a function of arithmetic; not ``-constant``."""
    match term:
        case rules.Arithmetic():
            return True
        case rules.Call(receiver=None, function=function):
            return function.text in CALLS
        case rules.Negative(operand=operand):
            return is_arithmetic(operand)
    return False


def usage_table() -> str:
    """Return the table of the documentation: how each operation is written, and what it gives."""
    rows = [f"| {usage} | {on} | {gives} |" for usage, on, gives in _USAGE]
    return "\n".join(["| operation | of | value |", "|---|---|---|", *rows])


_USAGE = (
    ("`a + b`, `a - b`", "numbers of one dimension", "in the unit of `a`"),
    ("`a * b`", "two numbers", "a product of the units; a radian beside a length is 1"),
    ("`a / b`", "two numbers", "unknown where `b` is zero"),
    ("`-a`, `abs(a)`", "a number", "in its unit"),
    ("`sqrt(a)`", "a number", "unknown below zero"),
    ("`min(a, b, …)`, `max(a, b, …)`", "2 to 8 numbers of one dimension", "in the unit of `a`"),
    ("`hypot(a, b)`, `hypot(a, b, c)`", "numbers of one dimension", "the length of that vector"),
    ("`sin(a)`, `cos(a)`, `tan(a)`", "an angle; a plain number is in rad", "a plain number"),
    ("`atan2(y, x)`", "two numbers of one dimension", "the bearing of that point, in rad"),
)
