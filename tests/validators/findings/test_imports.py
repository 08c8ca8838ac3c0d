"""A file that cannot be imported gives one finding, and nothing that only follows from it."""

from __future__ import annotations

from pathlib import Path

import pytest

from deros.diagnostics import Diagnostic
from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from deros.validators.check import check

BASE = {
    "nodes/base.rnd": """\
node base : base_pkg
  executable "base"
parameters
  name top : double = 1.0 [m/s]
subscribes
  topic cmd_vel : geometry_msgs.Twist stops after 0.5 sec
  topic stop : std_msgs.Bool
  topic pump : std_msgs.Float64 { data [bar] } stops after 0.5 sec
publishes
  topic odom : nav_msgs.Odometry
  topic level : std_msgs.Float64 { data [bar] }
  topic heading : std_msgs.Float64 { data [rad wrapping] }
""",
    "nodes/planner.rnd": """\
node planner : planner_pkg
  executable "planner"
publishes
  topic cmd_vel : geometry_msgs.Twist
  topic pump : std_msgs.Float64 { data [bar] }
  topic button : demo_msgs.Button
""",
    "msgs/demo_msgs/msg/Button.msg": """\
bool pressed
float64 force
""",
    "arm.system": """\
system Arm
imports
  import "nodes/planner.rnd"
topics
  topic /cmd_wish
  topic /pump_wish
  topic /button
node planner : planner
wirings
  connect cmd_vel to /cmd_wish
  connect pump to /pump_wish
  connect button to /button
""",
    "robot.system": """\
system Robot
imports
  import "nodes/base.rnd"
  import "arm.system"
topics
  topic /cmd_vel
  topic /stop
  topic /odom
  topic /level
  topic /pump
  topic /heading
subsystem arm : Arm
node base : base
parameters
  param top = 0.5
wirings
  connect cmd_vel to /cmd_vel
  connect odom to /odom
  connect stop to /stop
  connect level to /level
  connect pump to /pump
  connect heading to /heading
safety "robot.deros"
""",
    "robot.deros": """\
use "robot.system" import Robot
action stop publishes true on /stop : std_msgs.Bool latched;
const limit = 0.5 m/s
input speed = topic /odom.twist.twist.linear.x timeout 0.3 sec
input level = topic /level.data timeout 0.3 sec
input heading = topic /heading.data timeout 0.3 sec
input pressed = topic /button.pressed timeout 0.3 sec
input force = topic /button.force timeout 0.3 sec
entity drive {
  fast: speed.abs() > limit or speed.unknown();
  over: level > 3 bar or level.unknown() or level * 2 + 1 bar > 7 bar;
  turn: heading.rate(0.1 sec).abs() > 20 deg/s or heading.unknown() or heading > 20 deg;
  button: pressed or force > 3 or force.unknown();
}
if drive.fast or drive.over or drive.turn or drive.button then { stop; };
gate /cmd_wish -> /cmd_vel : geometry_msgs.Twist rate 20 Hz {
  lost heartbeat for 0.3 sec: zero until reset;
  lost input for 0.5 sec: zero;
  stop: zero;
  resume on zero command;
}
gate /pump_wish -> /pump : std_msgs.Float64 rate 20 Hz {
  lost heartbeat for 0.3 sec: zero until reset;
  lost input for 0.5 sec: zero;
  stop: zero;
  resume on zero command;
}
""",
}
"""A robot whose rules read units, topics and types that only the files they import declare."""

MODELS = ("robot.system", "robot.deros")
UNREADABLE = {
    "missing": None,
    "empty": b"",
    "not a model": b"%%%\n",
    "not UTF-8": b"\xff\xfe\x00",
}


def _findings(folder: Path, *named: str) -> list[Diagnostic]:
    repository = Repository()
    models = [repository.load(str(folder / each)) for each in named or MODELS]
    return check(models, repository, InterfaceStore([folder / "msgs"], prefixes=()))


