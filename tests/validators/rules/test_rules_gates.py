"""Gates in systems: sound wiring has no findings, and unknown parts are not reported."""

from __future__ import annotations

from pathlib import Path

import pytest

from deros.diagnostics import Diagnostic
from tests.support.checks import checked
from tests.support.cli import deros

NODES = {
    "planner.rnd": "node planner : demo\npublishes\n  topic wish : geometry_msgs.Twist\n",
    "drive.rnd": "node drive : demo\nsubscribes\n"
    "  topic cmd_vel : geometry_msgs.Twist stops after 0.5 sec\n",
    "cmd_vel_gate.rnd": "node cmd_vel_gate : demo\n"
    "publishes\n"
    "  topic /cmd_vel : geometry_msgs.Twist qos reliable depth 10\n"
    "  topic /diagnostics : diagnostic_msgs.DiagnosticArray qos reliable depth 10\n"
    "subscribes\n"
    "  topic /nav : geometry_msgs.Twist qos best_effort depth 10\n"
    "  topic /stop : std_msgs.Bool qos reliable transient_local depth 1\n"
    "  topic s_safety_node/heartbeat : std_msgs.UInt64 qos reliable depth 10\n",
}
PLANNER = "node planner : planner\nwirings\n  connect wish to /nav\n"
DRIVE = "node drive : drive\nwirings\n  connect cmd_vel to /cmd_vel\n"
GATE = """node gate : cmd_vel_gate
wirings
  connect /nav to /nav
  connect /cmd_vel to /cmd_vel
  connect /stop to /stop
  connect s_safety_node/heartbeat to /heartbeat
  connect /diagnostics to /diagnostics
"""
TOPICS = """  topic /nav
  topic /cmd_vel
  topic /stop
  external topic /v : std_msgs.Float64
  external topic /heartbeat
  external topic /diagnostics
"""
IMPORTS = "".join(f'  import "{name}"\n' for name in NODES)
RULES = """use "s.system" import S
action stop publishes true on /stop : std_msgs.Bool latched;
const crawl = 0.1 m/s
input v = topic /v.data timeout 1 sec
entity e { fast: v > 1 or v.missing(); }
if e.fast then { stop; };
gate /nav -> /cmd_vel : geometry_msgs.Twist rate 20 Hz {
  stop: limit linear.x to [-crawl, crawl];
  lost heartbeat for 0.3 sec: zero;
  lost input for 0.5 sec: zero;
  resume on zero command;
}
"""


@pytest.fixture(autouse=True)
def _nodes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    for name, text in NODES.items():
        Path(name).write_text(text, encoding="utf-8")


def _findings(members: str, topics: str = TOPICS, rules: str = RULES) -> list[Diagnostic]:
    """Check rules together with the system that they use."""
    system = f"system S\nimports\n{IMPORTS}topics\n{topics}{members}"
    Path("s.system").write_text(system, encoding="utf-8")
    Path("s.deros").write_text(rules, encoding="utf-8")
    # The system may leave imports unused.
    return [each for each in checked("s.deros") if each.code.name != "DRS222"]


def _codes(members: str, topics: str = TOPICS, rules: str = RULES) -> list[str]:
    return [finding.code.name for finding in _findings(members, topics, rules)]


def test_sound_gate_has_no_findings() -> None:
    """A gate between controller and drive is sound, and its constants and actions count as used."""
    assert _findings(PLANNER + GATE + DRIVE) == []


def test_cpp_gate_has_no_findings() -> None:
    """The C++ gate has a longer node type and the same checks."""
    text = Path("cmd_vel_gate.rnd").read_text(encoding="utf-8")
    renamed = text.replace("node cmd_vel_gate : demo", "node cmd_vel_gate_cpp : demo_cpp")
    Path("cmd_vel_gate.rnd").write_text(renamed, encoding="utf-8")
    assert _findings(PLANNER + GATE.replace(": cmd_vel_gate", ": cmd_vel_gate_cpp") + DRIVE) == []


def test_external_target_has_no_findings() -> None:
    """An external drive is declared as such; the gate may then be external too."""
    topics = TOPICS.replace("topic /cmd_vel", "external topic /cmd_vel")
    assert _codes(PLANNER + GATE, topics) == []
    assert _codes(PLANNER, topics.replace("  topic /stop\n", "")) == []


def test_external_source_has_no_findings() -> None:
    """An external source topic is not a fault of the rules."""
    topics = TOPICS.replace("topic /nav", "external topic /nav")
    assert _codes(GATE + DRIVE, topics) == []


def test_unused_target_is_one_finding() -> None:
    """If nothing uses the target, the missing gate itself is not reported."""
    topics = TOPICS.replace("  topic /cmd_vel\n", "").replace("  topic /stop\n", "")
    assert _codes(PLANNER, topics) == ["DRS341"]


def test_missing_gate_is_one_finding() -> None:
    """The finding does not repeat that ends are missing or that source and target are joined."""
    (finding,) = _findings(PLANNER + DRIVE, TOPICS.replace("  topic /stop\n", ""))
    assert finding.code.name == "DRS340"
    assert "no node is a 'cmd_vel_gate'" in finding.message
    assert [each.span.file for each in finding.related] == ["s.system"]


def test_bypass_is_reported_at_its_connection() -> None:
    """The span is the connection that must change, even if there is a gate next to it."""
    joystick = "node joystick : planner\nwirings\n  connect wish to /cmd_vel\n"
    (finding,) = _findings(PLANNER + GATE + DRIVE + joystick)
    assert (finding.code.name, finding.span.file) == ("DRS339", "s.system")
    assert finding.span.text == "connect wish to /cmd_vel"


