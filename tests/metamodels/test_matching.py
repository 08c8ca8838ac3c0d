"""The fast matchers against Arpeggio: the same tree, or the same error."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import pytest
from arpeggio import Match, NonTerminal, Not, Optional, OrderedChoice, StrMatch, ZeroOrMore
from hypothesis import example, given, settings
from textx.exceptions import TextXSyntaxError

from deros.diagnostics import SourceFile
from deros.metamodels.languages import LANGUAGES, ROSNODE, Language
from deros.metamodels.matching import DoesNotParse, Parser
from deros.metamodels.parsers import metamodel, parse_tree
from deros.metamodels.reading import Unreadable, prepare
from deros.metamodels.recovery.recovery import recogniser
from tests.support.mutations import TEXTS, mutated
from tests.support.profiles import scaled

_BY_SUFFIX = {language.suffix.removeprefix("."): language for language in LANGUAGES}


def _tree(node: Any) -> Any:
    """Return a parse tree as nested tuples of rule, position and text."""
    if isinstance(node, NonTerminal):
        return (node.rule_name, node.position, node.position_end, [_tree(child) for child in node])
    return (node.rule_name, node.position, node.position_end, str(node.value))


def _parse(language: Language, text: str) -> Any:
    """Return the parse tree, or the position of the error and the expected tokens."""
    parser = metamodel(language)._parser_blueprint.clone()
    parser.comments_model = None
    try:
        return _tree(parser.parse(text))
    except TextXSyntaxError as error:
        return (error.line, error.col, _distinct(error.expected_rules))


def _parse_quickly(language: Language, text: str) -> Any:
    """Return the result of the matchers, or of the recogniser where they fail."""
    try:
        return _tree(parse_tree(language, text))
    except DoesNotParse:
        pass
    steps = recogniser(language)
    steps.forget()
    assert not steps.run(text)
    trace = steps.trace
    line, column = SourceFile("text", text).line_column(trace.position)
    return (line, column, _distinct(trace.expected))


def _distinct(expected: Iterable[Any]) -> list[tuple[str, str]]:
    """Return the expected tokens in order, each once.

    Arpeggio visits a position again for another alternative; the recogniser remembers it.
    """
    return list(dict.fromkeys((rule.rule_name, getattr(rule, "to_match", "")) for rule in expected))


def _same(language: Language, text: str) -> None:
    try:
        prepared = prepare(SourceFile("text", text))
    except Unreadable:
        return
    assert _parse_quickly(language, prepared) == _parse(language, prepared)


@pytest.mark.parametrize(
    ("suffix", "text"), [(suffix, text) for suffix, texts in TEXTS.items() for text in texts]
)
def test_listings_give_the_same_tree(suffix: str, text: str) -> None:
    """Every sound text has the same parse tree with both parsers."""
    tree = _parse_quickly(_BY_SUFFIX[suffix], prepare(SourceFile("text", text)))
    assert tree[1] == 0 or tree[0] == "Model"
    _same(_BY_SUFFIX[suffix], text)


@settings(max_examples=scaled(200))
@example(("system", "system S node n : a respawn elay 1 sec"))
@example(("deros", "behaviour b: if e.r then { s; }; optional behaviour c: if e.r then { s"))
@given(mutated())
def test_mutated_listings_give_the_same_result(case: tuple[str, str]) -> None:
    """Sound or broken, a text has the same result with both parsers."""
    suffix, text = case
    _same(_BY_SUFFIX[suffix], text)


@pytest.mark.parametrize("language", LANGUAGES, ids=lambda each: each.name)
def test_no_alternative_may_be_empty(language: Language) -> None:
    """Arpeggio takes an alternative that matches without a word for one that does not match."""
    found = [metamodel(language)._parser_blueprint.parser_model]
    seen = set()
    while found:
        expression = found.pop()
        if id(expression) not in seen:
            seen.add(id(expression))
            found += getattr(expression, "nodes", None) or []
            if isinstance(expression, OrderedChoice):
                assert not any(map(_may_be_empty, expression.nodes)), expression.desc


def _may_be_empty(expression: Any) -> bool:
    """Return whether an expression matches without a word; rules do not begin with themselves."""
    if isinstance(expression, Optional | ZeroOrMore):
        return True
    if isinstance(expression, OrderedChoice):
        return any(map(_may_be_empty, expression.nodes))
    return not isinstance(expression, Match) and all(map(_may_be_empty, expression.nodes))


def test_expression_without_a_matcher_is_rejected() -> None:
    """A grammar that uses a new kind of expression fails when it is built."""
    model = metamodel.__wrapped__(ROSNODE)
    grammar = model._parser_blueprint.parser_model
    grammar.nodes.append(Not(StrMatch("x")))
    with pytest.raises(TypeError, match="Not"):
        Parser(grammar)
