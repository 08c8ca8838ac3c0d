"""What the compiler found the names in terms to be, for tools that ask about a place in a text.

A name alone does not say whether it is an input, a constant, a rule or an action; all else that
rules name is where the grammar expects it.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Literal

from deros.diagnostics import Span
from deros.interfaces.fields import BRACKETS, FieldPath
from deros.interfaces.types import InterfaceType

GAP = r"(?:\s|//[^\n]*\n|/\*(?:[^*]|\*(?!/))*\*/)*"
"""Regular expression for what may stand between two words: blanks and comments."""

_PATH_PART = re.compile(rf"{GAP}(?:\.{GAP})?([^\W\d]\w*|{BRACKETS})")

MentionKind = Literal["input", "constant", "rule", "action", "message constant", "zone"]


@dataclass(frozen=True, slots=True)
class Mention:
    """A name in a term, and what it is; a rule has its full name, ``entity.rule``."""

    kind: MentionKind
    name: str
    span: Span


@dataclass(frozen=True, slots=True)
class FieldMention:
    """A field path in a term.

    Attributes:
        topic: whose messages have the field; ``""`` for the commands of a gate.
        type: of the message that ``path`` starts from.
        path: the whole path, of which ``written`` parts stand in the term.
        before: the part of the term before the path.
        span: the whole term.
    """

    topic: str
    type: InterfaceType
    path: FieldPath
    before: Span
    span: Span
    written: int


def part_span(before: Span, whole: Span, position: int) -> Span:
    """Return the place of one part of the path that follows ``before`` within ``whole``.

    Where comments stand between the parts, the whole term is the place.
    """
    text, offset = whole.source.text, before.end
    match = None
    for _ in range(position + 1):
        match = _PATH_PART.match(text, offset, whole.end)
        if match is None:
            return whole
        offset = match.end()
    return Span(whole.source, match.start(1), match.end(1)) if match else whole
