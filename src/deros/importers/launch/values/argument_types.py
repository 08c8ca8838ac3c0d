"""The types of a launch file's arguments, which are all texts there: by their uses and defaults."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from enum import Enum, auto

from deros.models.arguments import Argument, Calculation, Chosen, Expression, Literally

_BOOL = frozenset({"true", "false"})
_INTEGER = re.compile(r"[+-]?(?:0|[1-9]\d{0,17})")
_DOUBLE = re.compile(r"[+-]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d+)?")


class Use(Enum):
    """What an argument is used as."""

    TEXT = auto()
    """In a text, or where only texts and integers may stand."""
    TRUTH = auto()
    """As a condition."""
    NUMBER = auto()
    """In a calculation, or compared with a number."""
    WORD = auto()
    """Compared with a text."""
    VALUE = auto()
    """The whole value of a parameter, of the type that its text looks like."""
    BOOL = auto()
    INTEGER = auto()
    DOUBLE = auto()
    STRING = auto()
    """The whole value of a parameter of this type."""


@dataclass(slots=True)
class Declared:
    """An argument.

    Attributes:
        default: ``None``: it has to be given.
        line: where it is declared; 0 if it is only used.
        uses: of it in the whole file.
        words: that it is compared with.
        peers: arguments that it is compared with.
    """

    name: str
    default: Expression | None
    choices: tuple[str, ...] = ()
    description: str = ""
    line: int = 0
    uses: set[Use] = field(default_factory=set)
    words: set[str] = field(default_factory=set)
    peers: set[str] = field(default_factory=set)

    @property
    def same_as(self) -> str | None:
        """The argument whose value is its default."""
        return self.default.name if isinstance(self.default, Argument) else None


def types_of(declared: Mapping[str, Declared]) -> dict[str, str]:
    """Return the type of each argument.

    Those that are compared with each other, and one whose default is another one, are of one type.
    """
    groups = {name: [each] for name, each in declared.items()}
    for each in declared.values():
        for peer in {*each.peers, each.same_as} & declared.keys():
            first, second = groups[each.name], groups[peer or ""]
            if first is not second:
                first += second
                groups.update({other.name: first for other in second})
    return {name: _type(group) for name, group in groups.items()}


def _type(group: list[Declared]) -> str:
    uses = {use for each in group for use in each.uses}
    words = {word for each in group for word in each.words}
    for each in group:
        words.update(each.choices)
        if each.default is not None and not isinstance(each.default, Argument):
            found = sample(each.default)
            if found is None:
                return "string"
            words |= found
    if Use.STRING in uses:
        return "string"
    needs_bool = bool(uses & {Use.TRUTH, Use.BOOL})
    needs_number = bool(uses & {Use.NUMBER, Use.INTEGER, Use.DOUBLE})
    if Use.TEXT in uses:  # only a text, or an integer, can stand there
        kind = _value_type(uses, words) if needs_number and not needs_bool else "string"
        return kind if kind == "int" else "string"
    if needs_bool and not needs_number and _all(words, lambda word: word.lower() in _BOOL):
        return "bool"
    if needs_bool or (Use.WORD in uses and not needs_number):
        return "string"
    if needs_number or (Use.VALUE in uses and words):
        return _value_type(uses, words)
    return "string"


def _value_type(uses: set[Use], words: set[str]) -> str:
    if _all(words, lambda word: word.lower() in _BOOL) and Use.VALUE in uses:
        return "bool" if words else "string"
    # An integer becomes a double where one is wanted; nothing else can stand in a text.
    may_be_int = Use.DOUBLE not in uses or bool(uses & {Use.TEXT, Use.INTEGER})
    if may_be_int and _all(words, lambda word: _INTEGER.fullmatch(word) is not None):
        return "int"
    if Use.INTEGER not in uses and _all(words, lambda word: _DOUBLE.fullmatch(word) is not None):
        return "double"
    return "string"


def _all(words: Iterable[str], test: object) -> bool:
    assert callable(test)
    return all(test(word.strip()) for word in words)


def sample(found: Expression) -> set[str] | None:
    """Return the texts that a value can be; ``None`` if that is any."""
    if isinstance(found, Literally):
        return {str(found.value)}
    if isinstance(found, Chosen):
        chosen, otherwise = sample(found.chosen), sample(found.otherwise)
        return None if chosen is None or otherwise is None else chosen | otherwise
    return {"0.5"} if isinstance(found, Calculation) else None


def converted(text: str, kind: str) -> bool | int | float | str:
    """Return a text as a value of a type that it can be."""
    word = text.strip()
    if kind == "bool" and word.lower() in _BOOL:
        return word.lower() == "true"
    if kind == "int" and _INTEGER.fullmatch(word):
        return int(word)
    if kind == "double" and _DOUBLE.fullmatch(word):
        return float(word)
    return text
