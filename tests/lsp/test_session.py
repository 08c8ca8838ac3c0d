"""Editing sessions with the running server."""

# ruff: noqa: D103 - the names of tests say it, also of asynchronous ones

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from lsprotocol import types
from pygls.exceptions import JsonRpcException
from pytest_lsp import LanguageClient

from tests.support.cli import deros
from tests.support.editor import Editor

NODE = """\
node Driver : drive_pkg "Drives the wheels"

parameters
  name wheel_base : double = 0.23 [m] in [0.1, 1.0] "Between the wheels"

publishes
  topic odom : nav_msgs.Odometry
"""
SYSTEM = """\
system Robot

imports
  import "driver.rnd"

topics
  topic /motion "How the robot moves"

subsystem Base namespace /base {
  node driver : Driver
  parameters
    param wheel_base = 0.3
  wirings
    connect odom to /motion
}
"""
RULES = """\
use "robot.system" import Robot
action stop;
const turn = 20 deg/s;
const fast = 2 km/h;
input speed = topic /motion.twist.twist.linear.x timeout 1 s;
input yaw = topic /motion.twist.twist.angular.z timeout 1 s;
entity motion {
  too_fast "Drives too fast": speed > fast for 1 s;
  turning: yaw.abs() > turn and not too_fast;
}
if motion.too_fast or motion.turning then { stop; }
"""
TRACE = """\
{"t": "1", "topic": "/motion", "data": {"twist.twist.linear.x": 0.9}}
{"t": "1.9", "topic": "/motion", "data": {"twist.twist.linear.x": 0.9}}
{"t": "2.5", "topic": "/motion", "data": {"twist.twist.linear.x": 0.9}}
"""
TIMELINE = """\
## stops

| time | message | effect |
|---|---|---|
| 1 s | speed = 0.9 | |
| 1.9 s | speed = 0.9 | |
| 2 s | | stop |
"""


@pytest.fixture
def editor(client: LanguageClient, tmp_path: Path) -> Iterator[Editor]:
    editor = Editor(client, tmp_path)
    editor.write(driver_rnd=NODE, robot_system=SYSTEM, rules_deros=RULES)
    yield editor
    for name in list(editor.documents):
        editor.close(name)


async def test_findings_are_those_of_the_present_text(editor: Editor) -> None:
    rules = editor.open("rules.deros")
    before = await rules.messages()
    rules.replace("speed > fast", "sped > fast")
    assert "DRS310: unknown name 'sped'\ndid you mean 'speed'?" in await rules.messages()
    rules.replace("sped > fast", "speed > fast")
    assert await rules.messages() == before


async def test_findings_in_other_files_are_shown_there(editor: Editor) -> None:
    system = editor.open("robot.system")
    await system.messages()
    driver = editor.open("driver.rnd", NODE.replace("nav_msgs.Odometry", "nav_msgs.Odometri"))
    assert any("Odometri" in each for each in await driver.messages())
    assert any("Odometri" in each for each in map(str, editor.client.diagnostics[driver.uri]))


async def test_unsaved_text_counts_in_the_files_that_import_it(editor: Editor) -> None:
    rules = editor.open("rules.deros")
    before = await rules.messages()
    driver = editor.open("driver.rnd")
    driver.replace("topic odom : nav_msgs.Odometry", "topic odom : std_msgs.Bool")
    await driver.messages()
    assert any("has no field 'twist'" in each for each in await rules.messages())
    driver.replace("std_msgs.Bool", "nav_msgs.Odometry")
    await driver.messages()
    assert await rules.messages() == before


async def test_a_closed_file_is_that_of_the_disk_again(editor: Editor) -> None:
    rules = editor.open("rules.deros")
    before = await rules.messages()
    driver = editor.open("driver.rnd", NODE.replace("nav_msgs.Odometry", "std_msgs.Bool"))
    await driver.messages()
    assert await rules.messages() != before
    editor.close("driver.rnd")
    assert await rules.messages() == before


async def test_the_rest_of_a_broken_file_still_answers(editor: Editor) -> None:
    rules = editor.open("rules.deros")
    rules.replace("input yaw = topic /motion", "input yaw = = topic /motion")
    assert any(each.startswith("DRS003") for each in await rules.messages())
    assert "2 km/h" in await rules.hover(rules.at("speed > fast", "fast"))
    assert await rules.definition(rules.at("speed > fast", "speed")) == ["rules.deros:5:7"]


