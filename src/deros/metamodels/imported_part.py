"""Where the imported part of a file begins: ``deros import`` writes a line above it."""

from __future__ import annotations

NOTICE = "// Imported: the next import replaces all that is below this line."
"""The line between what people write and what an import replaces."""


def imported_from(text: str) -> int:
    """Return the position in a text at which its imported part begins, or its end."""
    if text.startswith(NOTICE):
        return 0
    found = text.find(f"\n{NOTICE}")
    return len(text) if found < 0 else found + 1
