"""A duration inside a condition: ``a for 1 sec or b``, which needs parentheses.

``for T``, ``within T`` and ``since q`` close a condition and cover all of it, so that nothing can
follow them. Where something does, the parentheses say what the duration is meant to cover.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

_TOKEN = re.compile(
    r'"[^"\\\n]*(?:\\.[^"\\\n]*)*"|[^\W\d]\w*|[^\s\w]|\d+(?:\.\d+)?(?:[eE][+-]?\d+)?'
)
_OPENING, _CLOSING = frozenset("([{"), frozenset(")]}")
_JOINING = frozenset({"and", "or"})
_BEHIND = frozenset({"for", "within", "since", "begins"})
_DURATION = re.compile(r"(?<!begins )\b(?:for|within)\s+[^\s()]+(?:\s*[A-Za-z]+)?\s*\Z")
_LONGEST = 2000


@dataclass(frozen=True, slots=True)
class Parentheses:
    """Where parentheses are missing.

    Attributes:
        start: the start of the condition.
        end: the end of what changes.
        text: what to write there instead.
        hint: in words.
        message: what is wrong.
        is_certain: whether the condition can mean nothing else.
    """

    start: int
    end: int
    text: str
    hint: str
    message: str
    is_certain: bool = True


@dataclass(frozen=True, slots=True)
class _Operand:
    """An operand of ``and`` or ``or``, with the word before it, and where it ends."""

    joined_by: str
    text: str
    end: int

    @property
    def lasts(self) -> bool:
        """Whether it ends with a duration."""
        return _DURATION.search(self.text) is not None

    def written(self) -> str:
        """Return the word before it and itself, in parentheses if it has a duration."""
        text = f"({self.text})" if self.lasts else self.text or "…"
        return f"{self.joined_by} {text}".lstrip()


def missing_parentheses(text: str, position: int, start: int) -> Parentheses | None:
    """Return where parentheses are missing around a duration, or ``None``.

    Args:
        text: the whole text, without comments.
        position: where it does not parse.
        start: where its statement begins.
    """
    found = re.compile(r"[a-z]+\b").match(text, position)
    if found is None or position - start > _LONGEST or found[0] not in _JOINING | _BEHIND:
        return None
    begin = _condition_start(text, start, position)
    before = _plain(text[begin:position])
    closing = _DURATION.search(before)
    if found[0] in _BEHIND and (closing or _has_since(text, begin, position)):
        last = closing[0].strip() if closing else "since"
        message = f"'{last}' closes a condition, so that '{found[0]}' cannot follow it"
        hint = f"write '({before}) {found[0]} …'"
        return Parentheses(begin, position, f"({before}) ", hint, message)
    if closing is None or found[0] in _BEHIND:
        return None
    message = f"'{closing[0].strip()}' closes a condition, so that '{found[0]}' cannot follow it"
    end = _condition_end(text, position)
    if _has_since(text, begin, position):
        hint = f"write '({before}) {found[0]} …'"
        return Parentheses(begin, position, f"({before}) ", hint, message)
    return _around_operands(list(_operands(text, begin, end)), begin, before, message)


def _around_operands(
    operands: list[_Operand], begin: int, before: str, message: str
) -> Parentheses | None:
    """Return parentheses around each operand that ends with a duration."""
    lasting = [index for index, each in enumerate(operands) if each.lasts]
    if not lasting:
        return None
    first, last = lasting[0], lasting[-1]
    shown = operands[: max(last + 1, first + 2)]
    hint = f"write '{' '.join(each.written() for each in shown)}'"
    if first:  # as it stands, the duration would cover all that is before it
        rest = " ".join(each.written() for each in shown[first + 1 :])
        hint = f"write '({before}) {rest}', or {hint.removeprefix('write ')}"
    edit = " ".join(each.written() for each in operands[: last + 1])
    return Parentheses(begin, operands[last].end, f"{edit} ", hint, message, not first)


def _has_since(text: str, begin: int, end: int) -> bool:
    """Return whether a part of a condition has a ``since`` outside of parentheses."""
    depth = 0
    for token, _ in _tokens(text, begin, end):
        depth += (token in _OPENING) - (token in _CLOSING)
        if not depth and token == "since":
            return True
    return False


def _plain(text: str) -> str:
    return " ".join(text.split())


def _tokens(text: str, start: int, end: int) -> Iterator[tuple[str, int]]:
    for each in _TOKEN.finditer(text, start, end):
        yield each[0], each.start()


def _condition_start(text: str, start: int, position: int) -> int:
    """Return where the innermost condition begins that a position is in."""
    starts = [start]
    for token, at in _tokens(text, start, position):
        behind = at + len(token)
        if token in _OPENING:
            starts.append(behind)
        elif token in _CLOSING and len(starts) > 1:
            starts.pop()
        elif token in ("if", ":", ";"):
            starts[-1] = behind
    begin = starts[-1]
    return begin + len(text[begin:position]) - len(text[begin:position].lstrip())


def _condition_end(text: str, position: int) -> int:
    """Return where the condition ends that goes on at a position."""
    depth = 0
    for token, at in _tokens(text, position, min(len(text), position + _LONGEST)):
        if token in _OPENING:
            depth += 1
        elif token in _CLOSING:
            depth -= 1
        if depth < 0 or (not depth and token in ("then", ";", "if")):
            return at
    return len(text)


def _operands(text: str, begin: int, end: int) -> Iterator[_Operand]:
    """Yield what ``and`` and ``or`` join, outside of any parentheses."""
    depth, start, word = 0, begin, ""
    for token, at in _tokens(text, begin, end):
        depth += (token in _OPENING) - (token in _CLOSING)
        if not depth and token in _JOINING:
            yield _Operand(word, _plain(text[start:at]), at)
            start, word = at + len(token), token
    yield _Operand(word, _plain(text[start:end]), end)
