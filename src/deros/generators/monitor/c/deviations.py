"""Where the emitted C does otherwise than MISRA C:2012 advises, and why; all else complies."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Deviation:
    """A guideline of the category *advisory*, by its number, that the text does not follow."""

    guideline: str
    reason: str


DEVIATIONS = (
    Deviation("Directive 4.6", "char, float and double are what messages are made of"),
    Deviation("Rule 2.3", "the type that checks the monitor's size serves nothing else"),
    Deviation("Rule 5.9", "monitors that are linked together have static functions of equal names"),
)
"""All of them; none is of a guideline that is required or mandatory."""
