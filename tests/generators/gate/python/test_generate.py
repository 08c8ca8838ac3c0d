"""The files of gates, in the package of their safety node."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest

from deros import codes
from deros.generators.api.protocol import Files, GenerationError, Owner
from deros.generators.output.writer import write
from deros.generators.safety_package.python.generate import generate
from deros.metamodels.load import Repository
from deros.models.node import NodeType
from tests.support.gate_nodes import MODELS, write_gates
from tests.support.generating import output_of
from tests.support.golden import Golden
from tests.support.golden_alike import parts_of, unlike_those_before
from tests.support.lint import assert_lint_clean

DOCS = Path(__file__).resolve().parents[4] / "docs"

GATES = (
    "cmd_vel_gate",
    "arm_command_gate",
    "wheels_command_gate",
    "lamp_command_gate",
    "boat_command_gate",
    "crane_command_gate",
    "tractor_command_gate",
)
REVIEWED = (*GATES[:4], "tractor_command_gate")
"""The gates whose text is compared with one that has been read."""

HEAD = """
use "robot.system" import Robot
action stop publishes true on /stop : std_msgs.Bool latched;
action slow publishes 1 on /mode : std_msgs.UInt8 latched;
action go publishes false on /hold : std_msgs.Bool latched;
input v = topic /speed.data
entity e { r: v > 0.5 m/s; }
if e.r then { stop; slow; go; };
"""


def files_of(text: str, **options: str) -> Files:
    """Return the generated files of rules that are next to the models."""
    return output_of(generate, str(MODELS / "text.deros"), text, **options)


@pytest.fixture(scope="module")
def files() -> Files:
    """Return the files of the model with all kinds of gates."""
    return files_of((MODELS / "gates.deros").read_text(encoding="utf-8"))


def test_files_match_golden(golden: Golden) -> None:
    """Table, messages, node and description match the reviewed text."""
    generated = output_of(generate, MODELS / "gates.deros")
    ends = (".py", ".rnd", "_message.py", "_table.py")
    own = {f"{gate}{end}" for gate in REVIEWED for end in ends}
    kept = {path: file for path, file in generated.items() if Path(path).name in own}
    assert len(kept) == len(own)
    parts = parts_of("gate_python/gates", "gates", REVIEWED, kept)
    golden.check("gate_python/gates", unlike_those_before("gate_python/gates", parts))


def test_files_pass_the_ament_linters(tmp_path: Path) -> None:
    """flake8 and pep257 with ament's settings accept all files of gates."""
    assert_lint_clean(write_gates(tmp_path))


KINDS = (
    "geometry_msgs.Twist rate 20 Hz { stop: zero; }",
    "geometry_msgs.TwistStamped rate 20 Hz { go: limit twist.linear.x to [0, 1]; }",
    "geometry_msgs.Twist rate 20 Hz { stop: zero ramp linear.x 1 m/s2; go: hold; }",
    'std_msgs.String rate 20 Hz { stop: send { data = "off" }; resume on zero command; }',
    "std_msgs.Int32 rate 5 Hz { slow: limit data to [-3, 3]; }",
    "geometry_msgs.Twist rate 5 Hz { always: limit linear.x to [-v, v]; slow: hold; }",
    "std_msgs.Byte rate 5 Hz { always: limit data to [0, v]; }",
    "std_msgs.Byte rate 5 Hz { slow: limit data to [0, 3]; }",
    "std_msgs.Float64MultiArray rate 5 Hz { lost input for 1 sec: send { data = [] }; }",
    "std_msgs.Float64MultiArray rate 5 Hz {"
    " lost heartbeat for 1 sec: limit data[0] to [-1, 1], data[12] to [0, 1];"
    " lost heartbeat for 2 sec: hold; stop: send { data[1] = 1 }; slow: limit data[3] to [0, 1];"
    " resume on zero command; }",
    "sensor_msgs.JointState rate 5 Hz {"
    " lost input for 1 sec: limit velocity[0] to [-1, 1], velocity[1] to [-1, 1],"
    " velocity[2] to [-1, 1], velocity[3] to [-1, 1], effort[0] to [-1, 1],"
    " effort[1] to [-1, 1], effort[2] to [-1, 1], effort[3] to [-1, 1]; }",
    "nav_msgs.Odometry rate 5 Hz { stop: limit twist.covariance[3] to [-1, 1]; }",
    "diagnostic_msgs.DiagnosticArray rate 5 Hz { stop: silence; go: send { status = [] }; }",
    "trajectory_msgs.MultiDOFJointTrajectory rate 1000 Hz { stop: hold; lost input for 1 s:"
    " limit points[0].velocities[0].linear.x to [-1, 1]; }",
)
"""Combinations of lines and types."""


def test_every_kind_of_gate_is_lint_clean(tmp_path: Path) -> None:
    """No combination of lines and types leaves an unused import, name or empty block behind."""
    for number, gate in enumerate(KINDS):
        files = files_of(f"{HEAD}gate /wish/of/somebody -> /command : {gate}", runtime="package")
        write(files, tmp_path / f"kind_{number}")
    assert_lint_clean(tmp_path)