@pytest.mark.parametrize(
    ("part", "inside", "said"),
    [
        ("speed > fast", "speed", "**input** `speed` : `float64` in `m/s`"),
        ("speed > fast", "fast", "= 0.555556 m/s"),
        ("> turn", "turn", "= 0.349066 rad/s"),
        ("not too_fast", "too_fast", "`speed` is above `fast`, without a break for `1 s`"),
        ("motion.turning then", "motion", "**entity** `motion`"),
        ("/motion.twist.twist.linear", "linear", "geometry_msgs/msg/Vector3"),
        ("linear.x timeout", "x", "`float64` in `m/s`"),
        ("topic /motion.twist.twist.linear", "/motion", "How the robot moves"),
        ("yaw.abs", "abs", "**function** `abs`"),
        ("{ stop; }", "stop", "Robot code carries it out."),
        ("import Robot", "Robot", "**system** `Robot`"),
    ],
)
async def test_words_of_rules_say_what_they_are(
    editor: Editor, part: str, inside: str, said: str
) -> None:
    rules = editor.open("rules.deros")
    assert said in await rules.hover(rules.at(part, inside))


@pytest.mark.parametrize(
    ("part", "inside", "said"),
    [
        ("node driver : Driver", "Driver", "Drives the wheels"),
        ("param wheel_base", "wheel_base", "Range: `in [0.1, 1.0]`"),
        ("connect odom to", "odom", "It publishes `nav_msgs/msg/Odometry`."),
        ("connect odom to /motion", "/motion", "**topic** `/motion` : `nav_msgs.Odometry`"),
    ],
)
async def test_words_of_systems_say_what_they_are(
    editor: Editor, part: str, inside: str, said: str
) -> None:
    system = editor.open("robot.system")
    assert said in await system.hover(system.at(part, inside))


async def test_on_a_finding_its_page_is_shown(editor: Editor) -> None:
    rules = editor.open("rules.deros")
    rules.replace("speed > fast", "sped > fast")
    assert "# DRS310" in await rules.hover(rules.at("sped > fast"))


@pytest.mark.parametrize(
    ("name", "part", "inside", "places"),
    [
        ("rules.deros", "speed > fast", "speed", ["rules.deros:5:7"]),
        ("rules.deros", "motion.turning then", "turning", ["rules.deros:9:3"]),
        ("rules.deros", "topic /motion", "/motion", ["robot.system:7:9"]),
        ("rules.deros", "import Robot", "Robot", ["robot.system:1:8"]),
        ("rules.deros", '"robot.system"', "robot", ["robot.system:1:1"]),
        ("robot.system", ": Driver", "Driver", ["driver.rnd:1:6"]),
        ("robot.system", "param wheel_base", "wheel_base", ["driver.rnd:4:8"]),
        ("robot.system", "connect odom", "odom", ["driver.rnd:7:9"]),
    ],
)
async def test_words_lead_to_their_declaration(
    editor: Editor, name: str, part: str, inside: str, places: list[str]
) -> None:
    document = editor.open(name)
    assert await document.definition(document.at(part, inside)) == places


async def test_uses_are_found_in_all_files(editor: Editor) -> None:
    rules = editor.open("rules.deros")
    system = editor.open("robot.system")
    await rules.messages()
    assert await system.references(system.at("topic /motion", "/motion")) == [
        "robot.system:7:9",
        "robot.system:14:21",
        "rules.deros:5:21",
        "rules.deros:6:19",
    ]


async def test_a_rule_is_renamed_wherever_it_is_named(editor: Editor) -> None:
    rules = editor.open("rules.deros")
    await rules.rename(rules.at("not too_fast", "too_fast"), "speeding")
    assert 'speeding "Drives too fast": speed > fast' in rules.text
    assert "turning: yaw.abs() > turn and not speeding;" in rules.text
    assert "if motion.speeding or" in rules.text


async def test_a_node_type_is_renamed_in_the_systems_that_have_it(editor: Editor) -> None:
    driver, system = editor.open("driver.rnd"), editor.open("robot.system")
    await system.messages()
    await driver.rename(driver.at("node Driver", "Driver"), "Wheels")
    assert "node Wheels : drive_pkg" in driver.text
    assert "node driver : Wheels" in system.text


async def test_what_is_no_name_is_refused(editor: Editor) -> None:
    rules = editor.open("rules.deros")
    with pytest.raises(JsonRpcException, match="'too fast' "):
        await rules.rename(rules.at("not too_fast", "too_fast"), "too fast")
    with pytest.raises(JsonRpcException, match="a topic cannot be renamed here"):
        await rules.rename(rules.at("topic /motion", "/motion"), "other")


async def test_the_edit_of_a_finding_is_a_quick_fix(editor: Editor) -> None:
    rules = editor.open("rules.deros")
    rules.replace("2 km/h", "2 kmm/h")
    rules.replace("yaw.abs() > turn", "speed = True")
    await rules.messages()
    titles = await rules.apply_fix(rules.at("speed = True", "True"))
    assert titles == ["Replace 'True' by 'true'"]
    assert "speed = true" in rules.text


