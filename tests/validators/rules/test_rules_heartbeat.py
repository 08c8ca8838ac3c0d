"""Timeouts in rules against the heartbeat rates that the system sets for its safety nodes."""

from __future__ import annotations

from pathlib import Path

import pytest

from deros.diagnostics import Diagnostic
from tests.support.checks import checked

SAFETY = """node guard_node : guard
parameters
  name publish_freq : double = 10.0 [Hz] in [0.001, 1000.0] read_only
  name diagnostics_freq : double = 1.0 [Hz] in [0.001, 100.0] read_only
publishes
  topic /stop : std_msgs.Bool qos reliable transient_local depth 1
  topic ~/heartbeat : std_msgs.UInt64 qos reliable depth 1
  topic /diagnostics : diagnostic_msgs.DiagnosticArray qos reliable depth 10
subscribes
  topic /v : std_msgs.Float64
"""
GATE = """node cmd_vel_gate : guard
publishes
  topic /cmd_vel : geometry_msgs.Twist
subscribes
  topic /nav : geometry_msgs.Twist
  topic /stop : std_msgs.Bool
  topic guard_node/heartbeat : std_msgs.UInt64
"""
RULES = """use "s.system" import S
action stop publishes true on /stop : std_msgs.Bool latched;
input v = topic /v.data timeout 1 sec
entity e { fast: v > 1 or v.missing(); }
if e.fast then { stop; };
gate /nav -> /cmd_vel : geometry_msgs.Twist rate 20 Hz {
  stop: zero;
  lost heartbeat for 0.3 sec: zero;
  lost input for 0.5 sec: zero;
}
"""
TOPICS = (
    "  external topic /nav : geometry_msgs.Twist\n  external topic /cmd_vel : geometry_msgs.Twist\n"
    "  external topic /v : std_msgs.Float64\n  topic /stop\n  external topic /diagnostics\n"
)


@pytest.fixture(autouse=True)
def _files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("guard.rnd").write_text(SAFETY, encoding="utf-8")
    Path("gate.rnd").write_text(GATE, encoding="utf-8")


def _safety(name: str = "guard", **settings: object) -> str:
    params = "".join(f"  param {key} = {value}\n" for key, value in settings.items())
    return (
        f"node {name} : guard_node\nparameters\n{params}"
        if settings
        else f"node {name} : guard_node\n"
    )


def _gate(heartbeat: str = "/guard/heartbeat", name: str = "gate") -> str:
    return f"node {name} : cmd_vel_gate\nwirings\n  connect guard_node/heartbeat to {heartbeat}\n"


def _findings(members: str, rules: str = RULES, topics: str = TOPICS) -> list[Diagnostic]:
    """Return the findings about timeouts that are too short or heartbeats that are missing."""
    text = (
        f'system S\nimports\n  import "guard.rnd"\n  import "gate.rnd"\ntopics\n{topics}{members}'
    )
    Path("s.system").write_text(text, encoding="utf-8")
    Path("s.deros").write_text(rules, encoding="utf-8")
    return [each for each in checked("s.deros") if each.code.name in ("DRS343", "DRS345", "DRS363")]


def test_default_heartbeat_rate_suffices() -> None:
    """0.3 s are three heartbeats at the default rate."""
    assert _findings(_safety() + _gate()) == []


def test_lowered_rate_is_too_slow_for_the_timeout() -> None:
    """At five heartbeats per second, 0.3 s are only one and a half."""
    (finding,) = _findings(_safety(publish_freq=5.0) + _gate())
    assert finding.code.name == "DRS345"
    assert "periods of the heartbeat of '/guard', which is published at 5 Hz" in finding.message
    assert finding.hint == (
        "write 0.5 sec or more, or set 'publish_freq' of '/guard' to 9.0 in the system"
    )
    assert [each.span.text for each in finding.related] == ["param publish_freq = 5.0"]


def test_each_half_of_the_hint_fixes_the_finding() -> None:
    """A higher rate and a longer timeout both leave no finding."""
    assert _findings(_safety(publish_freq=9.0) + _gate()) == []
    longer = RULES.replace("for 0.3 sec", "for 0.5 sec")
    assert _findings(_safety(publish_freq=5.0) + _gate(), longer) == []


