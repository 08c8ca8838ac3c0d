"""Prints each regular expression of deros as a JSON list: pattern, flags, file and line.

Run as a program: it imports all of deros and notes what is compiled meanwhile. Expressions that are
put together from parts stand nowhere as a whole. Those in calls of ``re.match`` and its like are
read from the text, as they are compiled in the call alone; those of the languages, from the
grammars and from what colours them.
"""

from __future__ import annotations

import ast
import contextlib
import json
import pkgutil
import re
import sys
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path

from arpeggio import RegExMatch

import deros

SOURCE = Path(deros.__file__).parent
CALLS = {"match", "fullmatch", "search", "finditer", "findall", "sub", "split"}

Found = tuple[str, int, str, int]


def compiled() -> list[Found]:
    """Return the expressions that modules compile when they are imported."""
    found: list[Found] = []
    compile_ = re.compile

    def noting(pattern: str, flags: int = 0) -> re.Pattern[str]:
        frame = sys._getframe(1)
        path = Path(frame.f_code.co_filename)
        if path.is_relative_to(SOURCE) and isinstance(pattern, str):
            name = path.relative_to(SOURCE).as_posix()
            found.append((pattern, int(flags), name, frame.f_lineno))
        return compile_(pattern, flags)

    re.compile = noting  # type: ignore[assignment]
    for module in pkgutil.walk_packages(deros.__path__, "deros."):
        # Some need ROS, and a package's set-up is a program.
        if not module.name.endswith((".__main__", ".setup")):
            with contextlib.suppress(ImportError):
                import_module(module.name)
    return found


def in_calls() -> Iterator[Found]:
    """Yield the expressions that are written in the calls that look for them."""
    for path in SOURCE.rglob("*.py"):
        for call in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            match call:
                case ast.Call(
                    ast.Attribute(ast.Name("re"), name), [ast.Constant(str(pattern)), *_]
                ) if name in CALLS:
                    yield pattern, 0, path.relative_to(SOURCE).as_posix(), call.lineno


def of_languages() -> Iterator[Found]:
    """Yield the expressions of the three grammars, and those that colour their words."""
    # At the beginning of the file, these would compile theirs before that is noted.
    from deros.formatting.highlighting.patterns import patterns
    from deros.metamodels.grammar import expressions
    from deros.metamodels.languages import LANGUAGES
    from deros.metamodels.parsers import grammar

    for language in LANGUAGES:
        for expression in expressions(grammar(language)):
            if isinstance(expression, RegExMatch):
                yield expression.to_match_regex, 0, language.name, 0
        for pattern in patterns(language):
            yield pattern.regex, 0, language.name, 0


if __name__ == "__main__":
    json.dump(sorted({*compiled(), *in_calls(), *of_languages()}), sys.stdout)
