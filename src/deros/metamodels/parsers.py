"""The textX metamodel of each language, built once per process from its grammar."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any

from arpeggio import ParsingExpression, RegExMatch
from textx import metamodel_from_file

from deros.metamodels.grammar import expressions, words_after
from deros.metamodels.languages import Language
from deros.metamodels.matching import Parser
from deros.metamodels.objects import Objects
from deros.metamodels.scoping import SCOPE_PROVIDERS

_KEYWORDS = "KEYWORDS"
"""Stands in the grammar for the keywords that may come after a number."""

_INCH = "in"


@functools.cache
def metamodel(language: Language) -> Any:
    """Return the textX metamodel of a language for textX and tools built on it.

    Where a model names an element of another file, it holds a
    :class:`~deros.metamodels.scoping.Reference`.
    """
    result = metamodel_from_file(
        str(language.grammar_file), auto_init_attributes=False, autokwd=True
    )
    result.register_scope_providers(dict(SCOPE_PROVIDERS))
    _tell_units_from_keywords(result._parser_blueprint.parser_model)
    return result


def _tell_units_from_keywords(grammar: ParsingExpression) -> None:
    """Have no keyword that may come after a number be taken for its unit."""
    for token in expressions(grammar):
        if isinstance(token, RegExMatch) and _KEYWORDS in token.to_match:
            words = [word for word in words_after(grammar, token) if word != _INCH]
            token.to_match = token.to_match.replace(_KEYWORDS, "|".join(words))
            token.to_match_regex = token.to_match
            token.compile()


@functools.cache
def grammar(language: Language) -> ParsingExpression:
    """Return the parser expression of a whole text of a language, without its end."""
    return metamodel(language)._parser_blueprint.parser_model


@functools.cache
def _parser(language: Language) -> Parser:
    return Parser(grammar(language))


@functools.cache
def _objects(language: Language) -> Objects:
    return Objects(grammar(language))


def parse_tree(language: Language, text: str) -> Any:
    """Return the parse tree of prepared text, see :func:`deros.metamodels.reading.prepare`.

    Raises:
        DoesNotParse: the text has a syntax error.
    """
    return _parser(language).parse(text)


def read_model(
    language: Language, text: str, before_references: Callable[[Any], None] | None = None
) -> Any:
    """Return the textX model of prepared text, as the loader uses it.

    The attribute values in it are :class:`~deros.metamodels.matching.Token` objects, which carry
    their position; textX itself keeps the positions of objects only.

    Args:
        language: of the text.
        text: without comments, see :func:`deros.metamodels.reading.prepare`.
        before_references: called with the model before its references are resolved.

    Raises:
        DoesNotParse: the text has a syntax error.
    """
    return _objects(language).model(parse_tree(language, text), before_references)