def test_gate_is_a_node_of_the_package(files: Files) -> None:
    """It has a program, a launch file, and a description that parses to the same node."""
    setup = files["text_safety/setup.py"].text
    for gate in GATES:
        assert f"'{gate} = text_safety.{gate}:main'" in setup
        assert f"text_safety/launch/{gate}.launch.py" in files
        text = files[f"text_safety/{gate}.rnd"].text
        loaded = Repository().load_text(f"{gate}.rnd", text)
        assert loaded.diagnostics == ()
        assert isinstance(loaded.model, NodeType)
        assert loaded.model.name == gate
    assert "<exec_depend>trajectory_msgs</exec_depend>" in files["text_safety/package.xml"].text


def test_ports_follow_from_the_lines(files: Files) -> None:
    """Command input and output, topics of the named actions, the heartbeat if a line needs it."""
    text = files["text_safety/lamp_command_gate.rnd"].text
    node = Repository().load_text("lamp_command_gate.rnd", text).model
    assert isinstance(node, NodeType)
    names = [port.name for port in node.ports]
    assert names == ["/lamp/command", "/diagnostics", "/lamp/goal", "/stop"]
    text = files["text_safety/cmd_vel_gate.rnd"].text
    assert "topic text_safety_node/heartbeat : std_msgs.UInt64 qos reliable depth 10" in text
    assert "topic /cmd_vel_nav : geometry_msgs.Twist qos reliable depth 10" in text
    assert "topic /lamp/goal : std_msgs.Int32 qos best_effort depth 10" in (
        files["text_safety/lamp_command_gate.rnd"].text
    )


def test_every_line_of_the_rules_is_a_row(files: Files) -> None:
    """Each line of the rules is quoted in its row of the table, with its place."""
    table = files["text_safety/text_safety/cmd_vel_gate_table.py"].text
    unbroken = re.sub(r"'\s*'", "", table)
    rules = (MODELS / "gates.deros").read_text(encoding="utf-8").splitlines()
    for number in range(24, 29):
        assert f"'{rules[number - 1].strip().rstrip(';')} (text.deros:{number})'" in unbroken
    assert table.count(" Line(") == 5


def test_tables_of_the_page_are_those_that_are_generated() -> None:
    """That of its gate, and the rows of one whose limit is an input."""
    page = (DOCS / "gate.md").read_text(encoding="utf-8")
    gate = re.findall(r"^```deros\n(.*?)^```", page, re.DOTALL | re.MULTILINE)[0]
    whole, rows = re.findall(r"^```python\n(.*?)^```", page, re.DOTALL | re.MULTILINE)[:2]
    head = (
        HEAD.replace("slow", "low_speed") + "input speed_limit = topic /speed.data timeout 0.5 sec"
    )
    limits = "always: limit linear.x to [-0.2 m/s, speed_limit];"
    for lines, shown in ((gate, whole), (gate.replace("stop: zero;", limits), rows)):
        text = head + "\n" * (22 - head.count("\n")) + lines
        files = output_of(generate, str(MODELS / "robot.deros"), text)
        table = ast.parse(files["robot_safety/robot_safety/cmd_vel_gate_table.py"].text)
        calls = {
            ast.unparse(each) for each in ast.walk(table) if isinstance(each, ast.stmt | ast.Call)
        }
        for statement in ast.parse(shown).body:
            assert ast.unparse(statement) in calls


def test_line_about_the_heartbeat_is_severe_however_it_is_written() -> None:
    """What a line is about decides, not how its text begins."""
    lines = "stop: zero; lost /* all */ heartbeat for 1 sec: zero; lost input for 1 sec: zero;"
    files = files_of(f"{HEAD}gate /a -> /b : geometry_msgs.Twist rate 5 Hz {{ {lines} }}")
    table = files["text_safety/text_safety/b_gate_table.py"].text
    severe = [row for row in table.split(" Line(") if "is_severe=True" in row]
    assert len(severe) == 1
    assert "lost='heartbeat'" in severe[0]


def test_gates_have_no_user_files(files: Files) -> None:
    """All files of a gate belong to the generator."""
    for path, file in files.items():
        if "_gate" in path:
            assert file.owner is Owner.GENERATOR


def test_rules_without_gates_have_no_gate_files() -> None:
    """Nothing of gates is generated for them."""
    assert not [path for path in files_of(HEAD) if "gate" in path]


def test_two_gates_of_one_name_are_rejected() -> None:
    """Topics that differ only in slashes would give one node type."""
    text = "gate /a -> /b/c : geometry_msgs.Twist rate 5 Hz { stop: zero; }\n"
    text += "gate /d -> /b_c : geometry_msgs.Twist rate 5 Hz { stop: zero; }"
    with pytest.raises(GenerationError) as caught:
        files_of(HEAD + text)
    (finding,) = caught.value.diagnostics
    assert finding.code is codes.NAME_COLLISION
    assert "'/b/c'" in finding.message
    assert "'/b_c'" in finding.message
