"""Edits that repair a statement: habits of other languages, misspelt keywords, missing signs.

Nothing is guessed. An edit is offered when the statement parses with it (a habit, which has its own
words: when the parse gets past it), and it is the only one of its kind that does.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from itertools import islice

from arpeggio import ParsingExpression

from deros.metamodels.grammar import literal_of, words_of
from deros.metamodels.languages import DEROS, Language
from deros.metamodels.recovery.durations_inside import missing_parentheses
from deros.metamodels.recovery.habits import habits
from deros.metamodels.recovery.recogniser import Attempt, Place, Recogniser, Trace, skip_blanks
from deros.metamodels.recovery.syntax import found_at
from deros.metamodels.repaired_text import RepairedText
from deros.names.names import did_you_mean, near

_LARGEST_TO_CLOSE = 50_000
"""The largest block in which a missing brace is searched for, as each attempt parses it again."""

_MOST_BLOCKS = 4
"""The number of blocks around a fault that are tried to close."""


@dataclass(frozen=True, slots=True)
class Fault:
    """A position where the text does not parse.

    Attributes:
        text: the text with all edits so far.
        position: of the first character that does not parse.
        expected: the tokens that are valid there.
        place: the broken statement, ``None`` for the head of the file.
        resume: returns where the next statement begins, and whether that is certain.
    """

    text: RepairedText
    position: int
    expected: tuple[ParsingExpression, ...]
    place: Place | None
    resume: Callable[[], tuple[int, bool]]
    language: Language
    recogniser: Recogniser

    @property
    def found(self) -> str:
        """The token at the position, empty at the end of the text."""
        return found_at(self.text, self.position)

    @property
    def start(self) -> int:
        """The start of the broken statement."""
        return self.place.start if self.place is not None else 0

    def is_mended_by(self, start: int, end: int, by: str) -> bool:
        """Return whether the statement, or its head, is whole after an edit."""
        return any(self._is_whole(place, start, end, by) for place in self._candidates)

    @property
    def _candidates(self) -> list[Place | None]:
        """The broken statement; where none has begun yet, one of any list that may go on here."""
        place = self.place
        if place is None or place.start != self.position:
            return [place]
        found: dict[int, Place | None] = {}
        while place is not None:
            found.setdefault(place.list.number, Place(place.outer, place.list, self.position))
            place = place.outer
        return list(found.values())

    @property
    def start_of_words(self) -> int:
        """Where the statement begins whose words the fault stands among."""
        return min((each.start for each in self._unfinished), default=self.start)

    @property
    def _unfinished(self) -> tuple[Place, ...]:
        """The statement around one that would begin here: its own words may go on instead."""
        place = self.place
        if place is None or place.start != self.position or place.outer is None:
            return ()
        return (place.outer,)

    def _is_whole(self, place: Place | None, start: int, end: int, by: str) -> bool:
        text, attempt, longer = self._attempt(start, end, by, place)
        behind = self.position + max(longer, 0)
        if attempt.end > behind and (
            self._goes_on(text, attempt.end, by) or attempt.end >= self.resume()[0] + longer
        ):
            return True
        return attempt.head_matches and attempt.reached > behind

    def opens_statement_by(self, by: str) -> bool:
        """Return whether what was found is the start of a statement once something precedes it."""
        for place in self._candidates:
            _, attempt, longer = self._attempt(self.position, self.position, by, place)
            if self.position + longer in attempt.starts:
                return True
        return False

    def gets_on_by(self, start: int, end: int, by: str) -> bool:
        """Return whether the parse gets past the fault, and past the edit, after an edit."""
        for place in (*self._candidates, *self._unfinished):
            _, attempt, longer = self._attempt(start, end, by, place)
            if attempt.reached > max(self.position + longer, start + len(by) - 1):
                return True
        return False

    def _goes_on(self, text: str, position: int, by: str) -> bool:
        """Return whether a statement begins on a new line, or a block ends."""
        if position >= len(text) or text[position] == "}":
            return True
        if not is_line_start(text, position):
            return False
        place = self.place
        if place is not None and by.startswith("}"):
            place = place.outer
        while place is not None:
            if place.list.opened_by(text, position) or place.list.seems_opened_by(text, position):
                return True
            place = place.outer
        body = self.recogniser.body if self.place is None else None
        return body is not None and bool(body.opened_by(text, position))

    def _attempt(
        self, start: int, end: int, by: str, place: Place | None
    ) -> tuple[str, Attempt, int]:
        text = self.text.replaced(start, end, by)
        if by.startswith("}") and place is not None and place.outer is not None:
            if start - place.outer.start > _LARGEST_TO_CLOSE:
                return text, Attempt(-1, Trace(), frozenset()), 0
            place = place.outer  # the brace closes that statement
        if place is None:
            attempt = self.recogniser.try_all(text)
        else:
            begin = skip_blanks(text, place.start).end()  # type: ignore[union-attr]
            attempt = self.recogniser.try_statement(place.list, text, begin)
        return text, attempt, len(by) - (end - start)


@dataclass(frozen=True, slots=True)
class Repair:
    """A repair of a fault.

    Attributes:
        hint: in words.
        start: where the edit begins; ``None`` if the words alone are offered.
        end: where what it replaces ends.
        text: what it puts there.
        message: what is wrong, if there are better words for it than those for any syntax error.
        reads_as: what a parser reads in place of ``text``, if that is a comment.
    """

    hint: str
    start: int | None = None
    end: int = 0
    text: str = ""
    message: str = ""
    reads_as: str | None = None


def repairs(fault: Fault) -> Iterator[Repair]:
    """Yield repairs of a fault, the likeliest first."""
    yield from _parentheses(fault)
    yield from _by_habit(fault)
    yield from islice(_misspelt(fault), 1)
    yield from _only(_other_sign(fault))
    yield from _only(_missing_sign(fault))
    yield from _only(_surplus_sign(fault))
    yield from _open_block(fault)


def _only(found: Iterable[Repair]) -> Iterator[Repair]:
    """Yield the edit if it is the only one that repairs the statement."""
    edits = list(found)
    if len(edits) == 1:
        yield edits[0]


def _parentheses(fault: Fault) -> Iterator[Repair]:
    """Put what a duration covers in parentheses, where the condition goes on behind it."""
    if fault.language is not DEROS:
        return
    found = missing_parentheses(fault.text, fault.position, fault.start)
    if found is None or not fault.gets_on_by(found.start, found.end, found.text):
        return
    if found.is_certain:
        yield Repair(found.hint, found.start, found.end, found.text, found.message)
    else:
        yield Repair(found.hint, message=found.message)


def _by_habit(fault: Fault) -> Iterator[Repair]:
    for habit in habits(fault.text, fault.position, fault.start_of_words, fault.language):
        if habit.text is None:
            yield Repair(habit.hint, None, message=habit.message)
            return
        reads_as = habit.text if habit.reads_as is None else habit.reads_as
        if fault.gets_on_by(habit.start, habit.end, reads_as):
            yield Repair(
                habit.hint, habit.start, habit.end, habit.text, habit.message, habit.reads_as
            )
            return


def _literals(fault: Fault) -> list[str]:
    literals = (literal_of(token) for token in fault.expected)
    is_open = fault.text.count("{") > fault.text.count("}")
    return [
        each
        for each in dict.fromkeys(literals)
        if each is not None and each != ";" and (is_open or each != "}")
    ]


def _misspelt(fault: Fault) -> Iterator[Repair]:
    found = fault.found
    if not found[:1].isalpha():
        return
    end = fault.position + len(found)
    words = [each for token in fault.expected for each in words_of(token) if each[0].isalpha()]
    for word in near(found, words, _NEAREST):
        if fault.is_mended_by(fault.position, end, word):
            yield Repair(did_you_mean([word]), fault.position, end, word)


def _other_sign(fault: Fault) -> Iterator[Repair]:
    found = fault.found
    if found[:1] not in _MISTAKEN_SIGNS:
        return
    length = 2 if fault.text[fault.position : fault.position + 2] in _LONG_SIGNS else 1
    end = fault.position + length
    is_arrow = fault.text[fault.position : end] in ("->", "=>")
    for sign in _literals(fault):
        if sign[0].isalpha() and not is_arrow:
            continue
        if fault.is_mended_by(fault.position, end, _spaced(fault, fault.position, end, sign)):
            hint = f"write '{sign}' instead of '{fault.text[fault.position : end]}'"
            text = _spaced(fault, fault.position, end, sign)
            yield Repair(hint, fault.position, end, text)


_MISTAKEN_SIGNS = tuple(":=-,;)]|&")
_NEAREST = 2
_KEYWORD_BEFORE = re.compile(r"\b(\w+)\s*\Z")
_NEVER_MISSING = frozenset({"-", "[", "(", "when", "container"})
"""Nor is `when` what somebody forgets: nearly anything could be read as a condition behind it. What
looks like a container without its word is a subsystem without it."""

_SUBSYSTEM = re.compile(r"\w+\s*(?:[:{]|namespace\b)")
"""What follows the word where one is missing: any word alone would do as an empty subsystem."""

_LONG_SIGNS = frozenset({"->", "=>", ":=", "==", "<-", "::", "++", "--", "!="})


def _missing_sign(fault: Fault) -> Iterator[Repair]:
    if not fault.found or _opens_next(fault):
        return
    signs = [sign for sign in _literals(fault) if sign not in _NEVER_MISSING]
    if fault.found[0] in _MISTAKEN_SIGNS:
        signs = [sign for sign in signs if not sign[0].isalpha()]
    # What was found may be the keyword of a statement that the missing word makes room for.
    opening = [sign for sign in signs if fault.opens_statement_by(f"{sign} ")]
    if not _SUBSYSTEM.match(fault.text, fault.position):
        signs = [sign for sign in signs if sign != "subsystem"]
    for sign in opening or signs:
        if fault.is_mended_by(fault.position, fault.position, f"{sign} "):
            before = fault.text[: fault.position].rstrip()
            # A sign goes behind the last word, a word before the next one.
            start = len(before) if not sign[0].isalpha() and sign != "{" else fault.position
            text = sign if start < fault.position else f"{sign} "
            hint = f"write '{sign}' before '{fault.found}'"
            yield Repair(hint, start, start, text)


def _opens_next(fault: Fault) -> bool:
    """Return whether the token begins the next statement: then more than a sign is missing."""
    place = fault.place
    while place is not None:
        if place.list.opened_by(fault.text, fault.position) == "keyword":
            return fault.place is None or fault.place.start < fault.position
        place = place.outer
    return False


def _surplus_sign(fault: Fault) -> Iterator[Repair]:
    found = fault.found
    before = _KEYWORD_BEFORE.search(fault.text, 0, fault.position)
    is_after_keyword = before is not None and before[1] in fault.recogniser.words
    if found not in (";", ",", ".") and not (found in (":", "=") and is_after_keyword):
        return
    end = fault.position + 1
    if fault.is_mended_by(fault.position, end, " "):
        yield Repair(f"remove '{found}'", fault.position, end, "")


def _open_block(fault: Fault) -> Iterator[Repair]:
    """Close a block without a closing brace at the end, or before an outer statement."""
    text = fault.text
    missing = text.count("{") - text.count("}")
    if missing <= 0 or fault.place is None:
        return
    if not fault.found:
        if "}" in _literals(fault):
            end = len(text.rstrip())
            braces = "\n}" * missing
            yield Repair(f"close the block with '{'}' * missing}'", end, end, braces)
        return
    outer = fault.place.outer
    start = fault.place.start
    for _ in range(_MOST_BLOCKS):
        if outer is None or start - outer.start > _LARGEST_TO_CLOSE:
            return
        closed = text.replaced(start, start, "} ")
        end = fault.recogniser.try_statement(outer.list, closed, outer.start).end
        if end == start + 2 and _goes_on(fault, outer, closed, end):
            behind = len(text[:start].rstrip())
            word = found_at(text, start)
            opened = " ".join(text[outer.start : text.index("{", outer.start)].split())
            yield Repair(
                f"close '{opened} {{' with '}}' before '{word}'",
                behind,
                behind,
                "\n}",
                f"'}}' is missing before '{word}'",
            )
            return
        outer = outer.outer


def _goes_on(fault: Fault, outer: Place, text: str, position: int) -> bool:
    each: Place | None = outer
    while each is not None:
        if each.list.opened_by(text, position) == "keyword":
            return fault.recogniser.try_statement(each.list, text, position).end > position
        each = each.outer
    return False


def is_line_start(text: str, position: int) -> bool:
    """Return whether a position is the first non-blank of a line, or the end of the text."""
    line = text[text.rfind("\n", 0, position) + 1 : position]
    return not line.strip() or position >= len(text)


def _spaced(fault: Fault, start: int, end: int, word: str) -> str:
    """Return a keyword with spaces where it would touch a word."""
    if not word[0].isalpha():
        return word
    before = " " if fault.text[start - 1 : start].strip() else ""
    after = " " if re.match(r"\S", fault.text[end : end + 1]) else ""
    return f"{before}{word}{after}"
