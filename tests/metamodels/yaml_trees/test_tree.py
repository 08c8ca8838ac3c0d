"""YAML with places: what values are, and what is refused."""

from __future__ import annotations

import math

import pytest

from deros.diagnostics import SourceFile
from deros.metamodels.yaml_trees.tree import Mapping, NotATreeError, Scalar, Sequence, tree_of


def tree(text: str) -> Mapping:
    """Return the keys at the top of a text."""
    found = tree_of(SourceFile("x.yaml", text))
    assert isinstance(found, Mapping)
    return found


def value(text: str) -> object:
    """Return the value of a scalar."""
    found = tree(f"a: {text}\n").get("a")
    assert isinstance(found, Scalar)
    return found.value


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("1", 1),
        ("0x10", 16),
        ("1.5", 1.5),
        (".inf", math.inf),
        ("yes", True),
        ("off", False),
        ("~", None),
        ("", None),
        ("'1'", "1"),
        ("1e5", "1e5"),  # YAML 1.1 has it as a text
        ("!!float 2", 2.0),
        ("!!str 2", "2"),
        ("!!int x", "x"),
        ("2020-01-01", "2020-01-01"),
        ("=", "="),
        ("9" * 5000, "9" * 5000),
    ],
)
def test_scalars_have_the_values_of_yaml_1_1(text: str, expected: object) -> None:
    """As PyYAML reads them; what is no number after all stays a text."""
    found = value(text)
    assert (type(found), found) == (type(expected), expected)


def test_each_node_knows_its_place() -> None:
    """Spans are those of the text, also behind a character of several bytes."""
    found = tree("ä: 1\nlist:\n  - 'two'\n")
    assert {key: (span.line, span.text) for key, span in found.keys.items()} == {
        "ä": (1, "ä"),
        "list": (2, "list"),
    }
    items = found.get("list")
    assert isinstance(items, Sequence)
    assert (items.items[0].span.line, items.items[0].span.text) == (3, "'two'")


def test_aliases_and_merged_keys_are_followed() -> None:
    """A key of its own comes before one that is merged, and the first of several merged ones."""
    found = tree("a: &a {x: 1, y: 1}\nb: &b {x: 2, z: 2}\nc: {<<: [*a, *b], y: 3}\nd: *a\n")
    assert found.get("d") == found.get("a")
    merged = found.get("c")
    assert isinstance(merged, Mapping)
    assert {key: each.value for key, each in merged.entries.items()} == {  # type: ignore[union-attr]
        "x": 1,
        "y": 3,
        "z": 2,
    }


def test_keys_that_do_not_count_are_known() -> None:
    """The last of two counts; a list is no key."""
    found = tree("a: 1\n? [b]\n: 2\na: 3\n")
    assert found.get("a") == Scalar(3, "3", False, found.span)
    assert [span.line for span in found.repeated] == [1]
    assert [span.line for span in found.unnamed] == [2]


def test_no_document_is_no_tree() -> None:
    """An empty text, and one of comments."""
    assert tree_of(SourceFile("x", "")) is None
    assert tree_of(SourceFile("x", "# only this\n")) is None


BOMB = "a0: &a0 [1, 2]\n" + "".join(
    f"a{each}: &a{each} [{', '.join([f'*a{each - 1}'] * 9)}]\n" for each in range(1, 12)
)


@pytest.mark.parametrize(
    ("text", "said", "line"),
    [
        ("a: 1\nb: [", "this is not YAML: while parsing a flow node", 2),
        ("a: *b", "'*b' stands for nothing above it", 1),
        ("&a [*a]", "'*a' stands for nothing above it", 1),
        ("a: {<<: 3}", "'<<' takes what stands elsewhere with '*'", 1),
        ("[" * 200, "nested more than 100 levels deep", 1),
        ("a: \x07", "this is not YAML", 1),
        (BOMB, "more than 200000 values", 6),
    ],
)
def test_what_is_no_tree_has_a_place(text: str, said: str, line: int) -> None:
    """Also texts that would grow without end."""
    with pytest.raises(NotATreeError) as caught:
        tree_of(SourceFile("x", text))
    assert said in caught.value.fault.message
    assert caught.value.fault.span.line == line
