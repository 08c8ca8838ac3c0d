"""What the grammar takes at a place."""

from __future__ import annotations

import random
from pathlib import Path

import pytest

from deros.metamodels.languages import DEROS, ROSNODE, ROSSYSTEM, Language, language_of
from deros.metamodels.recovery.slots import Slot, Slots

EXAMPLES = sorted(
    str(path) for path in Path("examples/intelligent_one").iterdir() if language_of(path)
)


def slots(language: Language, text: str) -> list[Slot]:
    """Return the slots at the ``|`` of a text."""
    return Slots(language).at(text.replace("|", ""), text.index("|"))


@pytest.mark.parametrize(
    ("language", "text", "slot"),
    [
        (ROSNODE, "|", ("NodeType", "", "node")),
        (ROSNODE, "node A : p\npublishes\n  topic x : |", ("TopicPort", "type", "")),
        (ROSSYSTEM, "system S\nsubsystem A {\n  node x : |", ("NodeInstance", "type", "")),
        (ROSSYSTEM, "system S\n\nimports\n  import |", ("Import", "path", "")),
        (DEROS, 'use "a" import |', ("Use", "system", "")),
        (DEROS, "entity e { r: a > 2 m/s for 2 |", ("Duration", "unit", "")),
        (DEROS, "entity e { r: a > 2 |", ("Condition", "", "for")),
        (DEROS, "if a.b then { |", ("ActionCall", "action", "")),
    ],
)
def test_a_slot_has_rule_and_attribute(
    language: Language, text: str, slot: tuple[str, str, str]
) -> None:
    """A keyword has no attribute."""
    found = [(e.rule, e.attribute, "".join(e.words[:1])) for e in slots(language, text)]
    assert slot in found


def test_a_slot_knows_what_was_read_around_it() -> None:
    """Of the innermost rule, where one lies in another."""
    text = "system S\nsubsystem A {\n  node x : T\n  node y : U\n  wirings\n    connect p to |"
    (found,) = slots(ROSSYSTEM, text)
    assert found.read("NodeInstance", "type") == "U"
    assert found.read("Wiring", "port") == "p"
    assert found.read("Gate", "target") == ""


@pytest.mark.parametrize(
    "broken",
    [
        "entity f { q: > ; }",
        "entity f { q: a > ; s: = ; }",
        "const = 3",
        "input x = topic = ;",
        "entity f { q: a > 1 \n}",
        "action stop publishes on;",
    ],
)
def test_broken_statements_before_are_left_out(broken: str) -> None:
    """However they break off."""
    found = slots(DEROS, f"{broken}\nif a.b then {{ |")
    assert ("ActionCall", "action") in {(each.rule, each.attribute) for each in found}


@pytest.mark.parametrize(
    "text", ["action stop; // |", "action stop; /* |", "/* a\n b | */", "action stop; // a /* |"]
)
def test_there_are_none_in_comments(text: str) -> None:
    """Nothing is written there that the grammar reads."""
    assert slots(DEROS, text) == []


def test_behind_a_comment_there_are() -> None:
    """Also behind one in the same line."""
    assert slots(DEROS, "action stop; /* a */ |")
    assert slots(DEROS, "action stop; // a\n|")


@pytest.mark.parametrize("path", EXAMPLES)
def test_what_is_kept_makes_no_difference(path: str) -> None:
    """Slots that have seen other texts find what fresh ones find."""
    language = language_of(path)
    assert language is not None
    drawn = random.Random(path)
    text, used = Path(path).read_text(encoding="utf-8"), Slots(language)
    for _ in range(12):
        at = drawn.randrange(len(text))
        text = f"{text[:at]}{drawn.choice([' ', ';', 'x', ''])}{text[at + drawn.randrange(3) :]}"
        offset = drawn.randrange(len(text) + 1)
        assert used.at(text, offset) == Slots(language).at(text, offset)
