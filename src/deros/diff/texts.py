"""Values of models as text, as the languages write them."""

from __future__ import annotations

import json
from collections.abc import Hashable, Iterable

from deros.models.common import Value


class Meant:
    """A text as written, which equals others of the same meaning."""

    def __init__(self, text: str, meaning: Hashable) -> None:
        """Store a text and what it means."""
        self.text, self.meaning = text, meaning

    def __eq__(self, other: object) -> bool:
        """Return whether both mean the same."""
        return isinstance(other, Meant) and self.meaning == other.meaning

    def __hash__(self) -> int:
        """Return the hash of the meaning."""
        return hash(self.meaning)

    def __str__(self) -> str:
        """Return the text."""
        return self.text


def value_text(value: Value | Iterable[Value]) -> str:
    """Return a value as the languages write it: ``true``, ``0.5``, ``"map"``, ``[1, 2]``."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, int | float):
        return repr(value)
    return f"[{', '.join(map(value_text, value))}]"


def yes_or_no(value: bool) -> str:
    """Return the word for a truth."""
    return "yes" if value else "no"


def joined(texts: Iterable[str]) -> str:
    """Return texts as one list."""
    return ", ".join(texts)
