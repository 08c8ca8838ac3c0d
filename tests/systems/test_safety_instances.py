"""``safety`` statements: the two files that refer to each other, and the nodes they stand for."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from deros.generators.api.protocol import Context
from deros.generators.api.registry import discover
from deros.generators.output.writer import write
from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from deros.models.node import NodeType
from deros.models.rules import Rules
from deros.models.system import System
from deros.rules.compiler.build import build
from deros.rules.program.outline import program_outline
from deros.systems.flat import FlatNode
from deros.systems.flatten import flatten, nodes_of_rules
from deros.systems.safety_instances import outline

pytestmark = pytest.mark.usefixtures("own_folder")

ROOT = Path(__file__).resolve().parents[2]
PROGRAMS = sorted(
    path
    for folder in ("examples", "tests/generators", "tests/faults/models", "tests/rules")
    for path in (ROOT / folder).rglob("*.deros")
)

RULES = """use "robot.system" import Robot
action stop publishes true on /stop : std_msgs.Bool latched;
action slow publishes true on slow : std_msgs.Bool;
input front = topic front.ranges[0] timeout 1 sec
entity e { near: front < 1 m or front.missing(); }
optional behaviour keep: if e.near then { stop; slow; };
gate wish -> command : geometry_msgs.Twist rate 20 Hz {
  stop: zero;
  slow: limit linear.x to [-0.1, 0.1] m/s;
  lost heartbeat for 0.3 sec: zero;
  lost input for 0.5 sec: zero;
}
"""
SYSTEM = """system Robot
topics
  external topic front : sensor_msgs.LaserScan
  external topic wish
  external topic command
"""


def system_with(statement: str, rules: str = RULES) -> System:
    """Load the system of the rules with the given ``safety`` statement."""
    Path("robot.deros").write_text(rules, encoding="utf-8")
    Path("robot.system").write_text(f"{SYSTEM}{statement}\n", encoding="utf-8")
    repository = Repository()
    loaded = repository.load("robot.system")
    assert repository.diagnostics == []
    assert isinstance(loaded.model, System)
    return loaded.model


def nodes_with(statement: str, rules: str = RULES) -> dict[str, FlatNode]:
    """Return the nodes of a statement by full name."""
    return {node.full_name: node for node in flatten(system_with(statement, rules)).nodes}


def topics(node: FlatNode) -> dict[str, str]:
    """Return the topic of each port."""
    return {end.port.name: end.topic for end in node.ports}


@pytest.mark.parametrize("first", ["robot.system", "robot.deros"])
def test_loading_either_file_loads_both(first: str) -> None:
    """The rules use the same system that names them, whichever file is loaded first."""
    system_with('safety "robot.deros"')
    repository = Repository()
    repository.load(first)
    system = repository.load("robot.system").model
    rules = repository.load("robot.deros").model
    assert isinstance(system, System)
    assert isinstance(rules, Rules)
    assert system.safety[0].rules is rules
    assert rules.uses[0].system is system
    assert len(repository.files) == 2
    assert repository.diagnostics == []


def test_statement_has_the_generated_names_and_topics_of_the_rules() -> None:
    """Safety node and gates have the generated names and the topics of the rules."""
    nodes = nodes_with('safety "robot.deros"')
    assert list(nodes) == ["/robot_safety_node", "/command_gate"]
    safety, gate = nodes.values()
    assert topics(safety) == {
        "/stop": "/stop",
        "/slow": "/slow",
        "~/heartbeat": "/robot_safety_node/heartbeat",
        "~/events": "/robot_safety_node/events",
        "/diagnostics": "/diagnostics",
        "/front": "/front",
        "~/reset": "/robot_safety_node/reset",
    }
    assert topics(gate) == {
        "/command": "/command",
        "/diagnostics": "/diagnostics",
        "/wish": "/wish",
        "/stop": "/stop",
        "/slow": "/slow",
        "robot_safety_node/heartbeat": "/robot_safety_node/heartbeat",
    }
    assert all(end.wiring is not None for node in nodes.values() for end in node.ports)


def test_attributes_apply_to_all_nodes() -> None:
    """Respawn, log level and namespace apply to each node; a parameter to nodes that have it."""
    nodes = nodes_with(
        'safety "robot.deros" as guard namespace /s respawn delay 1 sec log_level warn\n'
        "parameters\n"
        "  param publish_freq = 20.0\n  param lock_memory = true\n  param use_sim_time = true\n"
        "  param behaviours.keep.enabled = false\n  param unknown = 1\n"
    )
    safety, gate = nodes["/s/guard"], nodes["/s/command_gate"]
    for node in (safety, gate):
        assert node.instance.respawn is not None
        assert node.instance.log_level == "warn"
    assert [name for name, _ in safety.parameters] == [
        "publish_freq",
        "lock_memory",
        "use_sim_time",
        "behaviours.keep.enabled",
        "unknown",
    ]
    assert dict(gate.parameters) == {"lock_memory": True, "use_sim_time": True}


def test_groups_apply_to_all_nodes() -> None:
    """Parameters of groups go to the nodes that have them, and no others; the statement's win."""
    nodes = nodes_with(
        'subsystem s {\nenv A = "1" env B = "2"\nparameters\n  param publish_freq = 5.0\n'
        "  param lock_memory = true\n  param use_sim_time = true\n  param unknown = 1\n"
        'safety "robot.deros" as guard env A = "mine" prefix "nice"\n'
        "parameters\n  param publish_freq = 20.0\n}\n",
    )
    safety, gate = nodes["/guard"], nodes["/command_gate"]
    assert dict(safety.parameters) == {
        "publish_freq": 20.0,
        "lock_memory": True,
        "use_sim_time": True,
    }
    assert dict(gate.parameters) == {"lock_memory": True, "use_sim_time": True}
    for node in (safety, gate):
        assert {each.name: each.value.text for each in node.environment} == {"A": "mine", "B": "2"}
        assert node.instance.prefix is not None


