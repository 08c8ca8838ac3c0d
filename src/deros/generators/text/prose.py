"""Prose in emitted text, whatever the language of the text."""

from __future__ import annotations


def sentence(text: str) -> str:
    """Return ``text`` as a sentence for a docstring: a capital in front, a full stop, one line.

    PEP 257 wants no backslashes in a docstring, and three quotes would end it.
    """
    line = printable_line(text).replace("\\", "/").replace('"""', "'''")
    if not line:
        return ""
    return f"{line[0].upper()}{line[1:]}" + ("" if line.endswith((".", "!", "?")) else ".")


def printable_line(text: str) -> str:
    """Return ``text`` with every run of white space and unprintable characters as one blank."""
    return " ".join("".join(c if c.isprintable() else " " for c in text).split())
