"""The files of C++ gates, as part of the package of their safety node."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest

from deros import codes
from deros.generators.api.protocol import Context, Files, GenerationError, Owner
from deros.generators.output.writer import write
from deros.generators.safety_package.python.generate import generate as generate_python
from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from deros.models.node import NodeType
from deros.models.rules import Rules
from tests.support.cpp import message_flags
from tests.support.cpp_lint import assert_cpp_lint_clean
from tests.support.gate_cpp import STRICT
from tests.support.gate_cpp_nodes import PACKAGE, gate_package
from tests.support.gate_nodes import MODELS
from tests.support.golden import Golden
from tests.support.golden_alike import parts_of, unlike_those_before
from tests.support.needs import may_run, needs

GATES = (
    *("cmd_vel_gate", "arm_command_gate", "wheels_command_gate", "crane_command_gate"),
    "lamp_command_gate",
    "boat_command_gate",
    "tractor_command_gate",
)
REVIEWED = (*GATES[:4], "tractor_command_gate")
"""The gates whose text is compared with one that has been read."""

HEAD = """
use "robot.system" import Robot
action stop publishes true on /stop : std_msgs.Bool latched;
action slow publishes 1 on /mode : std_msgs.UInt8 latched;
action hold publishes false on /limit : std_msgs.Bool latched;
action follow publishes "a \\\\ ??/ b" on /class : std_msgs.String latched;
action far publishes 0.1 on /far : std_msgs.Float32 latched;
action deep publishes -9223372036854775808 on /deep : std_msgs.Int64 latched;
input v = topic /speed.data
entity e { r: v > 0.5 m/s; }
if e.r then { stop; slow; hold; follow; far; deep; };
"""

KINDS = [
    "geometry_msgs.Twist rate 20 Hz { stop: zero; }",
    "geometry_msgs.TwistStamped rate 20 Hz { hold: limit twist.linear.x to [0, 1]; }",
    "std_msgs.Int32 rate 5 Hz { slow: limit data to [-3, 3]; follow: hold; far: silence; }",
    "std_msgs.Byte rate 5 Hz { slow: limit data to [0, 3]; }",
    "std_msgs.Float32 rate 5 Hz { deep: limit data to [-0.1, 1e30]; stop: send { data = 0.1 }; }",
    "std_msgs.UInt64 rate 5 Hz { stop: limit data to [0, 18446744073709551615]; }",
    "std_msgs.Int64 rate 5 Hz { stop: limit data to [-9223372036854775808, 0]; }",
    "geometry_msgs.Twist rate 20 Hz { stop: zero ramp linear.x 1 m/s2; hold: hold; }",
    'std_msgs.String rate 20 Hz { stop: send { data = "off" }; resume on zero command; }',
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
    "diagnostic_msgs.DiagnosticArray rate 5 Hz { stop: silence; hold: send { status = [] }; }",
    "trajectory_msgs.MultiDOFJointTrajectory rate 1000 Hz { stop: hold;"
    " lost input for 9000000000 sec: limit points[0].velocities[0].linear.x to [-1, 1]; }",
]
"""Gates of every combination of lines and types."""


@pytest.fixture(scope="module")
def files() -> Files:
    """Return the files of the model with all kinds of gates."""
    return gate_package((MODELS / "gates.deros").read_text(encoding="utf-8"))


@pytest.mark.essential
def test_files_match_golden(golden: Golden, files: Files) -> None:
    """Table, messages, node, program and description match the reviewed text."""
    own = {f"{gate}{end}" for gate in REVIEWED for end in (".hpp", ".cpp", "_cpp.rnd")}
    ends = ("_message.hpp", "_message.cpp", "_table.hpp")
    own |= {f"{gate}{end}" for gate in REVIEWED for end in ends}
    own.add("cmd_vel_gate_main.cpp")
    kept = {path: file for path, file in files.items() if Path(path).name in own}
    assert len(kept) == len(own)
    parts = parts_of("gate_cpp/gates", "gates", REVIEWED, kept)
    golden.check("gate_cpp/gates", unlike_those_before("gate_cpp/gates", parts))


def write_kinds(folder: Path) -> None:
    """Write all kinds of gates, and those of the model."""
    for number, kind in enumerate(KINDS):
        text = f"{HEAD}gate /wish/of/somebody -> /command : {kind}"
        write(gate_package(text, name=f"kind_{number}"), folder)
    write(gate_package((MODELS / "gates.deros").read_text(encoding="utf-8")), folder)


@may_run("cppcheck")
def test_files_pass_the_ament_linters(tmp_path: Path) -> None:
    """uncrustify, cpplint and cppcheck with ament's settings accept all files of gates."""
    write_kinds(tmp_path)
    for shared in tmp_path.glob("kind_*/**/runtime/*"):
        shared.unlink()  # it is already in the package of the model
    assert_cpp_lint_clean(tmp_path)


