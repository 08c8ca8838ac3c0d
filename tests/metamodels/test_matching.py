"""The quick matchers against Arpeggio: the same tree, or the same refusal."""

from __future__ import annotations

from typing import Any

import pytest
from arpeggio import NonTerminal, Not, StrMatch
from hypothesis import given, settings
from textx.exceptions import TextXSyntaxError

from deros.diagnostics import SourceFile
from deros.metamodels.languages import LANGUAGES, Language, metamodel, quick_metamodel
from deros.metamodels.matching import make_quick
from deros.metamodels.reading import Unreadable, prepare
from tests.support.mutations import TEXTS, mutated


def _tree(node: Any) -> Any:
    """Write a parse tree as nested tuples of rule, place and text."""
    if isinstance(node, NonTerminal):
        return (node.rule_name, node.position, node.position_end, [_tree(child) for child in node])
    return (node.rule_name, node.position, node.position_end, str(node.value))


def _parse(model: Any, text: str) -> Any:
    """Return the parse tree, or where parsing fails and what was expected there."""
    parser = model._parser_blueprint.clone()
    parser.comments_model = None
    try:
        return _tree(parser.parse(text))
    except TextXSyntaxError as error:
        return (error.line, error.col, [rule.rule_name for rule in error.expected_rules])


def _same(language: Language, text: str) -> None:
    try:
        prepared = prepare(SourceFile("text", text))
    except Unreadable:
        return
    assert _parse(quick_metamodel(language), prepared) == _parse(metamodel(language), prepared)


@pytest.mark.parametrize(
    ("suffix", "text"), [(suffix, text) for suffix, texts in TEXTS.items() for text in texts]
)
def test_listings_give_the_same_tree(suffix: str, text: str) -> None:
    """Every sound text has one and the same parse tree both ways."""
    tree = _parse(quick_metamodel(LANGUAGES[f".{suffix}"]), prepare(SourceFile("text", text)))
    assert tree[1] == 0 or tree[0] == "Model"
    _same(LANGUAGES[f".{suffix}"], text)


@settings(max_examples=200, deadline=None)
@given(mutated())
def test_mutated_listings_agree(case: tuple[str, str]) -> None:
    """Sound or not, a text is judged the same both ways."""
    suffix, text = case
    _same(LANGUAGES[f".{suffix}"], text)


def test_an_expression_without_a_matcher_is_refused() -> None:
    """A grammar that comes to use another kind of expression fails when it is built."""
    model = metamodel.__wrapped__("rosnode")
    model._parser_blueprint.parser_model.nodes.append(Not(StrMatch("x")))
    with pytest.raises(TypeError, match="Not"):
        make_quick(model)