def test_gates_follow_a_moved_heartbeat() -> None:
    """The gates read the heartbeat wherever it is; other private ports stay separate."""
    nodes = nodes_with(
        'safety "robot.deros" as guard\nwirings\n'
        "  connect ~/heartbeat to /beat\n  connect ~/events to ~/log\n"
        "  connect /diagnostics to /health\n"
    )
    safety, gate = topics(nodes["/guard"]), topics(nodes["/command_gate"])
    assert safety["~/heartbeat"] == "/beat" == gate["robot_safety_node/heartbeat"]
    assert safety["~/events"] == "/guard/log"
    assert safety["/diagnostics"] == "/health" == gate["/diagnostics"]


def test_target_determines_package_and_executable() -> None:
    """C++ packages and executables have other names; node names in the graph do not change."""
    for target, package, program in (
        ("", "robot_safety", "robot_safety_node"),
        ("target cpp", "robot_safety_cpp", "robot_safety_node_cpp"),
        ("package watch", "watch", "watch_node"),
        ("target cpp package watch", "watch_cpp", "watch_node_cpp"),
        ("target cpp package watch_cpp", "watch_cpp", "watch_node_cpp"),
    ):
        safety, gate = nodes_with(f'safety "robot.deros" {target}').values()
        assert safety.type is not None
        assert gate.type is not None
        assert (safety.type.package, safety.type.executable_name) == (package, program)
        assert gate.type.package == package
        assert gate.full_name == "/command_gate"
        beat = f"{package.removesuffix('_cpp')}_node/heartbeat"
        assert topics(gate)[beat] == topics(safety)["~/heartbeat"]


def test_relative_topics_follow_the_namespace() -> None:
    """With two robots, relative topics go under each namespace and absolute ones do not."""
    system_with('subsystem Safety namespace guards { safety "robot.deros" }')
    Path("two.system").write_text(
        'system Two imports import "robot.system"\n'
        "subsystem left : Robot namespace /left\nsubsystem right : Robot namespace /right\n",
        encoding="utf-8",
    )
    model = Repository().load("two.system").model
    assert isinstance(model, System)
    nodes = {node.full_name: topics(node) for node in flatten(model).nodes}
    assert list(nodes) == [
        "/left/guards/robot_safety_node",
        "/left/guards/command_gate",
        "/right/guards/robot_safety_node",
        "/right/guards/command_gate",
    ]
    safety, gate = nodes["/left/guards/robot_safety_node"], nodes["/left/guards/command_gate"]
    assert (safety["/front"], safety["/slow"], safety["/stop"]) == (
        "/left/front",
        "/left/slow",
        "/stop",
    )
    assert (gate["/wish"], gate["/command"]) == ("/left/wish", "/left/command")
    assert gate["robot_safety_node/heartbeat"] == "/left/guards/robot_safety_node/heartbeat"


