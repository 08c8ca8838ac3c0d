"""What the proof of a function reads, of the texts of an emitted monitor."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Callable
from pathlib import Path

_BLOCK = re.compile(r"/\*@.*?\*/\n.*?\b(?P<name>\w+)\([^;{}]*\);", re.DOTALL)
_MACRO = re.compile(r"#define (?P<name>\w+)\((?:.*\\\n)*.*\n")
_PREDICATE = re.compile(r"/\*@ predicate (?P<name>\w+).*?\*/", re.DOTALL)
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
            for pattern in (_MACRO, _PREDICATE)
            for each in pattern.finditer(self.contracts)
        }

    def digest(self, name: str, source: str, more: str) -> str:
        """Return a digest of all that the proof of a function reads.

        Args:
            name: the function.
            source: the text that it is in, which may have a slip.
            more: a text that the digest is also made of.
        """
        function = re.search(rf"^[^\n]*\b{name}\([^;{{]*\)\n\{{.*?^\}}", source, re.M | re.S)
        text = function.group() if function else source
        todo = {name, *_USE.findall(text)}
        seen: set[str] = set()
        parts = [more, text, self.header]
        while todo - seen:
            used = min(todo - seen)
            seen.add(used)
            part = self._blocks.get(used, "") + self._macros.get(used, "")
            parts.append(part)
            todo |= {each for each in _USE.findall(part) if each in self._macros}
        parts += [each for each in self.contracts.split("\n\n") if "axiomatic" in each]
        return hashlib.sha256("\0".join(parts).encode()).hexdigest()[:20]
