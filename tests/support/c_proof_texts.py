"""What the proof of a function reads, of the texts of an emitted monitor."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Callable, Iterable
from pathlib import Path

_BLOCK = re.compile(
    r"/\*@(?:(?!/\*@).)*?\*/\n(?:(?!/\*@).)*?\b(?P<name>\w+)\([^;{}]*\);", re.DOTALL
)
"""A contract, and the declaration of its function."""

_MACRO = re.compile(r"#define (?P<name>\w+)\((?:.*\\\n)*.*\n")
_DEFINITION = re.compile(r"/\*@ (?:predicate|logic \w+) (?P<name>\w+).*?\*/", re.DOTALL)
_FACT = re.compile(r"/\*@ (?!predicate|logic|requires|assigns)\w.*?\*/", re.DOTALL)
"""What holds everywhere, such as axioms and lemmas: a prover may use it for any function."""

_USE = re.compile(r"\b(\w+)(?:\{[^}]*\})?\(")


class ProofTexts:
    """A source, with the header and the contracts beside it."""

    def __init__(self, source: Path, as_read: Callable[[str], str] = lambda text: text) -> None:
        """Read the texts, each as ``as_read`` returns it."""
        self.source = source
        self.text = as_read(source.read_text(encoding="utf-8"))
        prefix = source.name.removesuffix("_monitor.c")
        folder = source.parent
        self.header = as_read((folder / f"{prefix}_monitor.h").read_text(encoding="utf-8"))
        contracts = folder / f"{prefix}_contracts.h"
        self.contracts = as_read(contracts.read_text(encoding="utf-8"))
        self._blocks = {e["name"]: e.group() for e in _BLOCK.finditer(self.contracts)}
        self._macros = {
            each["name"]: each.group()
            for pattern in (_MACRO, _DEFINITION)
            for each in pattern.finditer(self.contracts)
        }

    @property
    def facts(self) -> list[str]:
        """What holds for all functions, and the definitions that this names, transitively."""
        facts = _FACT.findall(self.contracts)
        return [*facts, *self._named(facts)]

    def digest(self, name: str, source: str, more: str) -> str:
        """Return a digest of all that the proof of a function reads.

        Args:
            name: the function.
            source: the text that it is in, which may have a slip.
            more: a text that the digest is also made of.
        """
        function = re.search(rf"^[^\n]*\b{name}\([^;{{]*\)\n\{{.*?^\}}", source, re.M | re.S)
        text = function.group() if function else source
        called = {name, *_USE.findall(text)}
        blocks = [self._blocks[each] for each in sorted(called & self._blocks.keys())]
        read = [text, *blocks]
        parts = [more, self.header, *read, *self._named(read), *self.facts]
        return hashlib.sha256("\0".join(parts).encode()).hexdigest()[:20]

    def _named(self, texts: Iterable[str]) -> list[str]:
        """Return the definitions that some texts name, transitively, macros among them."""
        found: dict[str, str] = {}
        todo = [*texts]
        while todo:
            named = {each for each in _USE.findall(todo.pop()) if each in self._macros}
            new = {each: self._macros[each] for each in named - found.keys()}
            found |= new
            todo += new.values()
        return [found[each] for each in sorted(found)]
