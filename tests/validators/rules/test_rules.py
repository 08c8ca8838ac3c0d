"""Checks of sound rules give no findings."""

from __future__ import annotations

from pathlib import Path

from deros.metamodels.load import Repository
from deros.models.rules import Rules
from deros.rules.compiler.build import build
from deros.validators.rules.rules import check_rules
from tests.support.rules import embedded_store, findings, shown

SOUND = """
unit knot = 0.514444 m/s
action stop publishes true on /stop : std_msgs.Bool reset_by ok;
action ok;
action beep(times);
const fast = 2 knot
const often = 3
input v = topic /odom.twist.twist.linear.x timeout 1 sec
input m = topic /mode.data timeout 1 sec
input scan = topic /scan timeout 1 sec
entity e {
  failsafe fast: v > fast or v.rate(0.1 sec).abs() > 3 m/s^2 for 2 sec;
  failsafe near: scan.nearest(-30 deg, 30 deg) < 0.5 m or scan.blind(-30 deg, 30 deg) > 20 %;
  manual: m = 0;
  silent: v.missing() or m.missing() or scan.age() > 0.5 sec;
}
if e.fast or e.near then { stop; if e.silent then { beep(often); log_state("silent"); }; };
if e.manual then { ok; };
"""


def test_sound_rules_have_no_findings() -> None:
    """A program with timeouts that uses all its declarations has no findings."""
    assert findings(SOUND) == []


def test_input_without_timeout_is_reported_once() -> None:
    """The finding names the input once, with all rules that read it."""
    statements = SOUND.replace("linear.x timeout 1 sec", "linear.x").replace("v.missing() or ", "")
    statements = statements.replace(
        "failsafe fast: v > fast or v.rate(0.1 sec)", "fast: v > fast or v"
    )
    statements = statements.replace("3 m/s^2", "3 m/s")
    reported = findings(statements.replace("manual: m = 0", "manual: m = 0 and v < 1"))
    assert [(code, place) for code, place, _ in reported] == [("DRS317", "v")]
    assert "'e.fast', 'e.manual' still use the last value" in reported[0][2]


def check_text(directory: Path, system: str, text: str) -> list[str]:
    """Check a program against its own system and return the codes found in the program."""
    (directory / "talker.rnd").write_text(
        "node talker : demo parameters name to : string publishes topic out : std_msgs.Bool"
    )
    (directory / "S.system").write_text(f'system S imports import "talker.rnd" {system}')
    model = Repository().load_text(directory / "x.deros", f'use "S.system" import S {text}').model
    assert isinstance(model, Rules)
    return [shown(finding)[0] for finding in check_rules(model, build(model, embedded_store()))]


READ = """
action stop;
input f = topic /f.data timeout 1 sec
entity e { failsafe r: f; }
if e.r then { stop; };
"""


def test_topic_may_be_fed_through_a_parameter(tmp_path: Path) -> None:
    """A node wired through a parameter that no port claims may be the publisher."""
    system = "topics topic /f : std_msgs.Bool node t : talker wirings connect to to /f"
    assert check_text(tmp_path, system, READ) == []
    assert check_text(tmp_path, system.replace("connect to", "connect out"), READ) == []
    nobody = "topics topic /f : std_msgs.Bool"
    assert check_text(tmp_path, nobody, READ) == ["DRS318"]
    assert check_text(tmp_path, nobody.replace("topic /f", "external topic /f"), READ) == []


def test_unknown_node_type_may_publish_the_topic(tmp_path: Path) -> None:
    """With a node of unknown type in the system, no topic is reported as unpublished."""
    system = "topics topic /f : std_msgs.Bool node t : talkr"
    bound = READ.replace("stop;", "stop publishes true on /g : std_msgs.Bool;", 1)
    assert check_text(tmp_path, system, bound) == []


def test_action_may_feed_an_input_topic(tmp_path: Path) -> None:
    """A topic that an action publishes and a rule reads has both ends in the safety node."""
    system = "topics topic /f : std_msgs.Bool"
    bound = READ.replace("stop;", "stop publishes true on /f : std_msgs.Bool;", 1)
    assert check_text(tmp_path, system, bound) == []
