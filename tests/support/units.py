"""Units of systemd, as systemd reads them."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

_ESCAPE = re.compile(r"\\(x[0-9a-f]{2}|.)", re.DOTALL)
_ESCAPES = {"n": "\n", "t": "\t", "r": "\r"}
_WORD = re.compile(
    r"""\s*((?:"(?:\\.|[^"\\])*"|'(?:\\.|[^'\\])*'|[^\s"'\\])+)(?:\s|$)""", re.DOTALL
)
_PIECE = re.compile(r""""(?:\\.|[^"\\])*"|'(?:\\.|[^'\\])*'|[^\s"'\\]+""", re.DOTALL)


@dataclass(frozen=True)
class Unit:
    """The settings of a unit, in the order written."""

    settings: tuple[tuple[str, str, str], ...]

    def values(self, section: str, name: str) -> list[str]:
        """Return the values of a setting that may stand there several times."""
        return [value for *where, value in self.settings if where == [section, name]]

    def value(self, section: str, name: str) -> str:
        """Return the value of a setting that stands there once."""
        (found,) = self.values(section, name)
        return found

    def command(self) -> list[str]:
        """Return the words of ``ExecStart``."""
        words = words_of(self.value("Service", "ExecStart"))
        return [expanded(each, {}).replace("$$", "$") for each in words]

    def environment(self, specifiers: Mapping[str, str]) -> dict[str, str]:
        """Return the variables that are set."""
        values = self.values("Service", "Environment")
        words = (expanded(each, specifiers) for value in values for each in words_of(value))
        return dict(each.split("=", 1) for each in words)


def read_unit(text: str) -> Unit:
    """Read a unit: comments, sections, and lines that go on after a backslash."""
    found, section, pending = [], "", ""
    for line in text.splitlines():
        if line.lstrip().startswith(("#", ";")):
            continue
        if line.endswith("\\"):
            pending += line[:-1] + " "
            continue
        whole, pending = (pending + line).strip(), ""
        if whole.startswith("["):
            section = whole.strip("[]")
        elif whole:
            name, _, value = whole.partition("=")
            found.append((section, name, value))
    assert not pending
    return Unit(tuple(found))


def words_of(value: str) -> list[str]:
    """Take a value apart at blanks that are not quoted (systemd.syntax(7), "Quoting")."""
    return list(_words(value))


def _words(value: str) -> Iterator[str]:
    position = 0
    while value[position:].strip():
        found = _WORD.match(value, position)
        assert found is not None, value[position:]
        position = found.end()
        yield "".join(_unquoted(piece) for piece in _PIECE.findall(found[1]))


def _unquoted(piece: str) -> str:
    if piece[0] not in "\"'":
        return piece
    return _ESCAPE.sub(_unescaped, piece[1:-1])


def _unescaped(found: re.Match[str]) -> str:
    code = found[1]
    return chr(int(code[1:], 16)) if len(code) == 3 else _ESCAPES.get(code, code)


def expanded(text: str, specifiers: Mapping[str, str]) -> str:
    """Return a text with its specifiers; ``%%`` is one percent sign."""
    known = {"%": "%", **specifiers}
    return re.sub("%(.)", lambda found: known[found[1]], text)
