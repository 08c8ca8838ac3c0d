"""Write the TextMate grammars of the languages, which editors colour models by.

They are made from the grammars of the languages: ``python -m tools.textmate`` after a change.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from deros.formatting.highlighting.patterns import Kind, Pattern, patterns
from deros.metamodels.languages import LANGUAGES, Language

FOLDER = Path(__file__).resolve().parent.parent / "editors" / "vscode" / "syntaxes"

_SCOPES: Mapping[Kind, str] = {
    Kind.COMMENT: "comment",
    Kind.TEXT: "string.quoted.double",
    Kind.ARGUMENT: "variable.parameter",
    Kind.NAME: "entity.name.namespace",
    Kind.NUMBER: "constant.numeric",
    Kind.UNIT: "keyword.other.unit",
    Kind.CONSTANT: "constant.language",
    Kind.OPENING: "keyword.declaration",
    Kind.WORD: "keyword.control",
    Kind.SIGN: "keyword.operator",
}
"""The names by which themes give colours: https://macromates.com/manual/en/language_grammars."""


def grammars() -> dict[str, str]:
    """Return the grammars by the names of their files."""
    return {
        f"{each.name}.tmLanguage.json": json.dumps(_grammar(each), indent=2, ensure_ascii=False)
        + "\n"
        for each in LANGUAGES
    }


def _grammar(language: Language) -> dict[str, Any]:
    return {
        "$schema": "https://raw.githubusercontent.com/martinring/tmlanguage/master/tmlanguage.json",
        "name": language.title,
        "scopeName": f"source.{language.name}",
        "fileTypes": [language.suffix.removeprefix(".")],
        "patterns": [rule for each in patterns(language) for rule in _rules(each, language)],
    }


def _rules(pattern: Pattern, language: Language) -> list[dict[str, Any]]:
    """Return the rules for a pattern; a comment of several lines needs a beginning and an end."""
    if pattern.kinds == (Kind.COMMENT,):
        line, block = (f"comment.{kind}.{language.name}" for kind in ("line", "block"))
        return [
            {"name": line, "match": "//.*$"},
            {"name": block, "begin": r"/\*", "end": r"\*/"},
        ]
    names = {
        str(group): f"{_SCOPES[kind]}.{language.name}"
        for group, kind in enumerate(pattern.kinds, start=1)
        if kind in _SCOPES
    }
    if len(pattern.kinds) == 1:
        return [{"name": names["1"], "match": pattern.regex}]
    captures = {group: {"name": name} for group, name in names.items()}
    return [{"match": pattern.regex, "captures": captures}]


def main() -> None:
    """Write all grammars."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    for name, text in grammars().items():
        (FOLDER / name).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
