"""Planted slips as data: the kind of structural change, and the place in generated code.

A place is given by patterns of code, compared token by token, so that neither spaces nor comments
count: ``$`` stands for any characters of one token (``$1`` for the same ones at each place), and
``$$`` for any number of tokens.
"""

from __future__ import annotations

import functools
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import NamedTuple

from tests.support.tables import rows

KINDS = {
    "statement": "a statement removed",
    "comparison": "the operator of a comparison exchanged",
    "operator": "an arithmetic or logical operator exchanged",
    "constant": "a constant exchanged for another one of its kind, or changed by one",
    "bound": "a name in a comparison made one more",
    "value": "an expression exchanged for a constant or a name",
    "target": "one of the targets of an assignment removed",
    "once": "an attribute assigned only if it has no value",
}
"""The kinds of changes that slips are made by."""

_TOKEN = re.compile(
    r"(?P<comment>/\*.*?\*/|\#[^\n]*)"
    r"|(?P<token>'(?:[^'\\\n]|\\.)*'|\"(?:[^\"\\\n]|\\.)*\""
    r"|\d[\w.]*|[\w$]+|->|[<>=!]=|&&|\|\||\+\+|--|\S)",
    re.DOTALL,
)
_END = "\0"  # of each token
_ANY = f"[^{_END}]"


@dataclass(frozen=True)
class Slip:
    """One structural change, made at every place that its patterns describe.

    Attributes:
        kind: a key of :data:`KINDS`.
        function: patterns of the names of functions, with spaces between.
        at: a pattern of the node that is changed; of a whole comparison or operation.
        to: a pattern of what is in its place; the first choice of the kind if empty. Of a
            comparison or operation, the operator; of a value, the text itself.
        within: a pattern of a node around it, with ``@`` in place of the node; any if empty.
    """

    kind: str
    function: str
    at: str
    to: str = ""
    within: str = ""

    def __post_init__(self) -> None:
        """Check the kind."""
        assert self.kind in KINDS, self.kind

    def is_in(self, function: str) -> bool:
        """Tell whether the function is one of those meant."""
        return any(matches(each, function) for each in self.function.split())

    def is_at(self, code: str, around: Iterable[tuple[str, str]]) -> bool:
        """Tell whether the node is one of those meant.

        Args:
            code: its text.
            around: of each node around it, the text before and after.
        """
        if not matches(self.at, code):
            return False
        return not self.within or any(
            matches(self.within, f"{before} @ {after}") for before, after in around
        )

    def chooses(self, text: str) -> bool:
        """Tell whether a text is what is to be in place of the node."""
        return not self.to or matches(self.to, text)


def listed(heading: str) -> dict[str, tuple[Slip, ...]]:
    """Return the slips below a heading of ``tests/data/slips.md``, those made together by name."""
    found: dict[str, tuple[Slip, ...]] = {}
    for row in rows("slips", heading):
        slip = Slip(row["kind"], row["function"], row["at"], row["to"], row["within"])
        found[row["slip"]] = (*found.get(row["slip"], ()), slip)
    return found


class Edit(NamedTuple):
    """Bytes from ``start`` to ``end`` replaced by a text."""

    start: int
    end: int
    text: str


def edited(data: bytes, edits: Iterable[Edit]) -> bytes:
    """Return a text with its edits made; of those that overlap, the first."""
    parts: list[bytes] = []
    done = 0
    for start, end, text in sorted(edits, key=lambda each: (each.start, -each.end)):
        if start >= done:
            parts += [data[done:start], text.encode()]
            done = end
    return b"".join([*parts, data[done:]])


def matches(pattern: str, code: str) -> bool:
    """Tell whether a pattern describes the whole of a code."""
    return _compiled(pattern).fullmatch("".join(each + _END for each in _tokens(code))) is not None


def _tokens(code: str) -> Iterator[str]:
    return (each["token"] for each in _TOKEN.finditer(code) if each["token"])


@functools.cache
def _compiled(pattern: str) -> re.Pattern[str]:
    """Return a pattern as an expression over tokens, each with its end."""
    numbered: set[str] = set()

    def expression(token: str) -> str:
        if token == "$$":
            return f"(?:{_ANY}*{_END})*"
        found = ""
        for part in re.split(r"(\$\d?)", token):
            if not part.startswith("$"):
                found += re.escape(part)
            elif part == "$":
                found += f"{_ANY}*"
            elif part in numbered:
                found += f"(?P=n{part[1:]})"
            else:
                numbered.add(part)
                found += f"(?P<n{part[1:]}>{_ANY}+)"
        return found + _END

    return re.compile("".join(expression(each) for each in _tokens(pattern)))
