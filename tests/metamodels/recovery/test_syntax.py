"""Syntax errors: exact positions, and messages in the user's words instead of the parser's."""

from __future__ import annotations

import re

import pytest

from deros import codes
from deros.diagnostics import Diagnostic
from deros.metamodels.load import Repository

# File name, text with the error between « and », part of the message or hint.
CASES = [
    ("a.rnd", "«nodea» : p", "'node'"),
    ("a.rnd", "node a «p»", "':'"),
    ("a.rnd", "node a«»", "':'"),
    ("a.rnd", "node «5» : p", "a name"),
    ("a.rnd", "node a : p «paramters» name x : bool", "did you mean 'parameters'"),
    ("a.rnd", "node a : p parameters name x «double»", "':'"),
    ("a.rnd", "node a : p parameters name x : «dobule»", "did you mean 'double'"),
    ("a.rnd", 'node a : p parameters name x : string = «"»abc\n', "not closed"),
    ("a.rnd", r'node a : p parameters name x : string = "a«\q»b"', "unknown escape"),
    ("a.rnd", "node a : p publishes topic x : «Bool»", "a type such as std_msgs.Bool"),
    ("a.rnd", "node a : p publishes topic x : a.B qos «fast»", "a QoS policy such as reliable"),
    ("a.rnd", "node a : p\n«/*» never closed", "close it with '*/'"),
    ("a.rnd", "node a : p«\u00a0»parameters", "U+00A0 (no-break space)"),
    ("a.rnd", "node a : p parameters name x : double = «1e5000»", "out of range"),
    ("a.system", "system A «topic» /x", "write 'topics' before 'topic'"),
    ("a.system", "system A node x : y wirings connect a «/b»", "'to'"),
    ("a.system", "system A subsystem s { topics topic /x«»\n\n", "the file ends"),
    ("a.system", "system A subsystem «{» }", "a name"),
    ("a.deros", "action stop;\n«actoin» go;", "did you mean 'action'"),
    ("a.deros", "if a.b «the» { stop; }", "did you mean 'then'"),
    ("a.deros", "entity e { r «a» > 5; }", "':'"),
    ("a.deros", "entity e { r: a in [1, 2«;» }", "']' or ')'"),
    ("a.deros", "entity e { r: a «&» b; }", "expected"),
    ("a.deros", "entity e { r: x > -«-»3; }", "a name"),
    ("a.deros", "use «robot» import Robot", 'a string in "quotes"'),
    ("a.deros", "const x = «;»", "a number"),
    ("a.deros", 'entity «"a\u00a0b"» {', r'found "a\u00a0b"'),
    ("a.deros", "gate /a -> /b : c.D rate 1 Hz { stop: limit x «ot» [0, 1]; }", "'to'"),
    ("a.deros", "input x = topic /a.b«.»roll() timeout 3 sec", "a function is applied where"),
]


def _load(name: str, marked: str) -> tuple[tuple[Diagnostic, ...], tuple[int, int]]:
    start = marked.index("«")
    end = marked.index("»") - 1
    text = marked.replace("«", "").replace("»", "")
    findings = Repository().load_text(name, text).diagnostics
    return tuple(each for each in findings if each.code is codes.SYNTAX_ERROR), (start, end)


@pytest.mark.parametrize(("name", "marked", "words"), CASES, ids=[case[1] for case in CASES])
def test_syntax_error_has_position_and_expected_token(name: str, marked: str, words: str) -> None:
    """The error starts exactly where the text goes wrong, and names the expected token.

    No message shows a regular expression, a grammar rule or a Python type.
    """
    diagnostics, (start, end) = _load(name, marked)
    (finding,) = diagnostics
    assert finding.span.start == start
    assert finding.span.end >= end
    assert words in f"{finding.message} | {finding.hint}"
    shown = f"{finding.message} {finding.hint}".replace(words, "")
    assert not re.search(r"\\b|\(\?|\[A-Z|EOF|NoMatch|__|\b[A-Z][a-z]+[A-Z]\w*", shown)


def test_comment_marker_in_a_string_is_text() -> None:
    """``//`` and ``/*`` between quotes do not start a comment."""
    loaded = Repository().load_text("a.rnd", 'node a : p "see http://x /* y" // real\n lifecycle')
    assert loaded.diagnostics == ()
    assert loaded.model is not None
    assert loaded.model.description == "see http://x /* y"  # type: ignore[union-attr]


def test_quote_in_a_comment_is_ignored() -> None:
    """A quotation mark in a comment does not open a string."""
    text = 'node a /* don"t */ : // "\n p lifecycle'
    assert Repository().load_text("a.rnd", text).diagnostics == ()


def test_comments_do_not_shift_positions() -> None:
    """Text after comments keeps its line and column."""
    text = "/* one\n two */ node a : p // three\n parameters /* x */ name x double"
    (finding,) = Repository().load_text("a.rnd", text).diagnostics
    assert (finding.span.line, finding.span.column) == (3, 28)
