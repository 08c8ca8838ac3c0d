"""Changes of rules: each is found once, and what certainly protects less is marked."""

from __future__ import annotations

from pathlib import Path

import pytest

from deros.diff.changes import Change
from deros.diff.rules import compare_rules
from deros.metamodels.load import Repository
from deros.models.rules import Rules
from tests.support.compared_models import with_edit, without_errors

ROOT = Path(__file__).resolve().parents[2]

RULES = """\
use "robot.system" import Robot
unit pace = 0.5 m/s
action stop publishes true on /stop : std_msgs.Bool latched "halts"
action slow publishes true on /slow : std_msgs.Bool reset_by fine
action fine
action say(text)
const most = 1.0 m/s tunable in [0.1, 1.0] m/s
const wait = 1 sec
input speed = topic /odom.twist.twist.linear.x timeout 0.5 sec
input near = topic /near.data timeout 1 sec on_second_publisher unknown
input odd = topic /odd.data timeout 2 sec
input place = topic /odom.pose.pose.position timeout 3 sec
input scan = topic /scan mounted (0, 0, 1) m yaw 90 deg timeout 3 sec
zone yard = rectangle (0, 0) (4, 3) m "where it drives"
entity drive "moves" {
  out: not place.inside(yard);
  failsafe fast: speed > most and near for 2 sec;
  spare: odd or scan.missing();
  turning: speed in [0.1 m/s, 0.2 m/s] or near within 3 sec;
}
optional behaviour careful: if drive.turning then { slow; say("turns"); }
if drive.out then { stop; }
if drive.fast then { stop; }
if not drive.fast then { fine; }
gate /joy for 0.5 sec over /plan for 1 sec -> /cmd_vel : geometry_msgs.Twist rate 20 Hz {
  stop: zero until reset;
  slow: limit linear.x to [-0.1, 0.1] m/s;
  lost heartbeat for 0.3 sec: zero;
  resume on zero command
}
"""

ROBOT = """\
system Robot
topics
  external topic /odom : nav_msgs.Odometry
  external topic /odd : std_msgs.Bool
  external topic /near : std_msgs.Bool
  external topic /scan : sensor_msgs.LaserScan
  external topic /stop : std_msgs.Bool
  external topic /slow : std_msgs.Bool
  external topic /joy : geometry_msgs.Twist
  external topic /plan : geometry_msgs.Twist
  external topic /cmd_vel : geometry_msgs.Twist
"""


def load(folder: Path, text: str) -> Rules:
    """Return rules without errors, for a system beside them."""
    folder.mkdir(exist_ok=True)
    (folder / "robot.system").write_text(ROBOT)
    (folder / "robot.deros").write_text(text)
    found = without_errors(folder / "robot.deros")
    assert isinstance(found, Rules)
    return found


def changes(folder: Path, old: str, new: str) -> list[Change]:
    """Return the changes from one text to another."""
    return list(compare_rules(load(folder / "old", old), load(folder / "new", new)))


def edited(old: str, new: str) -> str:
    """Return the rules with one edit."""
    return with_edit(RULES, old, new)


EDITS = [
    # part, name, aspect, text, its replacement, breaks, breaks the other way round
    ("unit", "pace", "value", "0.5 m/s", "0.6 m/s", False, False),
    ("constant", "most", "value", "most = 1.0", "most = 0.9", False, False),
    ("constant", "most", "tunable", " tunable in [0.1, 1.0] m/s", "", True, False),
    ("constant", "most", "tunable", "[0.1, 1.0]", "[0.2, 1.0]", True, True),
    ("constant", "wait", "value", "1 sec\ninput", "2 sec\ninput", True, False),
    ("input", "speed", "timeout", "0.5 sec\ninput", "0.6 sec\ninput", True, False),
    ("input", "odd", "timeout", " timeout 2 sec", "", True, False),
    ("input", "speed", "source", "linear.x timeout", "linear.y timeout", False, False),
    ("input", "near", "unknown on second publisher", " on_second_publisher unknown", "", 1, 0),
    ("input", "scan", "mounted", "yaw 90 deg", "yaw 80 deg", False, False),
    ("input", "scan", "mounted", "mounted (0, 0, 1) m", "mounted (0, 0, 1) cm", False, False),
    ("zone", "yard", "shape", "(4, 3) m", "(4, 2) m", False, False),
    ("zone", "yard", "shape", "rectangle (0, 0) (4, 3)", "circle (0, 0) 4", False, False),
    ("zone", "yard", "description", "where it drives", "the hall", False, False),
    ("rule", "drive.fast", "condition", "speed > most", "speed >= most", False, False),
    ("rule", "drive.fast", "condition", "for 2 sec", "for 3 sec", True, False),
    ("rule", "drive.fast", "failsafe", "failsafe fast", "fast", True, False),
    ("rule", "drive.turning", "condition", "0.2 m/s]", "0.2 m/s)", False, False),
    ("action", "stop", "latched", " latched", "", True, False),
    ("action", "stop", "description", '"halts"', '"stops"', False, False),
    ("action", "stop", "publishes", "true on /stop", "false on /stop", True, True),
    ("behaviour", "careful", "condition", "if drive.turning", "if not drive.turning", 0, 0),
    ("behaviour", "careful", "body", '"turns"', '"curves"', False, False),
    ("gate", "/cmd_vel", "rate", "20 Hz", "30 Hz", False, False),
    ("gate", "/cmd_vel", "sources", "/joy for 0.5 sec", "/joy for 0.6 sec", True, True),
    ("gate", "/cmd_vel", "resume on zero command", "  resume on zero command\n", "", True, False),
    ("gate line", "/cmd_vel: stop", "effect", "zero until reset", "zero", True, False),
    ("gate line", "/cmd_vel: slow", "effect", "[-0.1, 0.1]", "[-0.2, 0.1]", False, False),
    ("gate line", "/cmd_vel: lost heartbeat", "effect", "0.3 sec", "0.4 sec", True, False),
]


