"""Values of models as text, as the languages write them."""

from __future__ import annotations

import json
from collections.abc import Iterable

from deros.models.common import Value


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
