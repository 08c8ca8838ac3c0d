"""All models in the repository as texts: examples, cases, scaffolds, snippets of the documents."""

from __future__ import annotations

import functools
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from deros.cli.scaffolds import scaffold
from deros.metamodels.languages import LANGUAGES, Language, language_named, language_of

ROOT = Path(__file__).resolve().parents[2]

_FENCE = re.compile(r"^( *)```(\w+)[^\n]*\n(.*?)^\1```", re.MULTILINE | re.DOTALL)


@dataclass(frozen=True, slots=True)
class Written:
    """A model as it is written somewhere.

    Attributes:
        name: the file, and for a snippet the line in it where the text begins.
        language: its language.
        text: all of it; a snippet is without the indentation of its fence.
        file: the file.
        start: the offset in the file at which it begins.
        indent: the columns that the lines of a snippet are indented by.
    """

    name: str
    language: Language
    text: str
    file: Path
    start: int = 0
    indent: str = ""

    def __str__(self) -> str:
        return self.name


@functools.cache
def examples() -> tuple[Written, ...]:
    """Return the models of the examples."""
    return tuple(_files(ROOT / "examples"))


@functools.cache
def cases() -> tuple[Written, ...]:
    """Return the models of the cases of diagnostics that are text."""
    return tuple(_files(ROOT / "tests" / "cases"))


@functools.cache
def snippets() -> tuple[Written, ...]:
    """Return the fenced blocks of models in all documents; many are a part of one."""
    pages = (*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md"), *ROOT.glob("examples/**/*.md"))
    return tuple(each for page in sorted(pages) for each in _snippets(page))


@functools.cache
def scaffolds() -> tuple[Written, ...]:
    """Return what ``deros new`` writes."""
    return tuple(
        Written(f"new {each.kind}: {name}", each, text, Path(name))
        for kind in LANGUAGES
        for name, text in scaffold(kind.kind, "robot", "robot_pkg").items()
        if (each := language_of(name)) is not None
    )


def _files(folder: Path) -> Iterator[Written]:
    for path in sorted(folder.rglob("*")):
        language = language_of(path)
        if language is None or not path.is_file():
            continue
        try:
            text = path.read_bytes().decode("utf-8")
        except UnicodeDecodeError:
            continue
        yield Written(path.relative_to(ROOT).as_posix(), language, text, path)


def _snippets(page: Path) -> Iterator[Written]:
    whole = page.read_text(encoding="utf-8")
    for found in _FENCE.finditer(whole):
        language = language_named(found[2])
        if language is None:
            continue
        line = whole.count("\n", 0, found.start(3)) + 1
        name = f"{page.relative_to(ROOT).as_posix()}:{line}"
        text = re.sub(f"^{found[1]}", "", found[3], flags=re.MULTILINE)
        yield Written(name, language, text, page, found.start(3), found[1])
