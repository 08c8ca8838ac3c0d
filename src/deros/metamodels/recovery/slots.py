"""What may stand at a place of a text: the tokens of the grammar, and what they would be there.

The text before the place is read by the grammar, with broken statements left out. A slot knows the
rule and the attribute that a token would be for, and what the rules around it have read so far.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from arpeggio import EndOfFile, OrderedChoice, ParsingExpression, RegExMatch, StrMatch

from deros.diagnostics import SourceFile
from deros.metamodels.grammar import is_name, words_of
from deros.metamodels.languages import Language
from deros.metamodels.parsers import grammar
from deros.metamodels.reading import Unreadable, prepare, room_to_parse
from deros.metamodels.recovery.recogniser import (
    Recogniser,
    StatementList,
    Step,
    Trace,
    lists_of,
    statement_at,
)
from deros.metamodels.recovery.resumption import Search

_MOST_BROKEN = 20


class Around(NamedTuple):
    """A rule of the grammar that has begun before a place.

    Attributes:
        rule: its name, ``NodeInstance``.
        start: where it begins.
        read: the texts of the attributes that it has read so far.
    """

    rule: str
    start: int
    read: dict[str, str]


@dataclass(frozen=True, slots=True)
class Slot:
    """What a token would be at a place.

    Attributes:
        rule: the innermost rule that it would be a part of.
        attribute: of the rule, that it would be the value of; ``""`` for a keyword or a sign.
        token: the name of the token's own rule, ``GraphName``; ``""`` for a keyword or a sign.
        words: the words that it can be; none for a name.
        around: the rules that have begun, outermost first; the last one is ``rule``.
    """

    rule: str
    attribute: str
    token: str
    words: tuple[str, ...]
    around: tuple[Around, ...]

    def read(self, rule: str, attribute: str) -> str:
        """Return what the innermost rule of a name has read; ``""`` if there is nothing."""
        for each in reversed(self.around):
            if each.rule == rule:
                return each.read.get(attribute, "")
        return ""


class Slots:
    """Finds the slots in the texts of one file; what has not changed is not read again."""

    def __init__(self, language: Language) -> None:
        """Compile the grammar of a language."""
        self._recogniser = _SlotRecogniser(grammar(language))
        self._before = ""

    def at(self, text: str, offset: int) -> list[Slot]:
        """Return the slots at an offset; none where the text before it cannot be read so far."""
        try:
            start = prepare(SourceFile("", text[:offset]))
        except Unreadable:
            return []  # in a comment over several lines, for example
        if _is_in_comment(text[:offset], start):
            return []
        with room_to_parse():
            return self._at_end(start)

    def _at_end(self, start: str) -> list[Slot]:
        """Return the slots at the end of a prepared text."""
        for _ in range(_MOST_BROKEN):
            reached, found = self._run(start)
            if reached >= len(start.rstrip()):
                return found
            without = self._without_broken(start, reached)
            if without is None:
                return []
            start = without
        return []

    def _run(self, text: str) -> tuple[int, list[Slot]]:
        recogniser = self._recogniser
        recogniser.forget_from(_same(text, self._before))
        self._before = text
        return recogniser.slots(text)

    def _without_broken(self, text: str, reached: int) -> str | None:
        """Return the text without the statement that breaks off, if another one follows it."""
        recogniser = self._recogniser
        place = statement_at(recogniser.trace.places, recogniser.trace.position)
        if place is None:
            return None
        lists = lists_of(place)
        end, _ = Search(text, recogniser, lists, place.start, reached).end()
        if end >= len(text):
            return None
        broken = text[place.start : end]
        blank = "".join("\n" if each == "\n" else " " for each in broken)
        return f"{text[: place.start]}{blank}{text[end:]}"


def _is_in_comment(text: str, prepared: str) -> bool:
    """Return whether the end of a text stands in a comment, which is blank in the prepared text."""
    start = text.rfind("\n") + 1
    return any(
        text.startswith("//", place) and prepared[place] == " " for place in range(start, len(text))
    )


def _same(one: str, other: str) -> int:
    """Return how many characters two texts have in common at their beginnings."""
    low, high = 0, min(len(one), len(other))
    while low < high:
        middle = (low + high + 1) // 2
        if one[low:middle] == other[low:middle]:
            low = middle
        else:
            high = middle - 1
    return low


class _SlotTrace(Trace):
    """A trace that also says what the tokens would be that were tried at the end of a text."""

    __slots__ = ("_of", "found")

    def __init__(self, of: _SlotRecogniser) -> None:
        super().__init__()
        self._of = of
        self.found: list[Slot] = []

    def fail(self, position: int, token: ParsingExpression) -> None:
        """Note a token that does not match; at the end of the text, with its slot."""
        super().fail(position, token)
        if position >= self._of.end and not isinstance(token, EndOfFile):
            self.found.append(self._of.slot(token))


class _SlotRecogniser(Recogniser):
    """A recogniser that knows in which rules and attributes it is."""

    def __init__(self, root: ParsingExpression) -> None:
        self._around: list[Around] = []
        self._attribute = ""
        self.end = 0
        super().__init__(root)

    def slots(self, text: str) -> tuple[int, list[Slot]]:
        """Return how far a text could be read, and the slots at its end."""
        found = self._read(text)
        if not found:
            # What could follow a statement that was kept has not been tried where the text breaks.
            self.forget_from(self.trace.position)
            found = self._read(text)
        return (len(text) if found else self.trace.position), found

    def _read(self, text: str) -> list[Slot]:
        self._around.clear()
        self.end = len(text)
        trace = self.trace = _SlotTrace(self)
        self._root(text, len(text) - len(text.lstrip()))
        return trace.found

    def _statement(self, statements: StatementList, text: str, position: int) -> int:
        key = statements.number, position
        end, looked_at = self._known.get(key, (-1, -1))
        if looked_at > end:
            # It was read on beyond its end, in vain: the trace has to show how far.
            self._known.pop(key, None)
        return super()._statement(statements, text, position)

    def slot(self, token: ParsingExpression) -> Slot:
        """Return what a token would be here."""
        name = token.rule_name if isinstance(token, RegExMatch) else ""
        rule = self._around[-1].rule if self._around else ""
        words = () if is_name(token) else words_of(token)
        around = tuple(Around(each.rule, each.start, dict(each.read)) for each in self._around)
        return Slot(rule, self._attribute, name, words, around)

    def _make(self, expression: ParsingExpression) -> Step:
        inner = super()._make(expression)
        attribute = getattr(expression, "_attr_name", None)
        if attribute is not None:
            return self._in_attribute(inner, attribute)
        token = isinstance(expression, RegExMatch | StrMatch | OrderedChoice)
        if expression.root and not token:
            return self._in_rule(inner, expression.rule_name)
        return inner

    def _in_attribute(self, inner: Step, attribute: str) -> Step:
        def step(text: str, position: int) -> int:
            before, self._attribute = self._attribute, attribute
            end = inner(text, position)
            self._attribute = before
            if end >= 0 and self._around:
                self._around[-1].read[attribute] = text[position:end].rstrip()
            return end

        return step

    def _in_rule(self, inner: Step, rule: str) -> Step:
        def step(text: str, position: int) -> int:
            self._around.append(Around(rule, position, {}))
            before, self._attribute = self._attribute, ""
            end = inner(text, position)
            self._attribute = before
            self._around.pop()
            return end

        return step
