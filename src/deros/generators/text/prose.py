"""Prose in emitted text, whatever the language of the text."""

from __future__ import annotations

import textwrap

from deros.generators.text.document import Document, fill, nest, render


def sentence(text: str) -> str:
    """Return ``text`` as a sentence for a docstring: on one line, with a capital and a full stop.

    Backslashes become slashes, since PEP 257 asks for raw docstrings with them, and three double
    quotes, which would end the docstring, become single ones.
    """
    line = printable_line(text).replace("\\", "/").replace('"""', "'''")
    if not line:
        return ""
    return f"{line[0].upper()}{line[1:]}" + ("" if line.endswith((".", "!", "?")) else ".")


def printable_line(text: str) -> str:
    """Return ``text`` with every run of white space and unprintable characters as one blank."""
    return " ".join("".join(c if c.isprintable() else " " for c in text).split())


def paragraph(
    text: str, first: str = "", further: str = "", longest: int | None = None
) -> Document:
    """Return a text as words that fill lines.

    Args:
        text: the text, without line breaks; runs of blanks are kept within lines.
        first: the start of the first line.
        further: the start of all further lines.
        longest: the length from which words are cut; by default none is.
    """
    words = text.split(" ")
    if longest is not None:
        words = [piece for word in words for piece in _cut(word, longest)]
    return nest(further, first, fill(words))


def _cut(word: str, longest: int) -> list[str]:
    return [word[at : at + longest] for at in range(0, len(word), longest)] or [""]


def wrap(text: str, width: int) -> list[str]:
    """Return ``text`` in lines of at most ``width`` characters; longer words stay whole."""
    return render(paragraph(text), width).split("\n") if text else []


def pieces(text: str, width: int) -> list[str]:
    """Return a text cut between words in pieces of at most ``width`` characters.

    All of the text is in the pieces, its white space included; longer words stay whole.
    """
    return textwrap.wrap(
        text,
        max(1, width),
        break_long_words=False,
        break_on_hyphens=False,
        drop_whitespace=False,
        expand_tabs=False,
        replace_whitespace=False,
    )