@pytest.mark.parametrize(
    "compiler",
    [
        pytest.param("g++", marks=needs("g++")),
        pytest.param("clang++", marks=[needs("clang++"), pytest.mark.slow]),
    ],
    ids=["gcc", "clang"],
)
def test_every_kind_of_gate_compiles_strictly(compiler: str, tmp_path: Path) -> None:
    """No combination of lines and types causes a compiler warning; nor does the model."""
    write_kinds(tmp_path)
    sources = sorted(tmp_path.rglob("*_message.cpp"))
    logic = next(tmp_path.rglob("gates_safety_cpp/src/runtime/gate_logic.cpp"))
    assert len(sources) == len(KINDS) + len(GATES)
    packages = sorted(path for path in tmp_path.iterdir() if path.is_dir())
    folders = [flag for path in packages for flag in ("-I", str(path / "include"))]
    # A single file would read each header only once; the model's gates share helper names.
    of_model, of_kinds = sources[: len(GATES)], sources[len(GATES) :]
    assert all("kind_" in source.parts[-3] for source in of_kinds)
    tables = [
        f'#include "{path.parent.name}/{path.name}"\n'
        for path in tmp_path.rglob("*_gate_table.hpp")
    ]
    assert len(tables) == len(sources)
    for group in ([logic, of_model[0], *of_kinds], *([source] for source in of_model[1:])):
        together = tmp_path / "together.cpp"
        text = "".join(f'#include "{each}"\n' for each in group)
        together.write_text(text + "".join(sorted(tables)), encoding="utf-8")
        command = [compiler, "-std=c++17", "-fsyntax-only", *STRICT]
        command += [*folders, *message_flags(), str(together)]
        done = subprocess.run(command, capture_output=True, text=True, timeout=300, check=False)
        assert done.returncode == 0, done.stderr[:5000]


def test_cpp_gate_corresponds_to_the_python_gate(files: Files) -> None:
    """The node type ends in _cpp; ports, QoS and parameters are the same."""
    context = Context(InterfaceStore(), Repository())
    model = context.repository.load(MODELS / "gates.deros").model
    assert isinstance(model, Rules)
    python = generate_python(model, context, {})
    for gate in GATES:
        text = files[f"{PACKAGE}/{gate}_cpp.rnd"].text
        loaded = Repository().load_text(f"{gate}_cpp.rnd", text)
        assert loaded.diagnostics == ()
        assert isinstance(loaded.model, NodeType)
        assert (loaded.model.name, loaded.model.package) == (f"{gate}_cpp", PACKAGE)
        described = python[f"gates_safety/{gate}.rnd"].text
        other = Repository().load_text(f"{gate}.rnd", described).model
        assert isinstance(other, NodeType)
        assert loaded.model.ports == other.ports
        assert loaded.model.parameters == other.parameters


def test_node_name_is_that_of_the_python_gate(files: Files) -> None:
    """Lock, topics and remappings are therefore the same."""
    base = files[f"{PACKAGE}/src/cmd_vel_gate_base.cpp"].text
    assert 'Node("cmd_vel_gate", options)' in base


def test_every_line_of_the_rules_is_a_row(files: Files) -> None:
    """Each line of the rules is quoted in its row of the table, with its place."""
    table = files[f"{PACKAGE}/include/{PACKAGE}/cmd_vel_gate_table.hpp"].text
    unbroken = re.sub(r'"\n *"', "", table)
    rules = (MODELS / "gates.deros").read_text(encoding="utf-8").splitlines()
    for number in range(24, 29):
        assert f'"{rules[number - 1].strip().rstrip(";")} (gates.deros:{number})",' in unbroken
    assert table.count("runtime::Severity::") == 5


def test_program_disables_shared_memory(files: Files) -> None:
    """It selects UDP before anything of ROS 2 starts, unless configured otherwise."""
    main = files[f"{PACKAGE}/src/cmd_vel_gate_main.cpp"].text
    chosen, _, rest = main.partition('::setenv("FASTDDS_BUILTIN_TRANSPORTS", "UDPv4", 0);')
    assert "run<" not in chosen
    assert "run<" in rest


def test_gates_have_no_user_files(files: Files) -> None:
    """All files of a gate except the manifest belong to the generator."""
    owned = {path for path, file in files.items() if file.owner is Owner.USER}
    assert owned == {"gates_safety_cpp/package.xml"}


def test_licence_is_above_every_source() -> None:
    """With a copyright holder, each C++ file has the header."""
    text = (MODELS / "gates.deros").read_text(encoding="utf-8")
    generated = gate_package(text, {"copyright": "2026 A. Robot"})
    for path, file in generated.items():
        if path.endswith((".cpp", ".hpp")):
            assert file.text.startswith("// Copyright 2026 A. Robot"), path


def test_topics_that_differ_only_in_slashes_are_rejected() -> None:
    """Two ports of one gate cannot share the names derived from them."""
    text = f"{HEAD}gate /mode/x -> /mode_x : geometry_msgs.Twist rate 5 Hz {{ stop: zero; }}\n"
    with pytest.raises(GenerationError) as caught:
        gate_package(text)
    (finding,) = caught.value.diagnostics
    assert finding.code is codes.NAME_COLLISION
