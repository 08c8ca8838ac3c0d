"""The textX metamodels of the three languages, each built once per process.

The grammars (``*.tx`` beside this file) are the languages. What is changed on the way to a parser
is how a token is handed over: as a :class:`Token`, a text that knows its place. textX itself keeps
the positions of objects only, and a grammar with an object for each name would be far slower.
"""

from __future__ import annotations

import functools
from pathlib import Path
from typing import Any, Literal

from arpeggio import ParsingExpression, RegExMatch, Terminal
from textx import metamodel_from_file

from deros.metamodels.scoping import SCOPE_PROVIDERS

Language = Literal["rosnode", "rossystem", "deros"]

LANGUAGES: dict[str, Language] = {".rnd": "rosnode", ".system": "rossystem", ".deros": "deros"}
"""The language of a file, by the suffix of its name."""


class Token(str):
    """A piece of a model's text; ``start`` is the offset of its first character."""

    __slots__ = ("start",)
    start: int

    @property
    def end(self) -> int:
        """The offset just past the last character."""
        return self.start + len(self)


class _TokenMatch(RegExMatch):  # type: ignore[misc]
    """A regular expression of the grammar that yields a :class:`Token`."""

    def _parse(self, parser: Any) -> Terminal | None:
        position = parser.position
        found = self.regex.match(parser.input, position)
        if found is None:
            parser._nm_raise(self, position, parser)
            return None
        token = Token(found.group())
        token.start = position
        parser.position = found.end()
        return Terminal(self, position, token, extra_info=found)


def language_of(path: str) -> Language | None:
    """Return the language that a file's suffix stands for, or ``None``."""
    return LANGUAGES.get(Path(path).suffix)


@functools.cache
def metamodel(language: Language) -> Any:
    """Return the textX metamodel of a language.

    Its models hold :class:`Token` objects as attribute values, and a
    :class:`~deros.metamodels.scoping.Reference` where a model names an element of another file.
    """
    result = metamodel_from_file(
        str(Path(__file__).with_name(f"{language}.tx")), auto_init_attributes=False, autokwd=True
    )
    result.register_scope_providers(dict(SCOPE_PROVIDERS))
    _yield_tokens(result._parser_blueprint.parser_model)
    return result


@functools.cache
def quick_metamodel(language: Language) -> Any:
    """Return a metamodel that takes no comments, for text whose comments are blanked out already.

    To look for a comment before every token takes a third of the whole time of parsing.
    """
    result = metamodel.__wrapped__(language)
    result._parser_blueprint.comments_model = None
    return result


def _yield_tokens(root: ParsingExpression) -> None:
    seen = {id(root)}
    pending: list[ParsingExpression] = [root]
    while pending:
        expression = pending.pop()
        if type(expression) is RegExMatch:
            expression.__class__ = _TokenMatch
        separator = getattr(expression, "sep", None)
        children = expression.nodes if separator is None else [*expression.nodes, separator]
        for child in children:
            if id(child) not in seen and isinstance(child, ParsingExpression):
                seen.add(id(child))
                pending.append(child)