@pytest.mark.parametrize(("part", "name", "aspect", "old", "new", "breaks", "back"), EDITS)
def test_edit_of_an_aspect_is_found_once(
    tmp_path: Path,
    part: str,
    name: str,
    aspect: str,
    old: str,
    new: str,
    breaks: bool,
    back: bool,
) -> None:
    """It is reported with its part, and breaks somebody in one or both directions."""
    other = edited(old, new)
    (there,) = changes(tmp_path, RULES, other)
    assert (there.kind, there.part, there.name, there.aspect) == ("changed", part, name, aspect)
    assert bool(there.breaks) == breaks, there
    (again,) = changes(tmp_path, other, RULES)
    assert (again.part, again.name, again.aspect) == (part, name, aspect)
    assert bool(again.breaks) == back, again


PARTS = [
    ("unit", "pace", "unit pace = 0.5 m/s\n", False),
    ("constant", "wait", "const wait = 1 sec\n", False),
    ("rule", "drive.spare", "  spare: odd or scan.missing();\n", True),
    ("behaviour", "if not drive.fast", "if not drive.fast then { fine; }\n", True),
    ("gate line", "/cmd_vel: slow", "  slow: limit linear.x to [-0.1, 0.1] m/s;\n", True),
]


@pytest.mark.parametrize(("part", "name", "line", "breaks"), PARTS)
def test_part_in_one_version_only_is_found_once(
    tmp_path: Path, part: str, name: str, line: str, breaks: bool
) -> None:
    """What is gone protects less; what is new breaks nobody."""
    without = edited(line, "")
    (gone,) = changes(tmp_path, RULES, without)
    assert (gone.kind, gone.part, gone.name, bool(gone.breaks)) == ("removed", part, name, breaks)
    (come,) = changes(tmp_path, without, RULES)
    assert (come.kind, come.part, come.name, come.breaks) == ("added", part, name, "")


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("most = 1.0 m/s", "most = 100 cm/s"),
        ("[0.1, 1.0] m/s", "[10 cm/s, 100 cm/s]"),
        ("(0, 0) (4, 3) m", "(0.0, 0)\n (400, 300) cm"),
        ("for 2 sec", "for 2000 ms"),
        ("timeout 1 sec", "timeout 1000 ms"),
        ("speed > most and near", "near and speed > most"),
        ("[0.1 m/s, 0.2 m/s] or near", "[10 cm/s, 20 cm/s] or near"),
        ("[-0.1, 0.1] m/s", "[-10 cm/s, 10 cm/s]"),
        ("0.3 sec: zero", "300 ms: zero"),
        ("if drive.fast then { stop; }", "if drive.fast // note\n then {\n stop }"),
        ("action fine\naction say(text)", "action say(text)\naction fine"),
    ],
)
def test_other_words_for_the_same_are_no_change(tmp_path: Path, old: str, new: str) -> None:
    """Units, layout, comments, and the order of declarations and operands."""
    assert changes(tmp_path, RULES, edited(old, new)) == []


def test_lost_action_of_a_behaviour_is_named(tmp_path: Path) -> None:
    """The body differs, too."""
    found = changes(tmp_path, RULES, edited("slow; say", "say"))
    assert [(each.aspect, each.breaks) for each in found] == [
        ("actions", "it does not trigger any more: slow"),
        ("body", ""),
    ]


def test_order_of_behaviours_is_a_change(tmp_path: Path) -> None:
    """Where two act at one instant, the one that is written first comes first."""
    one, other = "if drive.fast then { stop; }\n", "if not drive.fast then { fine; }\n"
    (found,) = changes(tmp_path, RULES, edited(one + other, other + one))
    assert (found.part, found.aspect, found.breaks) == ("behaviours", "order", "")


@pytest.mark.parametrize(
    "path", sorted((ROOT / "examples").rglob("*.deros")), ids=lambda path: path.stem
)
def test_example_does_not_differ_from_itself(path: Path) -> None:
    """Two loads of one file are two models that mean the same."""
    one, other = Repository().load(path).model, Repository().load(path).model
    assert isinstance(one, Rules)
    assert isinstance(other, Rules)
    assert list(compare_rules(one, other)) == []
