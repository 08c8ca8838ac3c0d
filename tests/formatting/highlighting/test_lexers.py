"""Colours: what the highlighters take the parts of models for."""

from __future__ import annotations

import re
import subprocess
import sys

import pytest
from pygments.lexer import Lexer
from pygments.token import Comment, Error, Keyword, Name, Number, Operator, String, _TokenType

from deros.formatting.highlighting.lexers import NodeLexer, RulesLexer, SystemLexer
from deros.formatting.highlighting.patterns import Kind, patterns
from deros.metamodels.keywords import constant_words, keywords, opening_words
from deros.metamodels.languages import DEROS, LANGUAGES, ROSNODE, ROSSYSTEM, Language
from tests.support.written_models import Written, examples, snippets
from tools.textmate import FOLDER, grammars

LEXERS: dict[str, type[Lexer]] = {
    "rosnode": NodeLexer,
    "rossystem": SystemLexer,
    "deros": RulesLexer,
}


def _coloured(text: str, language: Language) -> dict[str, _TokenType]:
    lexer = LEXERS[language.name]()
    return {value: of for of, value in lexer.get_tokens(text) if value.strip()}


@pytest.mark.parametrize("written", [*examples(), *snippets()], ids=str)
def test_every_text_is_read_as_a_whole(written: Written) -> None:
    """Nothing is lost, and nothing is an error."""
    found = list(LEXERS[written.language.name](stripnl=False).get_tokens(written.text))
    assert "".join(value for _, value in found).rstrip("\n") == written.text.rstrip("\n")
    assert not [value for of, value in found if of is Error]


def test_rules_are_coloured() -> None:
    """A division is no topic, and what follows a number is a unit only if it is no keyword."""
    found = _coloured(
        "// [R1]\nconst half = 1.5 m/s / 2\ninput speed = topic /odom.twist timeout 0.5 sec\n"
        'entity e { fast: speed > 2 and true for 3 min; }\ngate /a -> /b : x "so"\n',
        DEROS,
    )
    assert found["// [R1]"] is Comment
    assert found["const"] is found["input"] is found["entity"] is Keyword.Declaration
    assert found["m/s"] is found["sec"] is found["min"] is Keyword.Type
    assert found["1.5"] is found["2"] is Number
    assert found["/"] is found["->"] is Operator
    assert found["/odom"] is found["/a"] is Name.Namespace
    assert found["and"] is found["for"] is Keyword
    assert found["true"] is Keyword.Constant
    assert found['"so"'] is String
    assert found["speed"] is Name


def test_systems_are_coloured() -> None:
    """Arguments stand out, and a word in a path is a part of it."""
    found = _coloured(
        "system Robot\nnode lidar : lidar when $slam\nwirings\n  connect a/node to /node/topic\n",
        ROSSYSTEM,
    )
    assert found["$slam"] is Name.Variable
    assert found["system"] is found["node"] is found["connect"] is Keyword.Declaration
    assert found["when"] is found["to"] is Keyword
    assert found["/node/topic"] is Name.Namespace
    assert found["a/node"] is Name


def test_words_come_from_the_grammars() -> None:
    """Every keyword has a colour, and a new one would have."""
    for language in LANGUAGES:
        coloured = {Kind.CONSTANT, Kind.OPENING, Kind.WORD}
        regexes = [e.regex for e in patterns(language) if coloured.issuperset(e.kinds)]
        for word in keywords(language):
            assert sum(re.fullmatch(each, word) is not None for each in regexes) == 1, word
    assert {"parameters", "publishes", "topic", "timer"} <= opening_words(ROSNODE)
    assert {"subsystem", "connect", "safety"} <= opening_words(ROSSYSTEM)
    assert constant_words(ROSNODE) == {"true", "false", "inf", "nan"}


@pytest.mark.parametrize("language", LANGUAGES, ids=lambda each: each.name)
def test_pygments_finds_the_lexers(language: Language) -> None:
    """By the word behind a fence and by the name of a file, where deros is installed."""
    script = (
        "from pygments.lexers import get_lexer_by_name, get_lexer_for_filename as of;"
        f"print(get_lexer_by_name({language.name!r}).name == of('a{language.suffix}').name)"
    )
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=False, timeout=60
    )
    assert (done.stdout, done.stderr) == ("True\n", "")


def test_grammars_of_editors_are_current() -> None:
    """``python -m tools.textmate`` has nothing to write."""
    written = {each.name: each.read_text(encoding="utf-8") for each in FOLDER.iterdir()}
    assert written == grammars()
