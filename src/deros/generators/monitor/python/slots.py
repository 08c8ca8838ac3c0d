"""The values that a handler stores, and what tells whether they are new."""

from __future__ import annotations

from dataclasses import dataclass

from deros.generators.text.logic import Atom, Logic


@dataclass(frozen=True, slots=True)
class Slot:
    """A value that a handler stores: the attribute, what is stored, and whether -0.0 is not 0.0."""

    attribute: str
    local: str
    is_signed: bool = False

    def is_new(self) -> list[Logic]:
        """Return the tests of which one is true if the value is another one than before."""
        if self.local == "True":
            return [Atom(f"not {self.attribute}")]
        return [Atom(f"{self.local} != {self.attribute}"), *self._signs("!=")]

    def is_old(self) -> list[Logic]:
        """Return the tests that are all true if the value is the one from before."""
        if self.local == "True":
            return [Atom(self.attribute)]
        return [Atom(f"{self.local} == {self.attribute}"), *self._signs("==")]

    def _signs(self, operator: str) -> list[Logic]:
        signs = [f"math.copysign(1.0, {each})" for each in (self.local, self.attribute)]
        return [Atom(f" {operator} ".join(signs))] if self.is_signed else []