def test_rules_may_read_actions_of_other_rules() -> None:
    """The type of such an input comes from the other safety node, in either order."""
    Path("second.deros").write_text(
        'use "robot.system" import Robot\n'
        "action halt publishes true on /halt : std_msgs.Bool;\n"
        "input stopped = topic /stop.data timeout 1 sec\n"
        "entity e { now: stopped or stopped.missing(); }\n"
        "if e.now then { halt; };\n",
        encoding="utf-8",
    )
    for statements in (
        '"robot.deros" safety "second.deros"',
        '"second.deros" safety "robot.deros"',
    ):
        second = nodes_with(f"safety {statements}")["/second_safety_node"]
        (end,) = (end for end in second.ports if end.port.name == "/stop")
        assert end.port.type.short == "std_msgs.Bool"
        assert end.port.qos is not None
        assert end.port.qos.reliability == "reliable"


def test_rules_with_a_syntax_error_give_one_unknown_node() -> None:
    """The error is reported once, at its place."""
    Path("robot.deros").write_text("use use", encoding="utf-8")
    Path("robot.system").write_text(f'{SYSTEM}safety "robot.deros"\n', encoding="utf-8")
    repository = Repository()
    model = repository.load("robot.system").model
    assert isinstance(model, System)
    (node,) = flatten(model).nodes
    assert node.type is None
    assert [(d.code.name, d.span.file) for d in repository.diagnostics] == [
        ("DRS003", "robot.deros")
    ]


def test_missing_rules_are_reported_at_the_statement() -> None:
    """The finding is that of a missing import."""
    Path("robot.system").write_text(f'{SYSTEM}safety "robt.deros"\n', encoding="utf-8")
    Path("robot.deros").write_text(RULES, encoding="utf-8")
    repository = Repository()
    repository.load("robot.system")
    (finding,) = repository.diagnostics
    assert (finding.code.name, finding.hint) == ("DRS201", "did you mean 'robot.deros'?")


@pytest.mark.parametrize("path", PROGRAMS, ids=lambda path: path.name)
def test_nodes_are_the_same_from_source_and_program(path: Path) -> None:
    """Checks and launch files describe the same nodes that the generators emit."""
    repository = Repository()
    model = repository.load(path).model
    assert isinstance(model, Rules)
    built = build(model, InterfaceStore())
    if built.program is None:
        pytest.skip("rules with an error")

    def type_of(topic: str) -> object:
        known = built.topics.get(topic)
        return known.type if known is not None else None

    written = outline(model, type_of)  # type: ignore[arg-type]
    program = program_outline(built.program, written.start)
    assert {each.topic: each for each in written.inputs} == {
        each.topic: each for each in program.inputs
    }
    assert (written.name, written.states, written.latched) == (
        program.name,
        program.states,
        program.latched,
    )
    assert (written.optional, written.gates) == (program.optional, program.gates)


@pytest.mark.parametrize("target", ["python", "cpp"])
@pytest.mark.parametrize("name", ["intelligent_one", "feeding_robot", "frobit", "kobuki"])
def test_nodes_of_the_statement_match_the_generated_ones(
    name: str, target: str, tmp_path: Path
) -> None:
    """Names, packages, parameters and ports with their QoS."""
    rules = ROOT / "examples" / name / f"{name}.deros"
    repository = Repository()
    model = repository.load(rules).model
    assert isinstance(model, Rules)
    generator = discover().find("deros", target)
    assert generator is not None
    write(generator(model, Context(InterfaceStore(), repository)), tmp_path)
    described = {path.stem: Repository().load(path).model for path in tmp_path.rglob("*.rnd")}
    assert len(described) == 2  # the safety node and its gate
    for node in nodes_of_rules(model, target):
        printed = described[node.name]
        assert isinstance(printed, NodeType)
        assert {(p.kind, p.name): p for p in printed.ports} == {
            (p.kind, p.name): p for p in node.ports
        }
        assert printed.parameters == node.parameters
        assert (printed.package, printed.name) == (node.package, node.name)


def test_statement_attributes_may_have_any_order() -> None:
    """Each attribute may be given once, as for nodes."""
    attributes = ['"A text"', "respawn", "as guard", "target cpp", "namespace /n"]
    for shift in range(len(attributes)):
        order = " ".join(attributes[shift:] + attributes[:shift])
        assert "/n/guard" in nodes_with(f'safety "robot.deros" {order};')
    Path("robot.system").write_text(f'{SYSTEM}safety "robot.deros" as a as b\n', encoding="utf-8")
    repository = Repository()
    repository.load("robot.system")
    (finding,) = repository.diagnostics
    assert finding.code.name == "DRS109"
    assert re.search("'as' is given twice", finding.message)
