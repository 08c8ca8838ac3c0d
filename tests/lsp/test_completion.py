"""What is offered while somebody writes."""

# ruff: noqa: D103 - the names of tests say it, also of asynchronous ones

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from lsprotocol import types
from pytest_lsp import LanguageClient

from tests.support.editor import Editor

NODE = """\
node Driver : drive_pkg

parameters
  name wheel_base : double [m] "Between the wheels"
  name topic_name : string = "scan"
  name rate : double = 10.0 [Hz]

publishes
  topic odom : nav_msgs.Odometry
  topic scan : sensor_msgs.LaserScan via topic_name

services
  service reset : std_srvs.Trigger
"""
SYSTEM = """\
system Robot

imports
  import "driver.rnd"

argument fast : bool = false

host board "10.0.0.2"

topics
  topic /motion "How the robot moves"
  external topic /health : diagnostic_msgs.DiagnosticArray

subsystem Base {
  node driver : Driver
  parameters
    param wheel_base = 0.3 m
  wirings
    connect odom to /motion
    connect scan to /scan

  node spare : Driver when fast
  parameters
    param wheel_base = 0.3
}
"""
RULES = """\
use "robot.system" import Robot
action stop;
action slow(level);
const turn = 20 deg/s;
unit knot = 0.514444 m/s;
input speed = topic /motion.twist.twist.linear.x timeout 1 s;
input scan = topic /scan timeout 1 s;
input place = topic /motion.pose.pose.position timeout 1 s;
zone yard = rectangle (0, 0) (4, 3) m "where it drives";
entity motion "How it moves" {
  too_fast: speed > 2 m/s for 1 s;
  near: scan.nearest() < 0.5 m;
}
if motion.too_fast then { stop; }
"""


@pytest.fixture
def editor(client: LanguageClient, tmp_path: Path) -> Iterator[Editor]:
    """Return an editor beside a robot with a scanner."""
    editor = Editor(client, tmp_path)
    editor.write(driver_rnd=NODE, robot_system=SYSTEM, rules_deros=RULES)
    yield editor
    for name in list(editor.documents):
        editor.close(name)


@pytest.mark.parametrize(
    ("before", "written", "offered"),
    [
        (
            "input speed = topic ",
            "",
            {"/motion": "nav_msgs.Odometry", "/scan": "sensor_msgs.LaserScan"},
        ),
        ("input speed = topic ", "/motion.", {"twist": "geometry_msgs.TwistWithCovariance"}),
        (
            "input speed = topic ",
            "/motion.twist.twist.",
            {"linear": "geometry_msgs.Vector3 in m/s"},
        ),
        ("input speed = topic ", "/motion.twist.twist.linear.", {"x": "float64 in m/s"}),
        (
            "near: ",
            "scan.",
            {"nearest()": "the least range between two bearings, in m", "ranges": "float32[] in m"},
        ),
        (
            "near: ",
            '/health.status[name = "a lidar"].',
            {"level": "byte", "values": "diagnostic_msgs.KeyValue[]"},
        ),
        ("near: ", '/health.status[name = "\\q"].', {}),
        ("near: ", "spe", {"speed": "float64 in m/s", "turn": "constant", "not": ""}),
        ("near: ", "speed.", {"rate()": None, "age()": None, "missing()": None}),
        ("if ", "motion.", {"too_fast": "rule", "near": "rule"}),
        ("near: ", "place.", {"inside()": "whether it lies in that zone, or on its edge"}),
        ("near: ", "place.inside(", {"yard": "zone"}),
        ("input scan", " = topic /scan zone home = circle (0, 0) 2 ", {"m": "length"}),
        ("if ", "stop.", {"active": "whether the action is active"}),
        ("then { ", "", {"stop": "action", "slow": "action(level)", "log_state": None}),
        ("import ", "", {"Robot": "system"}),
        ("too_fast: ", "speed > 2 ", {"m/s": "length/time", "knot": "length/time", "for": ""}),
        ("too_fast: speed > 2 m/s for 1 ", "", {"s": "time", "ms": "time"}),
        ("action stop", " publishes true on /x : ", {"std_msgs": "package"}),
        ("action stop", " publishes true on /x : std_msgs.", {"Bool": "std_msgs/msg/Bool"}),
        ("action stop", " calls /x : std_srvs.", {"Trigger": "std_srvs/srv/Trigger"}),
        ("action slow(level)", " reset_by ", {"stop": "action"}),
        ("use ", '"rob', {"robot.system": ""}),
        ("action stop", "; gate /a -> /b : geometry_msgs.Twist rate 20 ", {"Hz": "1/time"}),
        (
            "action stop",
            "; gate /a -> /b : geometry_msgs.Twist rate 20 Hz { stop: limit linear.x to [0, 1] ",
            {"m/s": "length/time"},
        ),
    ],
)
async def test_rules(
    editor: Editor, before: str, written: str, offered: dict[str, str | None]
) -> None:
    """What fits is offered, with type and unit."""
    rules = editor.open("rules.deros")
    await rules.messages()
    found = await rules.complete(before, written)
    assert offered.keys() <= found.keys(), sorted(found)
    assert {k: v for k, v in offered.items() if v} == {k: found[k] for k, v in offered.items() if v}


