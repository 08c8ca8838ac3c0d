"""Sets of numbers, as unions of intervals with exact bounds."""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction

Number = Fraction | float
"""An exact fraction, or one of the two infinities as a float."""


@dataclass(frozen=True, slots=True)
class _Piece:
    """One interval, which contains at least one number."""

    lower: Number
    upper: Number
    lower_closed: bool
    upper_closed: bool


@dataclass(frozen=True, slots=True)
class NumberSet:
    """A set of real numbers and infinities: disjoint intervals, in order."""

    pieces: tuple[_Piece, ...]

    @classmethod
    def between(
        cls, lower: Number, upper: Number, lower_closed: bool = True, upper_closed: bool = True
    ) -> NumberSet:
        """Return the numbers of one interval."""
        holds_any = lower < upper or (lower == upper and lower_closed and upper_closed)
        return cls((_Piece(lower, upper, lower_closed, upper_closed),) if holds_any else ())

    @property
    def is_empty(self) -> bool:
        """Whether the set is empty."""
        return not self.pieces

    def __and__(self, other: NumberSet) -> NumberSet:
        """Return the numbers in both."""
        met: list[_Piece] = []
        for a in self.pieces:
            for b in other.pieces:
                # The later beginning counts, and of two equal ones the open one; likewise the end.
                lower, lower_open = max(
                    (a.lower, not a.lower_closed), (b.lower, not b.lower_closed)
                )
                upper, upper_closed = min((a.upper, a.upper_closed), (b.upper, b.upper_closed))
                met.extend(NumberSet.between(lower, upper, not lower_open, upper_closed).pieces)
        return NumberSet(tuple(met))

    def __or__(self, other: NumberSet) -> NumberSet:
        """Return the numbers in either."""
        return (self.complement() & other.complement()).complement()

    def complement(self) -> NumberSet:
        """Return all other numbers, infinities included."""
        gaps: list[_Piece] = []
        start: Number = -math.inf
        start_closed = True
        for piece in self.pieces:
            gap = NumberSet.between(start, piece.lower, start_closed, not piece.lower_closed)
            gaps.extend(gap.pieces)
            start, start_closed = piece.upper, not piece.upper_closed
        gaps.extend(NumberSet.between(start, math.inf, start_closed, True).pieces)
        return NumberSet(tuple(gaps))

    def of_integers(self) -> NumberSet:
        """Return the set with its finite ends drawn in to the nearest integers within."""
        drawn_in: list[_Piece] = []
        for piece in self.pieces:
            lower, upper = piece.lower, piece.upper
            lower_closed, upper_closed = piece.lower_closed, piece.upper_closed
            if isinstance(lower, Fraction):
                least = math.ceil(lower)
                lower = Fraction(least + (least == lower and not lower_closed))
                lower_closed = True
            if isinstance(upper, Fraction):
                greatest = math.floor(upper)
                upper = Fraction(greatest - (greatest == upper and not upper_closed))
                upper_closed = True
            ends = NumberSet.between(lower, upper, lower_closed, upper_closed)
            drawn_in.extend(ends.pieces)
        return NumberSet(tuple(drawn_in))
