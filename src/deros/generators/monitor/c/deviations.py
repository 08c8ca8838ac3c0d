"""Deviations of the emitted C from advisory guidelines of MISRA C:2012, with reasons."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Deviation:
    """An advisory guideline, by its number, that the emitted text does not follow."""

    guideline: str
    reason: str


DEVIATIONS = (
    Deviation("Directive 4.6", "char, float and double are what messages are made of"),
    Deviation("Rule 2.3", "the type that checks the monitor's size serves nothing else"),
    Deviation("Rule 5.9", "monitors that are linked together have static functions of equal names"),
)
"""All of them; none is of a guideline that is required or mandatory."""