def _places(findings: list[Diagnostic]) -> list[tuple[str, str]]:
    return [(each.code.name, Path(each.span.file).name) for each in findings]


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    """Write the robot to a folder."""
    for name, text in BASE.items():
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    return tmp_path


def test_robot_has_no_findings(robot: Path) -> None:
    """All files together are sound."""
    assert _findings(robot) == []


@pytest.mark.parametrize("state", UNREADABLE)
@pytest.mark.parametrize(
    ("name", "importer"),
    [
        ("nodes/base.rnd", "robot.system"),
        ("nodes/planner.rnd", "arm.system"),
        ("arm.system", "robot.system"),
        ("robot.deros", "robot.system"),
        ("robot.system", "robot.deros"),
    ],
)
def test_unreadable_import_gives_one_finding(
    robot: Path, name: str, importer: str, state: str
) -> None:
    """It is at the import where there is no file, else in the file itself."""
    content = UNREADABLE[state]
    (robot / name).unlink()
    if content is not None:
        (robot / name).write_bytes(content)
    named = [importer] if importer != "arm.system" else MODELS
    (place,) = _places(_findings(robot, *named))
    code = {"missing": "DRS201", "not UTF-8": "DRS002"}.get(state, "DRS003")
    assert place == (code, importer if state == "missing" else Path(name).name)


@pytest.mark.parametrize(
    ("name", "old", "new", "place"),
    [
        ("robot.system", "nodes/base.rnd", "node/*.rnd", ("DRS201", "robot.system")),
        ("robot.system", "nodes/base.rnd", "nodes/b.*.rnd", ("DRS201", "robot.system")),
        ("robot.system", "nodes/base.rnd", "nodes/*safety_node.rnd", ("DRS201", "robot.system")),
        ("robot.system", "arm.system", "arms.system", ("DRS201", "robot.system")),
        ("robot.system", "robot.deros", "robo.deros", ("DRS201", "robot.system")),
        ("robot.system", ": Arm", ": Leg", ("DRS220", "robot.system")),
        ("robot.system", ": base", ": bass", ("DRS203", "robot.system")),
        ("robot.deros", "robot.system", "robo.system", ("DRS201", "robot.deros")),
        ("robot.deros", "import Robot", "import Robo", ("DRS321", "robot.deros")),
        ("nodes/planner.rnd", "demo_msgs", "demos_msgs", ("DRS101", "planner.rnd")),
        ("nodes/planner.rnd", "demo_msgs.Button", "demo_msgs.Bottom", ("DRS102", "planner.rnd")),
        ("nodes/planner.rnd", "std_msgs.Float64", "stdd_msgs.Float64", ("DRS101", "planner.rnd")),
        ("msgs/demo_msgs/msg/Button.msg", "force", "bool", ("DRS112", "planner.rnd")),
        ("msgs/demo_msgs/msg/Button.msg", "float64", "gone_msgs/Force", ("DRS112", "robot.deros")),
    ],
)
def test_misspelt_import_gives_one_finding(
    robot: Path, name: str, old: str, new: str, place: tuple[str, str]
) -> None:
    """So does a name of the file's content, and a message that its package lacks or spoils."""
    assert old in BASE[name]
    (robot / name).write_text(BASE[name].replace(old, new, 1), encoding="utf-8")
    assert _places(_findings(robot)) == [place]


@pytest.mark.parametrize(
    ("name", "old", "new", "code"),
    [
        ("robot.deros", "geometry_msgs.Twist rate", "std_msgs.Bool rate", "DRS334"),
        ("robot.deros", "level > 3 bar", "level > 3 bra", "DRS006"),
    ],
)
def test_what_does_not_follow_stays(robot: Path, name: str, old: str, new: str, code: str) -> None:
    """A mistake that no import can explain is found beside one that cannot be read."""
    assert old in BASE[name]
    text = BASE[name].replace(old, new, 1).replace("robot.system", "robo.system")
    (robot / name).write_text(text, encoding="utf-8")
    assert {each.code.name for each in _findings(robot, name)} == {"DRS201", code}