def test_raised_rate_allows_a_shorter_timeout() -> None:
    """50 heartbeats per second suffice for a timeout of 0.05 s."""
    hasty = RULES.replace("for 0.3 sec", "for 0.05 sec")
    assert [finding.code.name for finding in _findings(_safety() + _gate(), hasty)] == ["DRS345"]
    assert _findings(_safety(publish_freq=50.0) + _gate(), hasty) == []


def test_default_rate_comes_from_the_node_description() -> None:
    """The default in the description applies where the system sets no rate."""
    Path("guard.rnd").write_text(SAFETY.replace("= 10.0", "= 4.0"), encoding="utf-8")
    (finding,) = _findings(_safety() + _gate())
    assert "published at 4 Hz" in finding.message
    assert [each.span.text for each in finding.related] == ["guard"]


def test_each_gate_uses_the_rate_of_its_own_safety_node() -> None:
    """Of two safety nodes, the finding names the slow one."""
    topics = TOPICS + "  topic /left/guard/heartbeat\n"
    fine = "subsystem left namespace /left {\n" + _safety() + "}\n"
    slow = "subsystem right namespace /right {\n" + _safety(publish_freq=2.0) + "}\n"
    members = fine + slow + _gate("/left/guard/heartbeat") + _gate("/right/guard/heartbeat", "g2")
    (finding,) = _findings(members, topics=topics)
    assert "'/right/guard', which is published at 2 Hz" in finding.message
    assert _findings(fine + slow + _gate("/left/guard/heartbeat"), topics=topics) == []


def test_unwired_gate_uses_the_node_that_publishes_its_actions() -> None:
    """The heartbeat comes from the node that publishes the states of the actions."""
    (finding,) = _findings(_safety(publish_freq=5.0))
    assert finding.code.name == "DRS345"


def test_hint_for_missing_heartbeat_fits_the_rate() -> None:
    """The proposed line has a timeout that is long enough for the rate of the system."""
    without = RULES.replace("  lost heartbeat for 0.3 sec: zero;\n", "")
    (finding,) = _findings(_safety() + _gate(), without)
    assert finding.hint == "add 'lost heartbeat for 0.3 sec: zero until reset;'"
    (finding,) = _findings(_safety(publish_freq=2.0) + _gate(), without)
    assert finding.hint == "add 'lost heartbeat for 1.25 sec: zero until reset;'"


def _watching(term: str, timeout: str) -> str:
    watched = f"input w = topic {term} timeout {timeout}\nentity"
    return RULES.replace("entity", watched, 1).replace("v > 1 or", "v > 1 or w.missing() or")


@pytest.mark.parametrize("topic", ["/other/heartbeat.data", "/other_stop.data"])
def test_timeout_must_fit_the_period_of_another_safety_node(topic: str) -> None:
    """Rules that read topics of a safety node must wait for its period, as a gate must."""
    topics = TOPICS + "  topic /other_stop\n"
    wired = "wirings\n  connect /stop to /other_stop\n"
    rules = _watching(topic, "0.3 sec")
    assert _findings(_safety() + _gate() + _safety("other") + wired, rules, topics) == []
    slow = _safety("other", publish_freq=1.0) + wired
    (finding,) = _findings(_safety() + _gate() + slow, rules, topics)
    assert finding.code.name == "DRS363"
    assert "periods of '/other', which publishes" in finding.message
    assert finding.hint.startswith("write 2.5 sec or more, or set 'publish_freq' of '/other'")


def test_timeout_must_fit_the_rate_of_diagnostics() -> None:
    """Diagnostics have a rate of their own, and other publishers may fill the gaps."""
    topics = TOPICS + "  topic /state_of_other\n  external topic /other_stop\n"
    rules = _watching("/state_of_other.status", "1 sec")
    wired = "wirings\n  connect /diagnostics to /state_of_other\n  connect /stop to /other_stop\n"
    (finding,) = _findings(_safety() + _gate() + _safety("other") + wired, rules, topics)
    assert "diagnostics_freq" in finding.hint
    fast = _safety("other", diagnostics_freq=3.0) + wired
    assert _findings(_safety() + _gate() + fast, rules, topics) == []
    fed = topics.replace("topic /state_of_other", "external topic /state_of_other")
    assert _findings(_safety() + _gate() + _safety("other") + wired, rules, fed) == []