async def test_each_name_that_may_be_meant_is_a_quick_fix(editor: Editor) -> None:
    rules = editor.open("rules.deros", RULES.replace("speed > fast", "speed > fats"))
    titles = await rules.apply_fix(rules.at("speed > fats", "fats"))
    assert titles == ["Replace 'fats' by 'fast'"]
    rules.replace("twist.twist.linear.x", "twist.twist.linear.q")
    await rules.messages()
    titles = await rules.apply_fix(rules.at("linear.q", "q"))
    assert titles == [f"Replace 'q' by '{each}'" for each in "xyz"]
    assert rules.text == RULES


async def test_converted_constants_and_resolved_names_are_shown(editor: Editor) -> None:
    rules = editor.open("rules.deros")
    assert await rules.hints() == ["3:22 = 0.349066 rad/s", "4:20 = 0.555556 m/s"]
    system = editor.open("robot.system", SYSTEM.replace("to /motion", "to motion"))
    assert await system.hints() == ["14:27 /base/motion"]


async def test_a_file_is_formatted(editor: Editor) -> None:
    rules = editor.open("rules.deros", RULES.replace("  too_fast", "too_fast").replace(">", " >  "))
    await rules.format()
    assert rules.text == RULES


async def test_a_broken_file_is_not_formatted(editor: Editor) -> None:
    text = RULES.replace("const fast = 2", "const fast = =   2")
    rules = editor.open("rules.deros", text)
    await rules.format()
    assert rules.text == text


async def test_the_outline_has_the_parts_of_each_language(editor: Editor) -> None:
    assert await editor.open("driver.rnd").outline() == ["Driver", " wheel_base", " odom"]
    system = editor.open("robot.system")
    assert await system.outline() == ["Robot", " /motion", " Base", "  driver"]
    assert await editor.open("rules.deros").outline() == [
        "stop",
        "turn",
        "fast",
        "speed",
        "yaw",
        "motion",
        " too_fast",
        " turning",
        "motion.too_fast or motion.turning",
    ]


async def test_colours_tell_names_apart(editor: Editor) -> None:
    rules = editor.open("rules.deros")
    colours = await rules.colours()
    assert ("speed", "variable", ["declaration"]) in colours
    assert ("fast", "variable", ["readonly"]) in colours
    assert ("twist", "property", []) in colours
    assert ("stop", "function", []) in colours


async def test_lenses_offer_what_can_be_done_with_a_file(editor: Editor) -> None:
    rules, system = editor.open("rules.deros"), editor.open("robot.system")
    assert await rules.lenses() == [
        f"generate {rules.path}",
        f"run --shadow {rules.path}",
    ]
    assert await system.lenses() == [f"generate {system.path}", f"graph {system.path}"]


async def test_lenses_play_what_lies_beside_the_rules(editor: Editor) -> None:
    """The commands that they run are run here, too, with what lies there."""
    editor.write(rules_jsonl=TRACE, rules_md="# Notes\n")
    editor.open("driver.rnd")
    rules = editor.open("rules.deros")
    _, simulate, _ = await rules.lenses()
    trace = rules.path.with_suffix(".jsonl")
    assert simulate == f"simulate {rules.path} --trace {trace} --format text"
    played = deros(*simulate.split(" "))
    assert played.code == 0, played
    assert played.out.startswith("2.000000000 stop, by behaviour_1"), played
    editor.write(rules_md=TIMELINE)
    _, test, _, _ = await rules.lenses()
    assert test == f"test {rules.path.with_suffix('.md')}"
    tested = deros(*test.split(" "))
    assert tested.code == 0, tested


async def test_positions_count_in_units_of_the_editor(editor: Editor) -> None:
    text = RULES.replace('"Drives too fast"', '"Fährt zu 🚀 schnell"')
    rules = editor.open("rules.deros", text)
    await rules.messages()
    line = types.Position(
        7, len('  too_fast "Fährt zu 🚀 schnell": speed'.encode("utf-16-le")) // 2
    )
    assert "**input** `speed`" in await rules.hover(line)


async def test_files_of_other_kinds_are_left_alone(editor: Editor) -> None:
    assert await editor.open("notes.txt", "node x").hover(types.Position(0, 1)) == ""


async def test_a_topic_of_another_robot_is_another_topic(editor: Editor) -> None:
    editor.write(other_system=SYSTEM.replace("Robot", "Other"))
    system = editor.open("robot.system")
    other = editor.open("other.system", SYSTEM.replace('import "driver.rnd"', ""))
    await other.messages()
    found = await system.references(system.at("topic /motion", "/motion"))
    assert found == ["robot.system:7:9", "robot.system:14:21"]
