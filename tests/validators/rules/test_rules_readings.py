"""Conditions that people read in another way than the language does are remarked on."""

from __future__ import annotations

import pytest

from deros.diagnostics import Severity
from deros.rules.engine.engine import Engine
from deros.validators.rules.rules import check_rules
from tests.support.rules import build_rules, findings, load, program

DECLARED = """
action stop;
input f = topic /flag.data timeout 1 sec
input m = topic /mode.data timeout 1 sec
input battery = topic /battery timeout 1 sec
input joints = topic /joints timeout 1 sec
input name = topic /name.data timeout 1 sec
"""
NAMED = """
entity of {
  began: f begins; mode: (m = 1) begins; both_began: f begins and battery.present;
  failsafe guarded: f begins; any: f begins or (m = 1) begins;
}
"""
OURS = ("DRS378", "DRS379", "DRS383", "DRS308")


def remarks(condition: str) -> list[tuple[str, str]]:
    """Return code and place of the remarks on the condition of a rule."""
    found = findings(f"{DECLARED}{NAMED} entity e {{ r: {condition}; }} if e.r then {{ stop; }};")
    return [(code, place) for code, place, _ in found if code in OURS]


def remarks_on_behaviours(behaviours: str) -> list[tuple[str, str]]:
    """Return code and place of the remarks on behaviours."""
    return [
        (code, place)
        for code, place, _ in findings(f"{DECLARED}{NAMED}{behaviours}")
        if code in OURS
    ]


@pytest.mark.parametrize(
    "condition",
    [
        "f begins and (m = 1) begins",
        "f begins and battery.present and (m = 1) begins",
        "(f and f) begins and m = 1 begins",
        "not f = true or f begins and m = 1 begins",
        "of.began and m = 1 begins",
        "of.both_began and of.mode",
        "(f begins or battery.present begins) and m = 1 begins",
        "(f for 1 sec) begins and m = 1 begins",
        "f.missing() begins and m = 1 begins",
    ],
)
def test_events_of_two_topics_at_one_instant_are_found(condition: str) -> None:
    """No message brings both: the remark stands at what joins them."""
    ((code, place),) = remarks(condition)
    assert code == "DRS378"
    assert condition.endswith(place)


@pytest.mark.parametrize(
    "condition",
    [
        "f begins",
        "f begins and m = 1",
        "f begins or m = 1 begins",
        "(f begins within 1 sec) and (m = 1 begins within 1 sec)",
        "f begins and (m = 1 begins within 1 sec)",
        "m = 1 begins and (m > 0) begins",
        "(f and m = 1) begins and m = 1 begins",
        "of.any and m = 1 begins",
        "of.guarded and m = 1 begins",
        "f begins and not (m = 1 begins)",
        "f begins since m = 1 begins",
        "f.missing() begins and m.missing() begins",  # both after one timeout
        "(f for 1 sec) begins and (m = 1 for 1 sec) begins",
    ],
)
def test_other_events_are_not(condition: str) -> None:
    """One message or one deadline may bring both, or one of them lasts."""
    assert remarks(condition) == []


def test_each_pair_of_events_is_found_once() -> None:
    """A rule that has the remark gives none to what names it, unless that adds an event."""
    rules = "entity e { both: f begins and m = 1 begins; r: both; }"
    found = remarks_on_behaviours(f"{rules} if e.r and e.both then {{ stop; }};")
    assert found == [("DRS378", "f begins and m = 1 begins")]


@pytest.mark.parametrize(
    ("behaviours", "place"),
    [
        ("if of.began then { if of.mode then { stop; }; };", "of.mode"),
        ("if of.began then { if of.any then { if of.mode then { stop; }; }; };", "of.mode"),
        ("if of.began then { if of.began then { stop; }; };", ""),
        ("if of.began then { if of.any then { stop; }; };", ""),
        ("if of.began within 1 sec then { if of.mode then { stop; }; };", ""),
    ],
)
def test_event_inside_an_if_on_another_event(behaviours: str, place: str) -> None:
    """The inner condition counts together with all outer ones."""
    expected = [("DRS378", place)] if place else []
    assert remarks_on_behaviours(behaviours) == expected


