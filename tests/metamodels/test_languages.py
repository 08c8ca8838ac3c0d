"""The textX metamodels behind the loader, as used by textX itself and other tools."""

from __future__ import annotations

import re
from importlib.metadata import Distribution
from pathlib import Path
from typing import Any

import networkx as nx
import pytest
from arpeggio import Match, Sequence, StrMatch
from textx import get_children_of_type
from textx.exceptions import TextXSyntaxError

from benchmarks.big_system import write
from deros.metamodels.grammar import expressions, words_after
from deros.metamodels.languages import (
    DEROS,
    LANGUAGES,
    ROSNODE,
    ROSSYSTEM,
    Language,
    entry_point,
    language_of,
)
from deros.metamodels.load import Repository
from deros.metamodels.matching import Token
from deros.metamodels.parsers import grammar, metamodel, read_model
from deros.metamodels.recovery.syntax import in_words
from deros.metamodels.scoping import Reference
from tests.support import paper
from tests.support.work import calls


def test_language_follows_from_the_suffix() -> None:
    """Each suffix belongs to one language."""
    assert language_of("a/b.rnd") is ROSNODE
    assert language_of("a.b.system") is ROSSYSTEM
    assert language_of("x.deros") is DEROS
    assert language_of("x.txt") is None


def test_textx_entry_points_match_the_languages() -> None:
    """The distribution registers each language under its name, and no other."""
    points = Distribution.from_name("deros").entry_points.select(group="textx_languages")
    described = {point.name: point.load() for point in points}
    assert sorted(described) == sorted(each.name for each in LANGUAGES)
    for language in LANGUAGES:
        description = described[language.name]
        assert description.name == language.name
        assert description.pattern == f"*{language.suffix}"


@pytest.mark.parametrize("language", LANGUAGES, ids=lambda each: each.name)
def test_every_part_of_a_declaration_exists(language: Language) -> None:
    """The grammar is a file, and each entry point of a declaration can be imported."""
    assert language.grammar_file.is_file()
    assert callable(entry_point(language.loader))
    assert callable(entry_point(language.checks))
    assert next(iter(entry_point(language.scaffold))) == f"$name{language.suffix}"


def test_names_suffixes_and_kinds_are_unique() -> None:
    """No two languages share a name, a suffix or the word for ``deros new``."""
    for values in zip(
        *((language.name, language.suffix, language.kind) for language in LANGUAGES), strict=True
    ):
        assert len(set(values)) == len(LANGUAGES)


@pytest.mark.parametrize("language", LANGUAGES)
def test_metamodel_is_built_once(language: Language) -> None:
    """A second call returns the same metamodel."""
    assert metamodel(language) is metamodel(language)


def test_textx_metamodel_accepts_comments() -> None:
    """The metamodel alone parses a text with comments."""
    model = metamodel(ROSNODE).model_from_str(f"// first\n{paper.FIGURE_11}/* last */")
    assert model.name == "ci_safety_node"
    parameters = get_children_of_type("Parameter", model)
    assert [parameter.name for parameter in parameters] == [
        "time_update_freq",
        "publish_freq",
        "upside_down",
    ]


def test_tokens_have_offsets() -> None:
    """Attribute values in the loader's models are strings with an offset."""
    text = "node  a : p publishes topic /x : std_msgs.Bool"
    model = read_model(ROSNODE, text)
    (port,) = get_children_of_type("TopicPort", model)
    for token in (model.name, model.package, port.name, port.type):
        assert isinstance(token, Token)
        assert text[token.start : token.end] == token


def test_unresolved_reference_has_no_target() -> None:
    """A name that textX cannot resolve is a reference without a target, not an error."""
    model = metamodel(ROSSYSTEM).model_from_str("system S node a : camera")
    (node,) = get_children_of_type("NodeInstance", model)
    assert isinstance(node.type, Reference)
    assert (node.type.name, node.type.target) == ("camera", None)


def test_syntax_error_position_matches_textx() -> None:
    """The loader reports syntax errors where textX does."""
    text = "node a : p\nparameters // none\n  name x double"
    with pytest.raises(TextXSyntaxError) as raised:
        metamodel(ROSNODE).model_from_str(text)
    (finding,) = Repository().load_text("a.rnd", text).diagnostics
    assert (finding.span.line, finding.span.column) == (raised.value.line, raised.value.col)


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_token_has_a_readable_name(language: Language) -> None:
    """Syntax errors name tokens in words or as the keyword itself, not as a pattern."""
    for rule in expressions(grammar(language)):
        if isinstance(rule, Match) and not isinstance(rule, StrMatch):
            words = in_words(rule)
            assert not re.search(r"[\\^|?*+]|\$(?!\w)", words), rule.rule_name


def test_work_of_loading_is_linear(tmp_path: Path) -> None:
    """Eight times the nodes are about eight times the work."""

    def work(nodes: int) -> int:
        folder = tmp_path / str(nodes)
        folder.mkdir()
        path = write(folder, nodes)
        assert Repository().load(path).diagnostics == ()  # and what is done once
        return calls(lambda: Repository().load(path))

    assert work(1200) < 9 * work(150)


@pytest.mark.parametrize(
    "text",
    [
        "node n : p subscribes topic a : std_msgs.Bool qos deadline 5 topic b : std_msgs.Bool",
        "node n : p timers timer t every 20 services service s : std_srvs.Trigger",
        "node n : p timers timer t every 20 subscribes topic a : std_msgs.Bool",
        "system S topics topic /a : std_msgs.Bool qos lifespan 5 external topic /b : std_msgs.Bool",
    ],
)
def test_keyword_after_a_number_is_no_unit(text: str) -> None:
    """A forgotten unit is one finding at the number, whatever statement comes next."""
    name = "a.system" if text.startswith("system") else "a.rnd"
    (finding,) = Repository().load_text(name, text).diagnostics
    assert finding.message == "a duration needs a unit"


def test_words_that_may_come_after_a_number_follow_from_the_grammar() -> None:
    """An inch is a unit, a minute is one, and a statement of another language is no keyword."""
    words = {}
    for language in LANGUAGES:
        grammar = metamodel(language)._parser_blueprint.parser_model
        (token,) = (each for each in expressions(grammar) if each.rule_name == "UnitText")
        words[language] = words_after(grammar, token)
    assert {"topic", "service", "timer"} <= {*words[ROSNODE]}
    assert {"external", "node", "safety"} <= {*words[ROSSYSTEM]}
    assert {"and", "in", "since", "failsafe", "until"} <= {*words[DEROS]}
    assert not {"min", "topic", "node"} & {*words[DEROS]}


def test_what_nests_without_brackets_is_known() -> None:
    """Only ``not``, signs and ``if`` do: they are limited before parsing, as brackets are."""
    chains = {
        name
        for language in LANGUAGES
        for cycle in nx.strongly_connected_components(_without_brackets(language))
        if len(cycle) > 1
        for rule in cycle
        if not (name := rule.rule_name).startswith("__") and name
    }
    assert chains == {"ConditionPart", "Factor", "Opposite", "Expression"}


def _without_brackets(language: Language) -> nx.DiGraph[Any]:
    """Return which expressions are directly inside of which, without a bracket around them."""
    graph: nx.DiGraph[Any] = nx.DiGraph()
    for rule in expressions(grammar(language)):
        is_inside = False
        for part in rule.nodes:
            if isinstance(rule, Sequence) and isinstance(part, StrMatch):
                is_inside = part.to_match in "({[" or (is_inside and part.to_match not in ")}]")
            if not is_inside:
                graph.add_edge(rule, part)
    return graph
