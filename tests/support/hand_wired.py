"""A robot whose safety node and gate are wired by hand, and each way to wire them wrongly."""

from __future__ import annotations

from pathlib import Path

from deros.generators.node.description import node_description
from deros.metamodels.load import Repository
from deros.models.rules import Rules
from deros.systems.flatten import nodes_of_rules
from tests.support.tables import rows

RULES = """use "robot.system" import Robot
action stop publishes true on /stop : std_msgs.Bool latched;
action slow publishes true on /slow : std_msgs.Bool latched;
input front = topic /front.ranges[0] timeout 1 sec
input rear = topic /rear.ranges[0] timeout 1 sec
// deros: allow DRS382 the scanners have one beam
entity e { near: front < 1 m or rear < 1 m; blind: front.missing() or rear.missing(); }
if e.near or e.blind then { stop; slow; };
gate /wish -> /command : geometry_msgs.Twist rate 20 Hz {
  stop: zero;
  slow: limit linear.x to [-0.1, 0.1] m/s;
  lost heartbeat for 0.3 sec: zero;
  lost input for 0.5 sec: zero;
  resume on zero command;
}
"""

_SYSTEM = """system Robot
imports
  import "PACKAGE_node.rnd"
  import "command_gate.rnd"
topics
  external topic /front : sensor_msgs.LaserScan
  external topic /rear : sensor_msgs.LaserScan
  external topic /wish
  external topic /command
  external topic /stop
  external topic /slow
  external topic /beat
  external topic /events
  external topic /diagnostics
  external topic /elsewhere
subsystem Safety {
  node safety : PACKAGE_node
  wirings
    connect /front to /front
    connect /rear to /rear
    connect /stop to /stop
    connect /slow to /slow
    connect ~/heartbeat to /beat
    connect ~/events to /events
    connect /diagnostics to /diagnostics

  node gate : command_gate
  wirings
    connect /wish to /wish
    connect /command to /command
    connect /stop to /stop   // of the gate
    connect /slow to /slow   // of the gate
    connect PACKAGE_node/heartbeat to /beat
    connect /diagnostics to /diagnostics
}
"""

STATEMENT = """safety "robot.deros" as safety
wirings
  connect ~/heartbeat to /beat
  connect ~/events to /events
"""

DIFFERENCES = {
    each["difference"]: (each["right"], each["wrong"], each["code"], each["words"])
    for each in rows("hand_wired")
}
"""For each difference: what to replace in the system by what, the error, and what it says."""


def write_hand_wired(package: str = "robot_safety") -> None:
    """Write rules, system and the descriptions of the generated nodes to the current folder."""
    Path("robot.deros").write_text(RULES, encoding="utf-8")
    text = _SYSTEM.replace("PACKAGE", package)
    Path("robot.system").write_text(text, encoding="utf-8")
    model = Repository().load("robot.deros").model
    assert isinstance(model, Rules)
    for node in nodes_of_rules(model, package=package):
        Path(f"{node.name}.rnd").write_text(node_description(node), encoding="utf-8")
