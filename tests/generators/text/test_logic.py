"""A condition on several lines has the meaning of its formula."""

from __future__ import annotations

import ast

from hypothesis import given
from hypothesis import strategies as st

from deros.generators.text.logic import (
    AllOf,
    AnyOf,
    Atom,
    Logic,
    NoneOf,
    all_of,
    any_of,
    lay_out,
    text,
)
from deros.generators.text.python import LINE_LENGTH

# Names so long that a few operands fill a line, with many lengths to hit the exact width.
_NAMES = [f"{letter}{'_' * length}" for letter in "xyz" for length in (0, 5, 17, 31, 60)]

_ATOMS = st.sampled_from([Atom(name) for name in _NAMES])


def _nested(inner: st.SearchStrategy[Logic]) -> st.SearchStrategy[Logic]:
    several = st.lists(inner, min_size=2, max_size=4)
    return st.one_of(several.map(all_of), several.map(any_of), inner.map(NoneOf))


formulas: st.SearchStrategy[Logic] = st.recursive(_ATOMS, _nested, max_leaves=12)


def _tree(logic: Logic) -> ast.expr:
    """Return the syntax tree of a formula with every operand in parentheses."""
    match logic:
        case Atom():
            return ast.Name(logic.text, ast.Load())
        case NoneOf():
            return ast.UnaryOp(ast.Not(), _tree(logic.operand))
        case AllOf() | AnyOf():
            word = ast.And() if isinstance(logic, AllOf) else ast.Or()
            return ast.BoolOp(word, [_tree(operand) for operand in logic.operands])


@given(formulas, st.sampled_from([0, 4, 8, 12]), st.sampled_from(["if ", "elif ", "return "]))
def test_lines_parse_as_the_formula(logic: Logic, indent: int, before: str) -> None:
    """Only a single operand may be longer than a line."""
    after = "" if before == "return " else ":"
    lines = lay_out(indent, before, logic, after)
    expression = "\n".join(lines).strip().removeprefix(before).removesuffix(after)
    expected = ast.dump(_tree(logic))
    assert ast.dump(ast.parse(f"({expression})", mode="eval").body) == expected
    assert ast.dump(ast.parse(text(logic), mode="eval").body) == expected
    too_long = [line for line in lines if len(line) > LINE_LENGTH]
    assert all(sum(line.count(letter) for letter in "xyz") == 1 for line in too_long)
