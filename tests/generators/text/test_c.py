"""Elements of C text: on one line or several, they fit and have the same tokens."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from deros.diagnostics import SourceFile, Span
from deros.generators.text.c import (
    LINE_LENGTH,
    Call,
    Expression,
    Infix,
    comment,
    flat,
    lay_out,
    lay_out_if,
    lay_out_list,
)

_words = st.text("abc", min_size=1, max_size=40)
_infixes = st.builds(
    Infix, st.sampled_from(["&&", "+"]), st.lists(_words, min_size=2, max_size=4).map(tuple)
)
_expressions: st.SearchStrategy[Expression] = st.recursive(
    _words | _infixes,
    lambda inner: st.builds(Call, _words, st.lists(inner, max_size=4).map(tuple)),
    max_leaves=8,
)
_indents = st.sampled_from([0, 2, 4])


def _tokens(lines: list[str]) -> str:
    return "".join("".join(lines).split())


def _fit(lines: list[str], indent: int) -> bool:
    blanks = " " * indent
    return all(len(line) <= LINE_LENGTH and line.startswith(blanks) for line in lines)


@given(_expressions, _indents)
def test_broken_expression_has_the_same_tokens(expression: Expression, indent: int) -> None:
    """The lines of a statement fit and differ from one line only in white space."""
    lines = lay_out(indent, "value = ", expression)
    assert _fit(lines, indent)
    assert _tokens(lines) == _tokens([f"value = {flat(expression)};"])
    assert len(lines) == 1 or len(f"{' ' * indent}value = {flat(expression)};") > LINE_LENGTH


@given(st.lists(_words, min_size=1, max_size=8), _indents)
def test_broken_list_and_condition_have_the_same_tokens(words: list[str], indent: int) -> None:
    """Arguments fill their lines; the brace of a broken condition is on its own line."""
    arguments = lay_out_list(indent, "function(", words, ");")
    assert _fit(arguments, indent)
    assert _tokens(arguments) == f"function({','.join(words)});"
    condition = lay_out_if(" && ", words, indent)
    assert _fit(condition, indent)
    assert _tokens(condition) == f"if({'&&'.join(words)}){{"
    assert len(condition) == 1 or condition[-1] == " " * indent + "{"


@given(st.text("ab */?\\\n", max_size=300), _indents)
def test_comment_may_contain_any_text(text: str, indent: int) -> None:
    """No text ends a comment early or makes a line too long."""
    lines = comment(indent, "Rule", Span(SourceFile("r.deros", text), 0, len(text)))
    assert _fit(lines, indent)
    whole = "\n".join(lines).strip()
    assert whole.startswith("/* Rule (r.deros:1)")
    assert whole.index("*/", 2) == len(whole) - 2
    assert "/*" not in whole[2:]
