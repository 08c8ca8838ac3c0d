"""The models made from parse trees, against those that textX makes itself."""

from __future__ import annotations

from typing import Any

import pytest
from arpeggio import ParsingExpression
from hypothesis import given, settings
from textx import metamodel_from_str
from textx.exceptions import TextXSyntaxError

from deros.diagnostics import SourceFile
from deros.metamodels.languages import LANGUAGES, Language
from deros.metamodels.matching import DoesNotParse
from deros.metamodels.objects import Objects
from deros.metamodels.parsers import metamodel, read_model
from deros.metamodels.reading import Unreadable, prepare
from deros.metamodels.scoping import Reference
from tests.support.mutations import TEXTS, mutated
from tests.support.profiles import scaled

_BY_SUFFIX = {language.suffix.removeprefix("."): language for language in LANGUAGES}
_POSITIONS = ("_tx_position", "_tx_position_end")


def _plain(value: Any, parent: Any = None) -> Any:
    """Return a model as nested tuples of classes, positions and attributes."""
    if isinstance(value, list):
        return [_plain(each, parent) for each in value]
    if isinstance(value, Reference):
        return ("reference", str(value.name), value.candidates)
    attributes = getattr(type(value), "_tx_attrs", None)
    if attributes is None:
        return value
    assert getattr(value, "parent", None) is parent
    places = [getattr(value, name) for name in _POSITIONS]
    inside = {name: _plain(getattr(value, name), value) for name in attributes}
    return (type(value).__name__, places, inside)


def _same(language: Language, text: str) -> bool:
    """Compare both models of a text; return whether there are any."""
    try:
        prepared = prepare(SourceFile("text", text))
        expected = metamodel(language).model_from_str(prepared)
    except (Unreadable, TextXSyntaxError):
        with pytest.raises((Unreadable, DoesNotParse)):
            read_model(language, prepare(SourceFile("text", text)))
        return False
    assert _plain(read_model(language, prepared)) == _plain(expected)
    return True


@pytest.mark.parametrize(
    ("suffix", "text"), [(suffix, text) for suffix, texts in TEXTS.items() for text in texts]
)
def test_models_are_those_of_textx(suffix: str, text: str) -> None:
    """Classes, attributes, positions, parents and references are the same."""
    assert _same(_BY_SUFFIX[suffix], text)


@settings(max_examples=scaled(100))
@given(mutated())
def test_mutated_texts_give_the_models_of_textx(case: tuple[str, str]) -> None:
    """A text that still parses after an edit has the model that textX makes of it."""
    suffix, text = case
    _same(_BY_SUFFIX[suffix], text)


def _grammar(text: str) -> ParsingExpression:
    return metamodel_from_str(text)._parser_blueprint.parser_model


@pytest.mark.parametrize(
    ("grammar", "reason"),
    [
        ("M: 'm' number=INT;", "base type INT"),
        ("M: 'm' name=N other=[M:N]; N: /[a-z]+/;", "references of M"),
    ],
)
def test_what_no_grammar_needs_is_refused(grammar: str, reason: str) -> None:
    """A grammar that uses more of textX fails when its functions are made."""
    with pytest.raises(TypeError, match=reason):
        Objects(_grammar(grammar))
