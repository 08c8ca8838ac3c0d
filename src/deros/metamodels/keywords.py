"""The words of a language that name nothing in its texts."""

from __future__ import annotations

import functools

from deros.metamodels.grammar import expressions, first_tokens, is_statement, words_of
from deros.metamodels.languages import Language
from deros.metamodels.parsers import grammar

_VALUES = frozenset({"LiteralText", "Scalar"})
"""The rules of values that are written as one token."""


@functools.cache
def keywords(language: Language) -> frozenset[str]:
    """Return all words that its grammar has; some of them may be names in some places."""
    words = (word for each in expressions(grammar(language)) for word in words_of(each))
    return frozenset(word for word in words if word.isidentifier())


@functools.cache
def opening_words(language: Language) -> frozenset[str]:
    """Return the keywords with which statements and sections begin."""
    statements = (each for each in expressions(grammar(language)) if is_statement(each))
    tokens = (token for each in statements for token in first_tokens(each))
    return frozenset(word for token in tokens for word in words_of(token)) & keywords(language)


@functools.cache
def constant_words(language: Language) -> frozenset[str]:
    """Return the keywords that are values, ``true`` and ``inf``."""
    values = (each for each in expressions(grammar(language)) if each.rule_name in _VALUES)
    return frozenset(word for each in values for word in words_of(each)) & keywords(language)
