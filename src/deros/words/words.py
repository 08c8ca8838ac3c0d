"""The words of a text, and the index that finds them by their place and by what they are.

A word is a name, a unit or a path as it stands in a file. What it means has been found by the
loader, the compiler or the checks; here it is only collected.
"""

from __future__ import annotations

import enum
import os
from bisect import bisect_right
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from deros.diagnostics import Span


class WordKind(enum.Enum):
    """What a word is; the value is the noun for it."""

    NODE_TYPE = "node type"
    SYSTEM = "system"
    NODE = "node"
    SUBSYSTEM = "subsystem"
    PROCESS = "process"
    HOST = "host"
    ARGUMENT = "argument"
    PARAMETER = "parameter"
    PORT = "port"
    TIMER = "timer"
    TOPIC = "topic"
    TYPE = "type"
    FIELD = "field"
    UNIT = "unit"
    CONSTANT = "constant"
    MESSAGE_CONSTANT = "constant of the message"
    INPUT = "input"
    ZONE = "zone"
    ENTITY = "entity"
    RULE = "rule"
    ACTION = "action"
    BEHAVIOUR = "behaviour"
    FUNCTION = "function"
    FILE = "file"


@dataclass(frozen=True, slots=True)
class Word:
    """One word of a file.

    Attributes:
        span: where it stands.
        kind: what it is.
        name: the full name of the thing: ``/odom``, ``speed_check.too_fast``, ``sensor_msgs.Imu``.
        declared: the place of the name where the thing is declared; ``None`` for what no model
            declares, such as a message type.
        type: of a value, a port or a field, as users write it; ``""`` if it has none.
        unit: of a value; ``""`` if none is known.
        description: what its declaration says about it.
        meaning: the part of a model, or the row of a table, that declares it.
    """

    span: Span
    kind: WordKind
    name: str
    declared: Span | None = None
    type: str = ""
    unit: str = ""
    description: str = ""
    meaning: object = None

    @property
    def declares(self) -> bool:
        """Whether the thing is declared here."""
        return self.declared is not None and place_of(self.declared) == place_of(self.span)

    @property
    def key(self) -> tuple[str, ...]:
        """What is the same for all words that mean the same thing, in whichever file."""
        if self.declared is None:
            return self.kind.name, self.name
        file, start = place_of(self.declared)
        return self.kind.name, file, str(start)


def place_of(span: Span) -> tuple[str, int]:
    """Return what is the same for a place, however the path of its file is written."""
    return os.path.abspath(span.file), span.start  # noqa: PTH100 - stays as it is, without links


class Index:
    """The words of one file, by place; where two overlap, the shorter one is meant."""

    def __init__(self, words: Iterable[Word]) -> None:
        """Sort the words; of equal ones, one stays."""
        unique = {(each.span.start, each.span.end, each.key): each for each in words}
        self._words = sorted(unique.values(), key=lambda w: (w.span.start, -w.span.end))
        self._starts = [each.span.start for each in self._words]

    def __iter__(self) -> Iterator[Word]:
        """Yield the words in the order of the text."""
        return iter(self._words)

    def __len__(self) -> int:
        """Return how many words there are."""
        return len(self._words)

    def at(self, offset: int) -> Word | None:
        """Return the word that holds a character, or ends before it; ``None`` for anything else."""
        number = bisect_right(self._starts, offset)
        around = [w for w in self._words[max(0, number - 3) : number] if offset <= w.span.end]
        return min(around, key=lambda w: w.span.end - w.span.start, default=None)

    def of(self, key: tuple[str, ...]) -> list[Word]:
        """Return the words that mean the same thing."""
        return [each for each in self._words if each.key == key]
