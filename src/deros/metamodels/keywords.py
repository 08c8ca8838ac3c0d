"""The words of a language that name nothing in its texts."""

from __future__ import annotations

import functools

from deros.metamodels.grammar import expressions, words_of
from deros.metamodels.languages import Language
from deros.metamodels.parsers import fast_metamodel


@functools.cache
def keywords(language: Language) -> frozenset[str]:
    """Return all words that its grammar has; some of them may be names in some places."""
    grammar = fast_metamodel(language)._parser_blueprint.parser_model
    words = (word for each in expressions(grammar) for word in words_of(each))
    return frozenset(word for word in words if word.isidentifier())
