"""Recovery from syntax errors: all errors of a file, and the rest of its model.

Where the text does not parse, the statement is repaired if a single edit suffices (see
:mod:`.repairs`), so that whatever follows is read as the hint means it; else it becomes blank, and
what it says is lost: its words are noted in the source, and what seems to be
missing because of them is not reported. Then reading goes on from there. Every other character
keeps its place.
"""

from __future__ import annotations

import functools
import re
from dataclasses import dataclass, field

from arpeggio import ParsingExpression, RegExMatch

from deros import codes
from deros.diagnostics import ANY_NAME, Diagnostic, Fix, SourceFile, Span, report
from deros.metamodels.grammar import is_name, literal_of
from deros.metamodels.languages import Language
from deros.metamodels.parsers import grammar
from deros.metamodels.recovery.recogniser import (
    Place,
    Recogniser,
    lists_of,
    skip_blanks,
    statement_at,
)
from deros.metamodels.recovery.repairs import Fault, Repair, is_line_start, repairs
from deros.metamodels.recovery.resumption import PIECE, Search
from deros.metamodels.recovery.syntax import explain
from deros.metamodels.repaired_text import RepairedText

MOST_ERRORS = 50
"""The number of syntax errors that are explained per file; the rest are only counted."""

_WORD = re.compile(r"\w+")
_LOOK_AHEAD = 400


_LAST_WORD = re.compile(r"\b(\w+)[\t\n\r ]*\Z")
_Tokens = tuple[ParsingExpression, ...]
_A_NAME = RegExMatch(r"\w+", rule_name="Name")
_A_NAME.compile()


@dataclass(slots=True)
class Recovered:
    """The result of recovering from syntax errors.

    Attributes:
        text: a text that parses; ``None`` if the head, or all of the file, cannot be parsed.
        diagnostics: the syntax errors.
    """

    text: RepairedText | None
    diagnostics: list[Diagnostic]


def recover(source: SourceFile, prepared: str, language: Language) -> Recovered:
    """Find every syntax error of a text that does not parse.

    The words of the discarded statements are added to the source.
    """
    return _Recovery(source, prepared, language).run()


@functools.cache
def recogniser(language: Language) -> Recogniser:
    """Return the recogniser of a language, made at its first syntax error."""
    return Recogniser(grammar(language))


@dataclass(slots=True)
class _Stretch:
    """A piece of text that does not parse, and whether a statement begins after it."""

    start: int
    end: int
    place: Place
    sure: bool = False
    text_before: RepairedText = field(default_factory=lambda: RepairedText.of(""))


