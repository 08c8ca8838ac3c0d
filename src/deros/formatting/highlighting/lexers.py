"""Lexers for Pygments: entry points of this package, so that MkDocs and Sphinx colour models.

Pygments is no dependency: it is what loads this module.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

from pygments import token as tokens
from pygments.lexer import RegexLexer, bygroups

from deros.formatting.highlighting.patterns import Kind, patterns
from deros.metamodels.languages import DEROS, ROSNODE, ROSSYSTEM, Language

_TOKENS: Mapping[Kind, Any] = {
    Kind.COMMENT: tokens.Comment,
    Kind.TEXT: tokens.String,
    Kind.ARGUMENT: tokens.Name.Variable,
    Kind.NAME: tokens.Name.Namespace,
    Kind.NUMBER: tokens.Number,
    Kind.BLANK: tokens.Whitespace,
    Kind.UNIT: tokens.Keyword.Type,
    Kind.CONSTANT: tokens.Keyword.Constant,
    Kind.OPENING: tokens.Keyword.Declaration,
    Kind.WORD: tokens.Keyword,
    Kind.SIGN: tokens.Operator,
}


class ModelLexer(RegexLexer):  # type: ignore[misc]
    """A lexer whose rules are made from the grammar of its language when a text is first read."""

    language: ClassVar[Language]

    @classmethod
    def get_tokendefs(cls) -> dict[str, list[tuple[str, Any]]]:
        """Return the rules, as Pygments asks for them."""
        rules = [(each.regex, _action(each.kinds)) for each in patterns(cls.language)]
        rest = [
            (r"\s+", tokens.Whitespace),
            (r"[\w.~/]+", tokens.Name),
            (r".", tokens.Punctuation),
        ]
        return {"root": [*rules, *rest]}


def _action(kinds: tuple[Kind, ...]) -> Any:
    found = [_TOKENS[each] for each in kinds]
    return found[0] if len(found) == 1 else bygroups(*found)


class NodeLexer(ModelLexer):
    """Node descriptions, ``*.rnd``."""

    language = ROSNODE
    name = "deros node description"
    aliases: ClassVar = [ROSNODE.name]
    filenames: ClassVar = [ROSNODE.pattern]


class SystemLexer(ModelLexer):
    """System descriptions, ``*.system``."""

    language = ROSSYSTEM
    name = "deros system description"
    aliases: ClassVar = [ROSSYSTEM.name]
    filenames: ClassVar = [ROSSYSTEM.pattern]


class RulesLexer(ModelLexer):
    """Safety rules, ``*.deros``."""

    language = DEROS
    name = "DeRoS safety rules"
    aliases: ClassVar = [DEROS.name]
    filenames: ClassVar = [DEROS.pattern]