def test_unwired_bypass_is_reported_at_its_node() -> None:
    """A port that publishes on the target by its own name is reported at its node."""
    Path("planner.rnd").write_text(
        "node planner : demo\npublishes\n  topic /cmd_vel : geometry_msgs.Twist"
    )
    findings = _findings("node planner : planner\n" + GATE + DRIVE)
    assert ("DRS339", "planner") in [(each.code.name, each.span.text) for each in findings]


def test_gate_on_wrong_topics_is_reported_at_its_connection() -> None:
    """A gate that reads or feeds other topics is reported where it is connected."""
    wrong = GATE.replace("connect /nav to /nav", "connect /nav to /wish")
    topics = TOPICS + "  external topic /wish : geometry_msgs.Twist\n"
    (finding,) = _findings(PLANNER + wrong + DRIVE, topics)
    assert (finding.code.name, finding.span.file, finding.span.text) == (
        "DRS354",
        "s.system",
        "/wish",
    )


def test_unknown_node_type_may_be_the_gate() -> None:
    """The unknown type is reported, and the missing gate is not."""
    assert "DRS340" not in _codes(PLANNER + DRIVE + "node gate : cmd_vel_gaet\n")


def test_unpublished_source_is_reported() -> None:
    """The source of a gate needs a publisher, as inputs do."""
    assert "DRS318" in _codes(GATE + DRIVE)


def test_gates_can_be_chained() -> None:
    """The target of one gate may be the source of the next."""
    second = RULES[RULES.index("gate ") :].replace("/cmd_vel", "/drive").replace("/nav", "/cmd_vel")
    text = NODES["cmd_vel_gate.rnd"].replace("cmd_vel", "drive").replace("/nav", "/cmd_vel")
    reliable = text.replace(
        "best_effort", "reliable"
    )  # matches the publisher of the gate before it
    Path("drive.rnd").write_text(reliable, encoding="utf-8")
    members = GATE.replace("cmd_vel", "drive").replace("/nav", "/cmd_vel")
    members = members.replace("node gate", "node second")
    topics = f"{TOPICS}  external topic /drive\n"
    assert _findings(PLANNER + GATE + members, topics, RULES + second) == []


def test_unwired_gate_does_not_block_generation() -> None:
    """``generate`` succeeds with a warning, and ``check`` fails."""
    assert _codes(PLANNER + DRIVE, TOPICS.replace("  topic /stop\n", "")) == ["DRS340"]
    assert deros("check", "s.deros").code == 1
    outcome = deros("generate", "s.deros", "--target", "python", "-o", "out")
    assert "DRS340" in outcome.err
    assert outcome.code == 0, outcome.err


HEARTBEAT, INPUT = "lost heartbeat for 0.3 sec: zero", "lost input for 0.5 sec: zero"
RESUME = "resume on zero command;"


def _resuming(*lines: str, stop: str = "latched") -> list[tuple[str, list[str]]]:
    """Return the causes after which a gate resumes by itself, and the related lines."""
    head = RULES.partition("gate /nav")[0].replace("latched", stop)
    gate = f"gate /nav -> /cmd_vel : geometry_msgs.Twist rate 20 Hz {{ {'; '.join(lines)}; }}"
    findings = _findings(PLANNER + GATE + DRIVE, rules=head + gate)
    named = [each for each in findings if each.code.name == "DRS357"]
    assert all((each.severity.value, each.span.text) == ("info", "/cmd_vel") for each in named)
    return [
        (each.message.partition(" after ")[2], [line.span.text for line in each.related])
        for each in named
    ]


def test_gate_that_resumes_by_itself() -> None:
    """Each zero that ends without a reset is named, as is the start of the gate."""
    ((after, lines),) = _resuming("stop: zero", HEARTBEAT, INPUT, stop="reset_by go; action go")
    assert after == "'stop', a lost heartbeat, a lost input and the gate's own start"
    assert lines == ["stop: zero;", f"{HEARTBEAT};", f"{INPUT};"]


def test_gate_that_resumes_by_itself_in_part() -> None:
    """A latched action ends by a reset; with `until reset`, so does the start."""
    ((after, lines),) = _resuming("stop: zero", f"{HEARTBEAT} until reset", INPUT)
    assert (after, lines) == ("a lost input", [f"{INPUT};"])
    assert _resuming("stop: zero") == [("the gate's own start", [])]


@pytest.mark.parametrize(
    "lines",
    [
        ("stop: zero", HEARTBEAT, INPUT, RESUME[:-1]),
        ("stop: zero", f"{HEARTBEAT} until reset", f"{INPUT} until reset"),
        ("stop: zero until reset", f"{HEARTBEAT} until reset", "lost input for 1 s: limit "
         "linear.x to [0, 1] m/s"),
    ],
)  # fmt: skip
def test_gate_that_waits_before_it_resumes(lines: tuple[str, ...]) -> None:
    """The gate waits for a reset or for a controller at rest."""
    assert _resuming(*lines) == []


@pytest.mark.parametrize("end", [" until reset", f"; {RESUME[:-1]}"])
def test_limit_covered_by_zero_gives_no_warning(end: str) -> None:
    """A zero that waits leaves nothing of the limit to the controller, so no warning is due."""
    limit = "lost input for 0.2 sec: limit linear.x to [0, 0.1] m/s"
    rules = RULES.partition("  stop: limit")[0] + f"{limit}; {HEARTBEAT}"
    assert "DRS342" in _codes(PLANNER + GATE + DRIVE, rules=f"{rules}; stop: zero; }}")
    assert "DRS342" not in _codes(PLANNER + GATE + DRIVE, rules=f"{rules}{end}; }}")