class _Recovery:
    def __init__(self, source: SourceFile, prepared: str, language: Language) -> None:
        self._source = source
        self._language = language
        self._text = RepairedText.of(prepared)
        self._recogniser = recogniser(language)
        self._recogniser.forget()
        self._diagnostics: list[Diagnostic] = []
        self._body_start: int | None = None
        self._stretch: _Stretch | None = None
        self._lost: set[str] = set()

    def run(self) -> Recovered:
        """Repair or blank one error after the other, until the rest parses."""
        complete = True
        while not self._parses():
            if self._diagnostics and not self._text.strip():
                complete = False
                break
            if self._widen():
                continue
            if len(self._diagnostics) >= MOST_ERRORS:
                self._count_the_rest()
                complete = False
                break
            if not self._go_on():
                complete = False
                break
        self._keep_lost()
        self._recogniser.forget()
        is_whole = complete and self._body_start is None
        return Recovered(self._text if is_whole else None, self._diagnostics)

    def _parses(self) -> bool:
        if self._body_start is None:
            return self._recogniser.run(self._text)
        return self._recogniser.run_body(self._text, self._body_start)

    # One error --------------------------------------------------------------------------------

    def _go_on(self) -> bool:
        """Report the error and edit the text to get past it; return whether that succeeded."""
        trace = self._recogniser.trace
        place = statement_at(trace.places, trace.position)
        position, expected = trace.position, tuple(trace.expected)
        if place is not None:
            place, position, expected = self._blamed(place, position, expected)
        # Searched only where it is needed: where edits repair the text, the rest of it is not read.
        resume = functools.cache(lambda: self._resume_at(place, position))
        fault = Fault(
            self._text, position, expected, place, resume, self._language, self._recogniser
        )
        repair = next(repairs(fault), None)
        self._report(fault, repair)
        if repair is not None and repair.start is not None:
            return self._apply(repair)
        end, sure = resume()
        if place is None:
            return self._skip_head(end)
        if _is_nameless(fault):
            self._lost.add(ANY_NAME)
        self._blank(_Stretch(place.start, end, place, sure))
        return True

    def _blamed(self, place: Place, failed: int, expected: _Tokens) -> tuple[Place, int, _Tokens]:
        """Return the broken statement, the position of the fault, and the tokens expected there.

        Where a statement could begin at the failure, that may belong to the statement before all
        the same: on one line with it, or because that one lacks its end and took the next one's
        keyword for a name.
        """
        text = self._text
        if blamed := self._run_on(place, failed):
            return blamed
        whole = place
        if place.start == failed:
            before = self._recogniser.statement_before(place.list, failed)
            if before is not None:
                whole = Place(place.outer, place.list, before)
            elif place.outer is not None:
                whole = place.outer
            else:
                return place, failed, expected
        last = _LAST_WORD.search(text, whole.start, failed)
        if (
            last is not None
            and last[1] in {literal_of(token) for token in expected}
            and not self._recogniser.begins_statement(last.start())
            and self._is_taken_for_a_name(whole, last.start(1), last.end(1), failed)
        ):
            # The keyword is there, but was taken for the name before it.
            return whole, last.start(), (_A_NAME,)
        cut = self._swallowing(whole, place, failed)
        if cut is not None:
            return whole, *cut
        on_same_line = whole.list is place.list and not is_line_start(text, failed)
        if on_same_line and text[:failed].rstrip()[-1:] not in (";", "}", "{"):
            return whole, failed, expected
        return place, failed, expected

    def _run_on(self, place: Place, failed: int) -> tuple[Place, int, _Tokens] | None:
        """Return the statement before one that is none: a word on its line, taken for a name."""
        text, start = self._text, place.start
        is_word = place.list.opened_by(text, start) == "name" and text[start] not in "/~"
        if start >= failed or not is_word or is_line_start(text, start):
            return None
        before = self._recogniser.statement_before(place.list, start)
        if before is None or text[:start].rstrip()[-1:] in (";", "}", "{"):
            return None
        trace = self._recogniser.try_statement(place.list, text[:start], before).trace
        expected = tuple(trace.expected) if trace.position >= start else (_A_NAME,)
        return Place(place.outer, place.list, before), start, expected

    def _is_taken_for_a_name(self, whole: Place, start: int, end: int, failed: int) -> bool:
        """Return whether any other word would parse in the place of a word."""
        other = f"{self._text[:start]}{'z' * (end - start)}{self._text[end:]}"
        return self._recogniser.try_statement(whole.list, other, whole.start).reached >= failed

    def _swallowing(self, whole: Place, place: Place, failed: int) -> tuple[int, _Tokens] | None:
        """Return where a statement without its end took the next one's keyword for a name."""
        text = self._text
        here = text.rfind("\n", whole.start, failed) + 1
        here = skip_blanks(text, here).end()  # type: ignore[union-attr]
        if not whole.start < here < failed:
            return None
        for each in lists_of(place):
            if each.opened_by(text, here) == "keyword":
                if self._recogniser.try_statement(each, text, here).end <= failed:
                    return None
                cut = self._recogniser.try_statement(whole.list, text[:here], whole.start)
                if cut.trace.position < here or not cut.trace.expected:
                    return None
                return here, tuple(cut.trace.expected)
        return None

    def _report(self, fault: Fault, repair: Repair | None) -> None:
        original = self._text.original
        hint, fix = "", None
        position = original(fault.position)
        if repair is not None:
            hint = repair.hint
            if repair.start is not None:
                span = Span(self._source, original(repair.start), original(repair.end))
                fix = Fix(span, repair.text)
        found = explain(self._source, position, fault.expected, hint, fix)
        if repair is not None and repair.message:
            span = found.span
            if repair.start is not None and repair.end > repair.start:
                span = Span(self._source, original(repair.start), original(repair.end))
            found = report(codes.SYNTAX_ERROR, repair.message, span, hint, fix=fix)
        self._diagnostics.append(found)

    def _apply(self, repair: Repair) -> bool:
        assert repair.start is not None
        text = repair.text if repair.reads_as is None else repair.reads_as
        self._text = self._text.replaced(repair.start, repair.end, text)
        self._forget(repair.start)
        self._stretch = None
        return True

    def _blank(self, stretch: _Stretch) -> None:
        stretch.text_before = self._text
        self._stretch = stretch
        self._text = self._text.blanked(stretch.start, stretch.end)
        self._forget(stretch.start)

    def _widen(self) -> bool:
        """Blank the enclosing statement if blanking the last one alone was not enough."""
        stretch = self._stretch
        if stretch is None:
            return False
        reached = self._recogniser.trace.position
        if reached > stretch.end or not (stretch.sure or reached >= len(self._text)):
            self._lose(stretch)
            return False
        outer = stretch.place.outer
        if outer is None:
            self._lose(stretch)
            return False
        self._text = stretch.text_before
        end, sure = self._resume_at(outer, stretch.end)
        self._blank(_Stretch(outer.start, end, outer, sure))
        return True

    def _lose(self, stretch: _Stretch) -> None:
        self._lost.update(_WORD.findall(stretch.text_before[stretch.start : stretch.end]))
        self._stretch = None

    def _keep_lost(self) -> None:
        if self._stretch is not None:
            self._lose(self._stretch)
        self._source.lost = frozenset(self._lost)

    def _skip_head(self, end: int) -> bool:
        """Skip a head that does not parse; its statements are read nevertheless."""
        self._lost.update(_WORD.findall(self._text[:end]))
        if end >= len(self._text) or self._recogniser.body is None:
            return False
        self._body_start = end
        self._recogniser.forget()
        return True

    def _forget(self, position: int) -> None:
        """Discard cached statements that may end elsewhere now.

        A token may look some words ahead.
        """
        start = max(0, position - _LOOK_AHEAD)
        words = list(re.finditer(r"\S+", self._text[start:position]))
        self._recogniser.forget_from(start + words[-3].start() if len(words) > 2 else start)

    def _count_the_rest(self) -> None:
        """Report the number of further statements that do not parse."""
        trace = self._recogniser.trace
        position = trace.position
        place = statement_at(trace.places, position)
        first = self._text.original(position)
        count = 0
        while position < len(self._text):
            count += 1
            end, _ = self._resume_at(place, position)
            while place is not None and end < len(self._text):
                after = self._statement_end(place, end)
                if after <= end:
                    break
                end = after
            position = max(end, position + 1)
            if place is not None:
                place = Place(place.outer, place.list, position)
        span = Span(self._source, first, first)
        message = f"at least {count} more syntax error{'s' if count > 1 else ''}: not shown"
        self._diagnostics.append(report(codes.MORE_SYNTAX_ERRORS, message, span))

    def _statement_end(self, place: Place, start: int) -> int:
        for each in lists_of(place):
            end = self._recogniser.try_statement(each, self._text, start).end
            if end > start:
                return end
        found = self._text[start]
        return skip_blanks(self._text, start + 1).end() if found in "};" else -1  # type: ignore[union-attr]

    # Where reading goes on --------------------------------------------------------------------

    def _resume_at(self, place: Place | None, failed: int) -> tuple[int, bool]:
        """Return where the next statement begins, and whether that is certain.

        Args:
            place: the broken statement; ``None`` for the head of a file.
            failed: the position where it does not parse.
        """
        body = self._recogniser.body
        if place is None and body is None:
            return len(self._text), False
        lists = lists_of(place) if place is not None else [body] if body else []
        start = place.start if place is not None else skip_blanks(self._text).end()  # type: ignore[union-attr]
        return Search(self._text, self._recogniser, lists, start, failed).end()


def _is_nameless(fault: Fault) -> bool:
    """Return whether a declaration lacks its name: whatever is missing elsewhere may be it."""
    words = PIECE.findall(fault.text[fault.start : fault.position])
    if not words:
        return fault.place is not None and any(map(is_name, fault.place.list.first))
    return len(words) == 1 and any(map(is_name, fault.expected))
