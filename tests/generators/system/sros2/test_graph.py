"""The policy against the graph at run time, on the real middleware."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from deros.generators.builtin import rossystem_script
from deros.generators.node.python.generate import generate
from deros.generators.output.writer import write
from tests.support.examples import EXAMPLES, example_module
from tests.support.node_packages import model_of
from tests.support.policies import Difference, await_policy, difference, policy_text
from tests.support.ros import Peer, running
from tests.support.systems import CONTEXT, load, load_text

WORKER = """\
node worker : works
parameters
  name sources : string[] = ["a", "b"]
  name picture : string = "picture"
publishes
  topic out : std_msgs.Bool
subscribes
  topic in : std_msgs.Bool
  topic each : std_msgs.Bool via sources
  topic view : std_msgs.Bool via picture
services
  service reset : std_srvs.Trigger
clients
  client ask : std_srvs.Trigger
actions
  action dock : test_msgs.Fibonacci
action_clients
  action drive : test_msgs.Fibonacci
"""
MEMBER = """\
node member : crew lifecycle
publishes
  topic state : std_msgs.Bool
"""
SYSTEM = """\
system Robot
imports
  import "*.rnd"
subsystem front namespace front {
  remappings remap /rosout to /log
  node full : worker
  parameters
    param sources = ["x", "/y"]
    param use_sim_time = true
  wirings
    connect out to /wire
    connect view to /view
    connect ask to /all/reset
    connect dock to /station
  node bare : worker
  parameters
    param start_type_description_service = false
}
node managed : member autostart
"""


@pytest.mark.ros
def test_graph_is_what_the_policy_allows(
    tmp_path: Path, ros_env: dict[str, str], ros_peer: Peer
) -> None:
    """Every kind of port, lists, remappings, time, managed nodes and bring-up: equal sets."""
    model = load_text(tmp_path, SYSTEM, worker=WORKER, member=MEMBER)
    for name in ("worker", "member"):
        node, context = model_of(tmp_path / f"{name}.rnd")
        write(generate(node, context, {}), tmp_path / "packages")
    (script,) = rossystem_script(model, CONTEXT).values()
    path = tmp_path / "robot.py"
    path.write_text(script.text)
    command = [sys.executable, str(path), "--package-path", str(tmp_path / "packages")]
    with running(command, ros_env):
        await_policy(policy_text(model), ros_peer)


@pytest.mark.ros
@pytest.mark.slow
def test_graph_of_the_feeding_robot_is_what_its_policy_allows(
    tmp_path: Path, ros_env: dict[str, str], ros_peer: Peer
) -> None:
    """Nine nodes, with their safety node and its gate."""
    example = EXAMPLES / "feeding_robot"
    example_module("feeding_robot", "demonstration.build").build(example, tmp_path / "packages")
    model = load(example / "feeding_robot.system")
    (script,) = rossystem_script(model, CONTEXT).values()
    path = tmp_path / "robot.py"
    path.write_text(script.text)
    command = [sys.executable, str(path), "--package-path", str(tmp_path / "packages")]
    with running(command, ros_env):
        await_policy(policy_text(model), ros_peer, "/safety", "/actuators_command_gate")


def test_comparison_sees_both_directions() -> None:
    """A permission that is not used, one that is lacking, and nodes of one side are found."""
    one, two = ("publish", "/one"), ("publish", "/two")
    allowed = {"/a": frozenset({one}), "/b_*": frozenset({one}), "/c": frozenset({one})}
    shown = {"/a": frozenset({two}), "/b_7": frozenset({one}), "/d": frozenset({one})}
    assert difference(allowed, shown) == Difference(
        {"/a": frozenset({two}), "/d": None}, {"/a": frozenset({one}), "/c": None}
    )
