"""What is to be proved of the emitted functions: their contracts in ACSL."""

from __future__ import annotations

from dataclasses import dataclass, field


@dataclass(frozen=True, slots=True)
class Proof:
    """The contracts of the functions, and the predicates that they use.

    Attributes:
        declarations: the predicates.
        contracts: by function; that of its loop by its name and ``loop``.
    """

    declarations: str = ""
    contracts: dict[str, str] = field(default_factory=dict)

    def contract(self, function: str) -> str:
        """Return the contract of a function."""
        return self.contracts.get(function, NO_CONTRACT)


NO_CONTRACT = "/* no contract */"
"""Marks the line of a function without contract, which is taken out."""
