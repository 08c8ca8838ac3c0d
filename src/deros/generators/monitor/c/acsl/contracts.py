"""The text of a contract in ACSL."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from deros.generators.text.c import LINE_LENGTH
from deros.generators.text.document import render_lines
from deros.generators.text.prose import paragraph


@dataclass(slots=True)
class Contract:
    """The contract of a function or a loop: what it requires, may change and ensures.

    An empty ``assigns`` means that it changes nothing. What is ``checked`` is ensured, too,
    but callers do not rely on it: statements on numbers would make their proofs long in vain.
    With ``cases``, names and conditions of which one always holds, all is ensured of each by
    itself, and what is ``of_case``: so no proof is about the branches of a function at once. What
    is ensured ``at_once`` is proved of all cases together: callers read it once.
    """

    requires: list[str] = field(default_factory=list)
    assigns: list[str] = field(default_factory=list)
    ensures: list[str] = field(default_factory=list)
    at_once: list[str] = field(default_factory=list)
    checked: list[str] = field(default_factory=list)
    cases: dict[str, str] = field(default_factory=dict)
    of_case: dict[str, list[str]] = field(default_factory=dict)
    invariants: list[str] = field(default_factory=list)
    variant: str = ""
    is_loop: bool = False

    def text(self, indent: int) -> str:
        """Return the annotation, as it stands above a function or a loop."""
        clauses = list(self._clauses())
        lines: list[str] = []
        for number, clause in enumerate(clauses):
            lead = "/*@ " if number == 0 else "    "
            end = "; */" if number == len(clauses) - 1 else ";"
            lines += render_lines(paragraph(f"{clause}{end}", lead, "      "), LINE_LENGTH, indent)
        return "\n".join(lines)

    def _clauses(self) -> Iterator[str]:
        loop = "loop " if self.is_loop else ""
        for each in dict.fromkeys(self.requires):
            yield f"requires {each}"
        for each in dict.fromkeys(self.invariants):
            yield f"loop invariant {each}"
        yield f"{loop}assigns {', '.join(dict.fromkeys(self.assigns)) or chr(92) + 'nothing'}"
        for each in dict.fromkeys(self.at_once):
            yield f"ensures {each}"
        for name, condition in (self.cases or {"": ""}).items():
            if name:
                yield f"behavior {name}: assumes {condition}"
            for each in dict.fromkeys([*self.ensures, *self.of_case.get(name, ())]):
                yield f"ensures {each}"
        if self.cases:
            yield "complete behaviors"
            yield "disjoint behaviors"
        for each in dict.fromkeys(self.checked):
            yield f"check ensures {each}"
        if self.variant:
            yield f"loop variant {self.variant}"


def wrapped(text: str, indent: int = 0) -> list[str]:
    """Return a text in lines that are not too long."""
    return render_lines(paragraph(text, "", "  "), LINE_LENGTH, indent)


def iff(left: str, right: str) -> str:
    """Return that two statements are equally true."""
    return f"({left} <==> {right})"


def all_of(parts: Iterable[str]) -> str:
    """Return the conjunction."""
    return f"({' && '.join(parts) or chr(92) + 'true'})"


def any_of(parts: Iterable[str]) -> str:
    """Return the disjunction."""
    return f"({' || '.join(parts) or chr(92) + 'false'})"
