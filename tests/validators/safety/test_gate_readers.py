"""Readers of a gate that may not stop when its commands cease."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.support.checks import checked

RULES = """\
use "part.system" import Part
action stop publishes true on stop : std_msgs.Bool;
input v = topic v.data timeout 1 sec
entity e { failsafe fast: v.abs() > 1; }
if e.fast then { stop; };
gate raw -> cmd : geometry_msgs.Twist rate 20 Hz {
  stop: zero;
  lost heartbeat for 0.3 sec: zero;
  lost input for 0.5 sec: zero;
}
"""
PART = """\
system Part
imports import "*.rnd"
topics topic cmd external topic raw : geometry_msgs.Twist external topic v : std_msgs.Float64
node base : base
wirings connect cmd to cmd
safety "part.deros"
"""


def findings(folder: Path, base: str, system: str = PART, name: str = "part") -> list[str]:
    """Return the messages of DRS250 in the file of a system."""
    (folder / "base.rnd").write_text(f"node base : base subscribes topic cmd : {base}")
    (folder / "part.deros").write_text(RULES)
    (folder / "part.system").write_text(PART)
    (folder / f"{name}.system").write_text(system)
    found = checked(folder / f"{name}.system")
    return [each.message for each in found if each.code.name == "DRS250"]


@pytest.mark.parametrize("base", ["geometry_msgs.Twist", "geometry_msgs.Twist qos depth 1"])
def test_reader_of_a_gate_has_to_say_that_silence_stops_it(tmp_path: Path, base: str) -> None:
    """The words at the subscription are the answer."""
    (message,) = findings(tmp_path, base)
    assert message.startswith("'base' reads the commands of the gate 'cmd_gate'")
    assert not findings(tmp_path, f"{base} stops after 0.2 sec")


def test_reader_in_a_system_that_is_used_twice_is_reported_once(tmp_path: Path) -> None:
    """The connection is written once."""
    pair = """
        system Pair imports import "part.system"
        subsystem left uses Part namespace /left { }
        subsystem right uses Part namespace /right { }
    """
    assert len(findings(tmp_path, "geometry_msgs.Twist", pair, "pair")) == 1


def test_safety_nodes_and_other_gates_are_not_reported(tmp_path: Path) -> None:
    """Their rules say what they do in silence."""
    second = """\
use "part.system" import Part
action halt publishes true on halt : std_msgs.Bool;
input speed = topic cmd.linear.x timeout 1 sec
entity e { failsafe fast: speed.abs() > 1 m/s; }
if e.fast then { halt; };
gate cmd -> wheels : geometry_msgs.Twist rate 20 Hz {
  halt: zero;
  lost heartbeat for 0.3 sec: zero;
  lost input for 0.5 sec: zero;
}
"""
    (tmp_path / "second.deros").write_text(second)
    system = PART.replace("topic cmd ", "topic cmd topic wheels ")
    system = system.replace("connect cmd to cmd", "connect cmd to wheels")
    system += 'safety "second.deros" as second'
    (message,) = findings(tmp_path, "geometry_msgs.Twist", system)
    assert message.startswith("'base' reads the commands of the gate 'wheels_gate'")
