"""The rounds of an event: what names an action comes after all that triggers or resets it."""

from __future__ import annotations

from deros.rules.program.rounds import late_rules, rounds, watched_actions
from tests.support.timelines import program

RULES = """use "robot.system" import Robot
action stop reset_by release;
action release;
action cut latched;
input v = topic /speed.data
input f = topic /flag.data
entity late { cut_off: cut.active and stopped; stopped: stop.active; }
entity e { fast: v > 0.5; up: f; }
if late.cut_off then { log_state("off"); };
behaviour again: if e.fast and late.stopped then { cut; };
if e.fast then { stop; if e.up then { log_state("up"); }; };
if e.up then { release; };
"""


def _described(rules: str) -> list[tuple[list[str], list[str], list[str]]]:
    return [
        (
            [rule.full_name for rule in each.rules],
            [behaviour.name for behaviour in each.behaviours],
            [action.name for action in each.resets],
        )
        for each in rounds(program(rules))
    ]


def test_what_names_an_action_is_in_a_later_round() -> None:
    """A rule follows the rules that it names; a reset belongs to the round that requests it."""
    assert _described(RULES) == [
        (["e.fast", "e.up"], ["behaviour_3", "behaviour_5"], ["stop"]),
        (["late.stopped"], ["again"], []),
        (["late.cut_off"], ["behaviour_1"], []),
    ]


def test_resets_wait_for_what_triggers_them() -> None:
    """An action is settled after the behaviours of both, and what names it comes then."""
    rules = RULES.replace("if e.up then { release; }", "if cut.active then { release; }")
    rules = rules.replace("and late.stopped then", "then")
    assert _described(rules) == [
        (["e.fast", "e.up"], ["again", "behaviour_3"], []),
        ([], ["behaviour_5"], ["stop"]),
        (["late.stopped", "late.cut_off"], ["behaviour_1"], []),
    ]


def test_nested_behaviours_are_evaluated_with_the_outer_one() -> None:
    """The whole belongs to the round of the latest of them."""
    rules = RULES.replace('if e.up then { log_state("up"); }', "if cut.active then { stop; }")
    rules = rules.replace("and late.stopped then", "then")
    _, (_, behaviours, resets), *_ = _described(rules)
    assert (behaviours, resets) == (["behaviour_3"], ["stop"])


def test_there_is_one_round_without_conditions_on_actions() -> None:
    """All rules, all behaviours and all resets are in it."""
    rules = RULES.replace("cut.active", "fast2").replace("stop.active", "e.up")
    rules = rules.replace("fast2", "e.fast")
    built = program(rules)
    (only,) = rounds(built)
    assert only.rules == built.rules
    assert only.behaviours == built.behaviours
    assert not watched_actions(built)
    assert not late_rules(built)
