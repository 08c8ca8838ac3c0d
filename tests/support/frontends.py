"""What the frontends of ``launch`` make of the substitutions in a text.

Written after ``launch/frontend/grammar.lark`` and the substitutions of the branch ``jazzy``. What
that grammar reads in two ways, or not at all, is an error here. Run as a program where the real one
can be imported, it prints what that one makes of texts: a test holds both against each other.
"""

from __future__ import annotations

import json
import math
import os
import re
import shutil
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_-]*")


class NotReadableError(Exception):
    """The grammar does not read a text, or reads it in two ways."""


class _Nothing(str):
    """The text between two quotes with nothing between them."""


@dataclass
class Frontend:
    """Reads texts for values of the launch configurations, in the folder of the launch file."""

    values: Mapping[str, str]
    folder: str = "/folder/of/the/launch/file"
    _text: str = field(default="", init=False)
    _at: int = field(default=0, init=False)

    def performed(self, text: str) -> str:
        """Return what the substitutions of a text become.

        Raises:
            NotReadableError: if the grammar has no one way to read it.
        """
        return "".join(self.pieces(text))

    def pieces(self, text: str) -> list[str]:
        """Return the same, each piece of text and each substitution by itself."""
        self._text, self._at = text, 0
        return self._template("")

    def _template(self, quote: str) -> list[str]:
        """Return the pieces of a text up to its end, or to the quote that ends it."""
        found: list[str] = []
        literal = ""
        while self._at < len(self._text) and not (quote and self._next == quote):
            if self._text.startswith("$(", self._at):
                self._no_escape_before()
                found += [literal] * bool(literal) + [self._substitution(quote)]
                literal = ""
            else:
                literal += self._character()
        if quote:
            self._no_escape_before()
            self._expect(quote)
        return found + [literal] * bool(literal)

    @property
    def _next(self) -> str:
        return self._text[self._at : self._at + 1]

    def _no_escape_before(self) -> None:
        if self._text[: self._at].endswith("\\"):
            raise NotReadableError(f"escaped or not: {self._text[self._at :]!r}")

    def _character(self) -> str:
        """Return the next character, without the backslash that escapes it."""
        escaped = re.compile(r"\\(.)").match(self._text, self._at)
        found = escaped[1] if escaped else self._next
        self._at += 2 if escaped else 1
        return found

    def _expect(self, text: str) -> None:
        if not self._text.startswith(text, self._at):
            raise NotReadableError(f"no {text!r} at {self._text[self._at :]!r}")
        self._at += len(text)

    def _substitution(self, quote: str) -> str:
        self._expect("$(")
        name = _NAME.match(self._text, self._at)
        if name is None:
            raise NotReadableError(f"no name at {self._text[self._at :]!r}")
        self._at = name.end()
        operands = []
        while self._next == " ":
            self._at += 1
            operands.append(self._operand(quote))
        self._expect(")")
        try:
            return _SUBSTITUTIONS[name[0]](self, *operands)
        except TypeError as fault:
            raise NotReadableError(f"{name[0]} does not take {operands}") from fault

    def _operand(self, quote: str) -> str:
        mark = self._next
        if not quote and mark in ("'", '"'):
            self._at += 1
            pieces = self._template(mark)
            return "".join(pieces) if pieces else _Nothing()
        start, found = self._at, ""
        while self._next and self._next not in " )":
            if self._text.startswith("$(", self._at):
                self._no_escape_before()
                found += self._substitution(quote)
            elif self._next in (quote or "'\"") or self._next == "(":
                raise NotReadableError(f"{self._next!r} in {self._text[start:]!r}")
            elif self._next == "\\" and self._text[self._at + 1 : self._at + 2] not in (
                *"()",
                *(quote or "'\""),
            ):
                raise NotReadableError(f"a backslash in {self._text[start:]!r}")
            else:
                found += self._character()
        if self._at == start:
            raise NotReadableError(f"nothing before {self._text[start:]!r}")
        return found

    # Substitutions -------------------------------------------------------------------------------

    def _var(self, name: str, default: str | None = None) -> str:
        return self.values[name] if default is None else self.values.get(name, default)

    def _evaluated(self, text: str, modules: str = "math") -> str:
        known = {name: __import__(name) for name in modules.split(",")}
        known |= vars(math) if "math" in known else {}
        return str(eval(text, {}, known))

    def _content(self, path: str) -> str:
        return Path(path).read_text(encoding="utf-8")


def _equals(_: Frontend, one: str, other: str) -> str:
    if isinstance(one, _Nothing) or isinstance(other, _Nothing):
        raise NotReadableError("launch compares with '[]' in place of nothing")
    truths = ("true", "false", "1", "0")
    if one.lower() in truths and other.lower() in truths:
        return _text((one.lower() in ("true", "1")) == (other.lower() in ("true", "1")))
    try:
        return _text(math.isclose(float(one), float(other)))
    except ValueError:
        return _text(one == other)


def _share(_: Frontend, package: str) -> str:
    for prefix in os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep):
        if prefix and Path(prefix, "share", package).is_dir():
            return f"{prefix}/share/{package}"
    return f"/share/{package}"


def _environment(_: Frontend, name: str, default: str | None = None) -> str:
    return os.environ[name] if default is None else os.environ.get(name, default)


def truth(text: str) -> bool:
    """Return what a text means as a condition."""
    return {"true": True, "1": True, "false": False, "0": False}[text.strip().lower()]


def _text(holds: bool) -> str:
    return str(holds).lower()


_SUBSTITUTIONS: Mapping[str, Callable[..., str]] = {
    "and": lambda _, one, other: _text(truth(one) and truth(other)),
    "dirname": lambda self: self.folder,
    "env": _environment,
    "equals": _equals,
    "eval": Frontend._evaluated,
    "file-content": Frontend._content,
    "find-exec": lambda _, name: shutil.which(name) or name,
    "find-pkg-share": _share,
    "if": lambda _, holds, one, other="": one if truth(holds) else other,
    "not": lambda _, holds: _text(not truth(holds)),
    "not-equals": lambda _, one, other: _text(not truth(_equals(_, one, other))),
    "or": lambda _, one, other: _text(truth(one) or truth(other)),
    "var": Frontend._var,
}


def main() -> None:
    """Print what the real frontends make of texts: words of this program, both in JSON."""
    import launch
    from launch.frontend import Parser
    from launch.frontend.parse_substitution import parse_substitution
    from launch.utilities import perform_substitutions

    Parser.load_launch_extensions()
    context = launch.LaunchContext(argv=[])
    values, texts = json.loads(sys.stdin.read())
    context.launch_configurations.update(values)
    print(json.dumps([perform_substitutions(context, parse_substitution(e)) for e in texts]))


if __name__ == "__main__":
    main()