@pytest.mark.parametrize(
    ("before", "written", "offered"),
    [
        ("node driver : ", "", {"Driver": "drive_pkg"}),
        ("node driver : ", "Dri", {"Driver": "drive_pkg"}),
        ("connect odom to ", "", {"/motion": "nav_msgs.Odometry"}),
        (
            "    connect scan",
            " to /scan\n    connect ",
            {"odom": "publisher nav_msgs.Odometry", "topic_name": "parameter", "publisher": ""},
        ),
        (
            "    connect scan",
            " to /scan\n    connect service ",
            {"reset": "service std_srvs.Trigger"},
        ),
        ("  topic /motion", " : nav_msgs.", {"Odometry": "nav_msgs/msg/Odometry"}),
        ("node spare : Driver when ", "", {"fast": "bool"}),
        ("node spare : Driver", " on ", {"board": "10.0.0.2"}),
        ("param wheel_base = 0.3 ", "", {"m": "length", "cm": "length"}),
        ("import ", '"', {"driver.rnd": "", "deros:load_monitor.rnd": "comes with deros"}),
        (
            "node spare : Driver",
            "\n  parameters\n    param ",
            {"wheel_base": "double in m", "rate": "double in Hz"},
        ),
    ],
)
async def test_systems(
    editor: Editor, before: str, written: str, offered: dict[str, str | None]
) -> None:
    """What fits is offered, from the nodes that the system imports."""
    system = editor.open("robot.system")
    await system.messages()
    found = await system.complete(before, written)
    assert offered.keys() <= found.keys(), sorted(found)
    assert {k: v for k, v in offered.items() if v} == {k: found[k] for k, v in offered.items() if v}


@pytest.mark.parametrize(
    ("before", "written", "offered"),
    [
        ("topic odom : ", "nav_msgs.", {"Odometry"}),
        ("service reset : ", "std_srvs.", {"Trigger", "SetBool"}),
        ("name rate : ", "", {"double", "integer", "string[]"}),
        ("via ", "", {"topic_name"}),
        ("topic odom : nav_msgs.Odometry", " { twist.twist.", {"linear", "angular"}),
        ("topic odom : nav_msgs.Odometry", " qos ", {"reliable", "best_effort", "depth"}),
        ("name rate : double = 10.0 [", "", {"Hz", "m"}),
        ("publishes\n", "  ", {"topic", "subscribes", "timers"}),
    ],
)
async def test_nodes(editor: Editor, before: str, written: str, offered: set[str]) -> None:
    """What fits is offered in node descriptions."""
    node = editor.open("driver.rnd")
    await node.messages()
    found = await node.complete(before, written)
    assert offered <= found.keys(), sorted(found)


@pytest.mark.parametrize(
    ("before", "written", "unfit"),
    [
        ("too_fast: ", "speed > 2 ", {"deg", "kg", "s"}),
        ("near: ", "scan.", {"roll()", "rate()", "norm()"}),
        ("input speed = topic ", "/motion.twist.twist.linear.x.", {"x", "roll()"}),
        ("action stop", " calls /x : std_srvs.", {"Bool"}),
        ("then { ", "", {"speed", "motion"}),
    ],
)
async def test_what_does_not_fit_is_not_offered(
    editor: Editor, before: str, written: str, unfit: set[str]
) -> None:
    rules = editor.open("rules.deros")
    await rules.messages()
    assert not unfit & (await rules.complete(before, written)).keys()


async def test_a_broken_statement_above_does_not_matter(editor: Editor) -> None:
    rules = editor.open("rules.deros", RULES.replace("const turn =", "const turn = = >"))
    await rules.messages()
    assert "too_fast" in await rules.complete("if ", "motion.")


async def test_in_comments_and_texts_nothing_is_offered(editor: Editor) -> None:
    rules = editor.open("rules.deros", RULES.replace("action stop;", "action stop; // sp"))
    await rules.messages()
    assert await rules.complete("action stop; // sp") == {}
    assert await rules.complete('entity motion "How it') == {}


async def test_an_offer_replaces_the_word_that_is_written(editor: Editor) -> None:
    """Also one with a slash, which editors take for two words."""
    rules = editor.open("rules.deros")
    await rules.messages()
    await rules.complete("input speed = topic ", "/mot")
    at = types.Position(5, len("input speed = topic /mot"))
    found = await rules.client.text_document_completion_async(
        types.CompletionParams(rules.identifier, at)
    )
    assert isinstance(found, list | tuple)
    edit = next(each.text_edit for each in found if each.label == "/motion")
    assert isinstance(edit, types.TextEdit)
    assert edit.range.start.character == len("input speed = topic ")
    assert edit.range.end == at


async def test_a_function_leaves_the_cursor_between_its_parentheses(editor: Editor) -> None:
    rules = editor.open("rules.deros")
    await rules.messages()
    await rules.complete("near: ", "scan.")
    found = await rules.client.text_document_completion_async(
        types.CompletionParams(rules.identifier, types.Position(11, len("  near: scan.")))
    )
    assert isinstance(found, list | tuple)
    item = next(each for each in found if each.label == "nearest()")
    assert isinstance(item.text_edit, types.TextEdit)
    assert item.text_edit.new_text == "nearest($1)"
    assert item.insert_text_format is types.InsertTextFormat.Snippet
