"""Deviations of the emitted C from advisory guidelines of MISRA C:2012, with reasons."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Deviation:
    """An advisory guideline, by its number, that the emitted text does not follow.

    ``of_constants``: only that of programs with tunable constants.
    """

    guideline: str
    reason: str
    of_constants: bool = False


DEVIATIONS = (
    Deviation("Directive 4.6", "messages consist of char, float and double"),
    Deviation("Rule 2.3", "the type that checks the monitor's size has no other use"),
    Deviation(
        "Rule 5.9", "monitors that are linked together have static functions of the same names"
    ),
    Deviation(
        "Rule 8.7", "the default values of the tunable constants are for the caller, too", True
    ),
)
"""All of them; none is of a guideline that is required or mandatory."""
