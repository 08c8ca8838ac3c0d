"""Positions in serialized data, as far as they are known before the data is there."""

from __future__ import annotations

import math
from dataclasses import dataclass

ENCAPSULATION = 4
"""Bytes in front of the fields; alignment counts from behind them."""

LARGEST = 8
"""The largest alignment in plain CDR."""


@dataclass(frozen=True, slots=True)
class Position:
    """A position: ``offset`` bytes behind the start of the data, or behind the variable ``at``.

    Attributes:
        moving: whether it counts from ``at``, which depends on the data.
        offset: bytes behind that base.
        modulus: a power of two up to 8: what is known of the alignment of the base ...
        remainder: ... whose distance from the first field has this remainder.
    """

    moving: bool
    offset: int
    modulus: int
    remainder: int

    def plus(self, size: int) -> Position:
        """Return the place ``size`` bytes on."""
        return Position(self.moving, self.offset + size, self.modulus, self.remainder)

    def aligned(self, alignment: int) -> Position | None:
        """Return the first aligned place from here on, or ``None`` if that depends on the data."""
        if self.modulus % alignment:
            return None
        return self.plus(-(self.remainder + self.offset) % alignment)

    def alignment(self) -> int:
        """Return the largest alignment that the place is known to have."""
        return math.gcd(self.modulus, self.remainder + self.offset)

    def base(self) -> Position:
        """Return the place as what ``at`` stands for once it has been moved here."""
        return Position(True, 0, self.modulus, (self.remainder + self.offset) % self.modulus)

    def meet(self, other: Position) -> Position:
        """Return what is known of ``at`` where it may be this base or the other one."""
        modulus = math.gcd(self.modulus, other.modulus, self.remainder - other.remainder)
        return Position(True, 0, modulus, self.remainder % modulus)

    def text(self, more: int = 0) -> str:
        """Return the position, ``more`` bytes on, as an expression."""
        offset = self.offset + more
        if not self.moving:
            return str(offset)
        return f"at + {offset}" if offset else "at"


START = Position(False, ENCAPSULATION, LARGEST, -ENCAPSULATION % LARGEST)
"""The place of the first field."""


def moved(alignment: int) -> Position:
    """Return the place of an ``at`` of which this alignment is known, and nothing more."""
    return Position(True, 0, alignment, 0)