def test_rule_on_two_events_is_true_only_at_equal_times() -> None:
    """What the remark says, and that the proposed form is true."""
    declared = "action stop; input f = topic /flag.data input m = topic /mode.data"
    at_once = program(
        f"{declared} entity e {{ r: f begins and m = 1 begins; }} if e.r then {{ stop; }};"
    )
    shortly = program(
        f"{declared} entity e {{ r: (f begins within 1 sec) and (m = 1 begins within 1 sec); }}"
        " if e.r then { stop; };"
    )
    for gap_ns, expected in ((0, (True, True)), (1, (False, True)), (500_000_000, (False, True))):
        for whole, acts in zip((at_once, shortly), expected, strict=True):
            engine = Engine(whole)
            engine.message(10**9, "/flag", {0: True})
            engine.message(10**9 + gap_ns, "/mode", {1: 1})
            assert any(each.kind == "trigger" for each in engine.events) == acts


@pytest.mark.parametrize(
    ("condition", "hint"),
    [
        ("f and m = 1 within 1 sec", ("(f and m = 1) within 1 sec", "f and (m = 1 within 1 sec)")),
        ("f or m = 1 within 1 sec", ("(f or m = 1) within 1 sec", "f or (m = 1 within 1 sec)")),
        (
            "(f) and (m = 1) within 1 sec",
            ("((f) and (m = 1)) within 1 sec", "(f) and ((m = 1) within 1 sec)"),
        ),
        (
            "f or m = 1 and battery.present within 1 sec",
            (
                "(f or m = 1 and battery.present) within 1 sec",
                "f or m = 1 and (battery.present within 1 sec)",
            ),
        ),
        (
            "f begins and m = 1 begins within 1 sec",
            (
                "(f begins within 1 sec) and (m = 1 begins within 1 sec)",
                "f begins and (m = 1 begins within 1 sec)",
            ),
        ),
        (
            "f begins and (m = 1 or m = 2) begins within 1 sec",
            (
                "(f begins within 1 sec) and ((m = 1 or m = 2) begins within 1 sec)",
                "f begins and ((m = 1 or m = 2) begins within 1 sec)",
            ),
        ),
        (
            "f\n  and // why\n  m = 1 within 1 sec",
            ("(f and m = 1) within 1 sec", "f and (m = 1 within 1 sec)"),
        ),
    ],
)
def test_within_without_parentheses_is_found(condition: str, hint: tuple[str, str]) -> None:
    """The hint has both forms, and neither of them is found."""
    model = load(f"{DECLARED}{NAMED} entity e {{ r: {condition}; }} if e.r then {{ stop; }};")
    result = build_rules(
        f"{DECLARED}{NAMED} entity e {{ r: {condition}; }} if e.r then {{ stop; }};"
    )
    (found,) = (each for each in check_rules(model, result) if each.code.name == "DRS379")
    assert found.severity is Severity.INFO
    for each in hint:
        assert f"'{each}'" in found.hint
        assert remarks(each) == []


@pytest.mark.parametrize(
    "condition",
    [
        "f within 1 sec",
        "(f and m = 1) within 1 sec",
        "((f or m = 1)) within 1 sec",
        "f and (m = 1 within 1 sec)",
        "f begins within 1 sec and m = 1 begins within 1 sec",
        "f and m = 1 begins within 1 sec",
        "f and m = 1 for 1 sec",
        "f or m = 1 for 1 sec",
        "f and m = 1 since m = 2",
    ],
)
def test_within_that_is_clear_is_not(condition: str) -> None:
    """The writer wrote the parentheses, or there is one thing to cover; ``for`` covers all."""
    assert remarks(condition) == []


@pytest.mark.parametrize(
    ("condition", "is_found"),
    [
        ("(f begins) for 1 sec", True),
        ("(f begins and m = 1) for 1 sec", True),
        ("of.began for 1 sec", True),
        ("(f begins or m = 1 begins) for 1 sec", True),
        ("of.any for 1 sec", True),
        ("(f begins or m = 1) for 1 sec", False),
        ("(f begins within 2 sec) for 1 sec", False),
        ("(not (f begins)) for 1 sec", False),
        ("of.guarded for 1 sec", False),  # while it is unknown, it lasts
    ],
)
def test_for_on_an_event_is_never_true(condition: str, is_found: bool) -> None:
    """What holds at one event only cannot last, through names and where all parts of ``or`` do."""
    assert remarks(condition) == ([("DRS308", condition)] if is_found else [])
