"""The textX metamodels behind the loader, as used by textX itself and other tools."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any

import pytest
from arpeggio import Match, StrMatch
from textx import get_children_of_type
from textx.exceptions import TextXSyntaxError

from benchmarks.big_system import write
from deros.metamodels.languages import (
    LANGUAGES,
    Language,
    language_of,
    metamodel,
    quick_metamodel,
)
from deros.metamodels.load import Repository
from deros.metamodels.matching import Token
from deros.metamodels.scoping import Reference
from deros.metamodels.syntax import in_words
from tests.support import paper


def _parser_rules(language: Language) -> list[Any]:
    """Return every expression of the language's parser."""
    found: dict[int, Any] = {}
    pending = [metamodel(language)._parser_blueprint.parser_model]
    while pending:
        rule = pending.pop()
        if id(rule) not in found:
            found[id(rule)] = rule
            pending += rule.nodes
    return list(found.values())


def test_language_follows_from_the_suffix() -> None:
    """Each suffix belongs to one language."""
    assert language_of("a/b.rnd") == "rosnode"
    assert language_of("a.b.system") == "rossystem"
    assert language_of("x.deros") == "deros"
    assert language_of("x.txt") is None


@pytest.mark.parametrize("language", LANGUAGES.values())
def test_metamodel_is_built_once(language: Language) -> None:
    """A second call returns the same metamodel."""
    assert metamodel(language) is metamodel(language)


def test_textx_metamodel_accepts_comments() -> None:
    """The metamodel alone parses a text with comments."""
    model = metamodel("rosnode").model_from_str(f"// first\n{paper.FIGURE_11}/* last */")
    assert model.name == "ci_safety_node"
    parameters = get_children_of_type("Parameter", model)
    assert [each.name for each in parameters] == [
        "time_update_freq",
        "publish_freq",
        "upside_down",
    ]


def test_tokens_have_offsets() -> None:
    """Attribute values in the loader's models are strings with an offset."""
    text = "node  a : p publishes topic /x : std_msgs.Bool"
    model = quick_metamodel("rosnode").model_from_str(text)
    (port,) = get_children_of_type("TopicPort", model)
    for token in (model.name, model.package, port.name, port.type):
        assert isinstance(token, Token)
        assert text[token.start : token.end] == token


def test_unresolved_reference_has_no_target() -> None:
    """A name that textX cannot resolve is a reference without a target, not an error."""
    model = metamodel("rossystem").model_from_str("system S node a : camera")
    (node,) = get_children_of_type("NodeInstance", model)
    assert isinstance(node.type, Reference)
    assert (node.type.name, node.type.target) == ("camera", None)


def test_syntax_error_position_matches_textx() -> None:
    """The loader reports syntax errors where textX does."""
    text = "node a : p\nparameters // none\n  name x double"
    with pytest.raises(TextXSyntaxError) as raised:
        metamodel("rosnode").model_from_str(text)
    (found,) = Repository().load_text("a.rnd", text).diagnostics
    assert (found.span.line, found.span.column) == (raised.value.line, raised.value.col)


@pytest.mark.parametrize("language", LANGUAGES.values())
def test_every_token_has_a_readable_name(language: Language) -> None:
    """Syntax errors name tokens in words or as the keyword itself, not as a pattern."""
    for rule in _parser_rules(language):
        if isinstance(rule, Match) and not isinstance(rule, StrMatch):
            words = in_words(rule)
            assert not set("\\^$|?*+") & set(words), rule.rule_name


def test_load_time_is_linear(tmp_path: Path) -> None:
    """Eight times the nodes take about eight times as long."""
    seconds = []
    for nodes in (150, 1200):
        folder = tmp_path / str(nodes)
        folder.mkdir()
        path = write(folder, nodes)
        start = time.process_time()
        loaded = Repository().load(path)
        seconds.append(time.process_time() - start)
        assert loaded.diagnostics == ()
    assert seconds[1] < 16 * seconds[0]
