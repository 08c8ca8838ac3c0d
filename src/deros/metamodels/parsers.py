"""The textX metamodel of each language, built once per process from its grammar."""

from __future__ import annotations

import functools
from typing import Any

from arpeggio import ParsingExpression, RegExMatch
from textx import metamodel_from_file

from deros.metamodels.grammar import expressions, words_after
from deros.metamodels.languages import Language
from deros.metamodels.matching import install_fast_parser
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
def fast_metamodel(language: Language) -> Any:
    """Return the metamodel that the loader uses; its parser is fast and takes prepared text.

    The attribute values in its models are :class:`~deros.metamodels.matching.Token` objects, which
    carry their position; textX itself keeps the positions of objects only.
    """
    result = metamodel.__wrapped__(language)
    result._parser_blueprint.comments_model = None
    install_fast_parser(result)
    return result
