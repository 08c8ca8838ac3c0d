"""Positions in serialized data, as far as they are known when code is generated."""

from __future__ import annotations

import math
from dataclasses import dataclass

ENCAPSULATION = 4
"""The size of the encapsulation header; alignment is relative to its end."""

LARGEST = 8
"""The largest alignment in plain CDR."""


@dataclass(frozen=True, slots=True)
class Position:
    """A position: ``offset`` bytes after the start of the data, or after the variable ``at``.

    Attributes:
        moving: whether it is relative to ``at``, which depends on the data.
        offset: the distance from that base in bytes.
        modulus: a power of two up to 8; the distance of the base from the first field ...
        remainder: ... is known to have this remainder modulo ``modulus``.
    """

    moving: bool
    offset: int
    modulus: int
    remainder: int

    def plus(self, size: int) -> Position:
        """Return the position ``size`` bytes further on."""
        return Position(self.moving, self.offset + size, self.modulus, self.remainder)

    def aligned(self, alignment: int) -> Position | None:
        """Return the next aligned position, or ``None`` if it depends on the data."""
        if self.modulus % alignment:
            return None
        return self.plus(-(self.remainder + self.offset) % alignment)

    def alignment(self) -> int:
        """Return the largest alignment that the position is known to have."""
        return math.gcd(self.modulus, self.remainder + self.offset)

    def base(self) -> Position:
        """Return the position as ``at``, for when ``at`` has been set to it."""
        return Position(True, 0, self.modulus, (self.remainder + self.offset) % self.modulus)

    def meet(self, other: Position) -> Position:
        """Return what is known of ``at`` if it is either this base or the other one."""
        modulus = math.gcd(self.modulus, other.modulus, self.remainder - other.remainder)
        return Position(True, 0, modulus, self.remainder % modulus)

    def text(self, more: int = 0) -> str:
        """Return the expression for the position ``more`` bytes further on."""
        offset = self.offset + more
        if not self.moving:
            return str(offset)
        return f"at + {offset}" if offset else "at"


START = Position(False, ENCAPSULATION, LARGEST, -ENCAPSULATION % LARGEST)
"""The position of the first field."""


def moved(alignment: int) -> Position:
    """Return the position ``at``, of which only this alignment is known."""
    return Position(True, 0, alignment, 0)
