"""The view of the rules for safety node templates in all languages."""

from __future__ import annotations

from pathlib import Path

import pytest

from deros.generators.safety_node.view import (
    action_notes,
    argument_types,
    behaviour_views,
    calls,
    lasts,
    needs_code,
    only_resets,
    origin_file,
    refusing_behaviours,
    shared_topics,
    states_by_path,
)
from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from deros.models.rules import Rules
from deros.rules.compiler.build import build
from deros.rules.program.ir import Action, Program
from tests.support.rules import load, program

RULES = """action stop publishes true on /stop : std_msgs.Bool latched;
action crawl publishes 0.2 on /limit : std_msgs.Float64 reset_by release;
action creep publishes 0.1 on /limit : std_msgs.Float64 reset_by release;
action release;
action beep(times, why) "Sounds the horn";
entity e { fast: topic /scan.range_max > 1.0; near: topic /scan.range_min < 1.0; }
behaviour outer: if e.fast  // of the laser
  then { beep(3, "fast"); stop; if e.near then { beep(0.5, "near"); crawl; creep; }; };
if e.near then { release; log_state("near"); };
"""


@pytest.fixture(scope="module")
def built() -> Program:
    """Return the program of the rules above."""
    return program(RULES)


def named(built: Program, name: str) -> Action:
    """Return one of its actions."""
    return next(action for action in built.actions if action.name == name)


def test_file_of_the_rules_has_no_folder() -> None:
    """The output is the same on every machine."""
    assert origin_file(load(RULES)) == "rules.deros"


def test_actions_share_a_field_in_declaration_order(built: Program) -> None:
    """Each has the value that it publishes there."""
    shared = states_by_path(built, "/limit")
    assert {
        path: [(action.name, binding.value) for action, binding in bound]
        for path, bound in shared.items()
    } == {("data",): [("crawl", 0.2), ("creep", 0.1)]}
    assert states_by_path(built, "/scan") == {}


def test_bound_actions_have_a_state_and_others_need_code(built: Program) -> None:
    """Bound actions have a state, others are user code; the built-in one is neither."""
    assert [action.name for action in built.actions if needs_code(action)] == ["release", "beep"]
    assert [action.name for action in built.actions if lasts(action)] == ["stop", "crawl", "creep"]


def test_reset_is_refused_by_behaviours_that_trigger_the_action(built: Program) -> None:
    """These are the behaviours that trigger the action."""
    refusing = {action.name: refusing_behaviours(action) for action in built.actions}
    assert {name: found for name, found in refusing.items() if found} == {
        "stop": (0,),
        "crawl": (1,),
        "creep": (1,),
    }


def test_calls_are_in_source_order(built: Program) -> None:
    """This includes those of nested behaviours."""
    names = [built.actions[call.action].name for call in calls(built)]
    assert names == ["beep", "stop", "beep", "crawl", "creep", "release", "log_state"]


def test_int_and_float_arguments_become_float(built: Program) -> None:
    """Every parameter has the types of all its arguments."""
    beep = named(built, "beep")
    assert [list(types) for types in argument_types(beep, built)] == [["float"], ["str"]]
    assert argument_types(named(built, "release"), built) == []


def test_notes_describe_an_action_and_its_callers(built: Program) -> None:
    """The description in the rules comes first, if there is one."""
    assert action_notes(named(built, "beep"), built, "sounds the horn") == [
        "Sounds the horn.",
        "Declared in rules.deros:6, run by outer, behaviour_2.",
    ]
    unused = program("action wave;")
    assert action_notes(unused.actions[0], unused, "") == [
        "Declared in rules.deros:2, run by no behaviour."
    ]


def test_nested_behaviour_depends_on_outer_rules(built: Program) -> None:
    """Its condition is shown without comments, on one line."""
    assert [(view.name, view.condition, view.rules) for view in behaviour_views(built)] == [
        ("outer", "e.fast", ("e.fast",)),
        ("behaviour_2", "e.near", ("e.fast", "e.near")),
        ("behaviour_3", "e.near", ("e.near",)),
    ]


def test_action_that_only_resets_others_needs_no_code(built: Program) -> None:
    """It has neither parameters nor a state, so running it is enough."""
    assert [a.name for a in built.actions if only_resets(a, built)] == ["release"]
    assert action_notes(named(built, "release"), built, "")[-1] == (
        "Running it resets crawl, creep; it need not do anything else."
    )
    with_code = program(
        RULES.replace("action release;", "action release(why);").replace(
            "{ release;", '{ release("near");'
        )
    )
    assert not any(only_resets(a, with_code) for a in with_code.actions)


TWO_BASES = """use "robot.system" import Robot
action stop;
input speed = topic /odom.twist.twist.linear.x timeout 1 sec {option}
input place = topic /odom/all.pose.pose.position.x timeout 1 sec
input frames = topic /tf.transforms timeout 1 sec
entity e {{ r: speed > 1 or place > 1 or frames.count() > 9; }}
if e.r then {{ stop; }};
"""


@pytest.mark.parametrize(
    ("option", "shared"),
    [("", {"/odom/all", "/tf"}), ("publishers any", {"/odom", "/odom/all", "/tf"})],
)
def test_topic_is_shared_where_that_is_said(tmp_path: Path, option: str, shared: set[str]) -> None:
    """Two publishers in the system are no word that they are meant: one may hide a dead one."""
    (tmp_path / "base.rnd").write_text("node base : p publishes topic odom : nav_msgs.Odometry")
    nodes = "".join(
        f"node {name} : base wirings connect odom to {topic}\n"
        for name, topic in zip("abcd", ("/odom", "/odom", "/odom/all", "/odom/all"), strict=True)
    )
    (tmp_path / "robot.system").write_text(
        'system Robot imports import "base.rnd" topics topic /odom topic /odom/all publishers any'
        f" external topic /tf : tf2_msgs.TFMessage {nodes}"
    )
    path = tmp_path / "a.deros"
    path.write_text(TWO_BASES.format(option=option))
    model = Repository().load(path).model
    assert isinstance(model, Rules)
    result = build(model, InterfaceStore())
    assert result.program is not None
    assert shared_topics(model, result.program, result.topics) == shared
