"""The textX metamodels behind the loader, as textX itself and other tools see them."""

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


def test_suffixes() -> None:
    """Each suffix belongs to one language, whatever stands before it."""
    assert language_of("a/b.rnd") == "rosnode"
    assert language_of("a.b.system") == "rossystem"
    assert language_of("x.deros") == "deros"
    assert language_of("x.txt") is None


@pytest.mark.parametrize("language", LANGUAGES.values())
def test_a_metamodel_is_built_once(language: Language) -> None:
    """Asking twice gives the same metamodel."""
    assert metamodel(language) is metamodel(language)


def test_textx_parses_comments_and_all() -> None:
    """Used by textX alone, a metamodel takes a text with its comments."""
    model = metamodel("rosnode").model_from_str(f"// first\n{paper.FIGURE_11}/* last */")
    assert model.name == "ci_safety_node"
    parameters = get_children_of_type("Parameter", model)
    assert [each.name for each in parameters] == [
        "time_update_freq",
        "publish_freq",
        "upside_down",
    ]


def test_tokens_know_their_place() -> None:
    """In the loader's models, attribute values are texts with an offset."""
    text = "node  a : p publishes topic /x : std_msgs.Bool"
    model = quick_metamodel("rosnode").model_from_str(text)
    (port,) = get_children_of_type("TopicPort", model)
    for token in (model.name, model.package, port.name, port.type):
        assert isinstance(token, Token)
        assert text[token.start : token.end] == token


def test_references_without_imports_resolve_to_nothing() -> None:
    """A name that textX cannot follow is a reference without a target, not an error."""
    model = metamodel("rossystem").model_from_str("system S node a : camera")
    (node,) = get_children_of_type("NodeInstance", model)
    assert isinstance(node.type, Reference)
    assert (node.type.name, node.type.target) == ("camera", None)


def test_textx_reports_the_same_place() -> None:
    """The loader's syntax errors stand where textX's own do."""
    text = "node a : p\nparameters // none\n  name x double"
    with pytest.raises(TextXSyntaxError) as raised:
        metamodel("rosnode").model_from_str(text)
    (found,) = Repository().load_text("a.rnd", text).diagnostics
    assert (found.span.line, found.span.column) == (raised.value.line, raised.value.col)


@pytest.mark.parametrize("language", LANGUAGES.values())
def test_every_token_has_words(language: Language) -> None:
    """Whatever a syntax error may name is named in words or as the keyword itself."""
    for rule in _parser_rules(language):
        if isinstance(rule, Match) and not isinstance(rule, StrMatch):
            words = in_words(rule)
            assert not set("\\^$|?*+") & set(words), rule.rule_name


def test_loading_is_linear(tmp_path: Path) -> None:
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
