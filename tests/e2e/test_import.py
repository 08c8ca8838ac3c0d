"""The feeding robot runs, is imported, and the imported models are those that it was made from."""

from __future__ import annotations

import contextlib
import dataclasses
import json
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import pytest

from deros.systems.flatten import flatten
from tests.support.cli import deros
from tests.support.examples import EXAMPLES, example_module
from tests.support.imported import Described, described
from tests.support.processes import freeze, thaw
from tests.support.ros import Peer, running
from tests.support.shell import DEROS, deros_until
from tests.support.stand_ins import Run
from tests.support.systems import load

SYSTEM = EXAMPLES / "feeding_robot/feeding_robot.system"
RULES = SYSTEM.with_suffix(".deros")
SHADOW = "feeding_robot_safety_node_shadow"
HEARTBEATS = {"safety": "/safety/heartbeat", SHADOW: f"/{SHADOW}/heartbeat"}

Said = dict[str, str]
"""What an event says, without its times."""


def visible(node: Described) -> Described:
    """Return what a graph shows of a node: no depths, and no setting that is usual."""
    ends = {
        key: policies and dataclasses.replace(policies, depth=10)
        for key, policies in node.ends.items()
    }
    usual = ("use_sim_time", ("built in", False))
    return Described(ends, dict(each for each in node.parameters.items() if each != usual))


@pytest.mark.ros
def test_imported_robot_is_the_one_that_runs(ros_env: dict[str, str], tmp_path: Path) -> None:
    """All ends of its nine nodes, their types, QoS and the parameters that the system sets."""
    models = tmp_path / "models"
    packages = tmp_path / "packages"
    example_module("feeding_robot", "demonstration.build").build(SYSTEM.parent, packages)
    truth = {name: visible(node) for name, node in described(SYSTEM).items()}
    command = [DEROS, "up", str(SYSTEM), "--package-path", str(packages)]
    with running(command, ros_env):
        deros_until(
            ros_env,
            lambda _: _names(models) == truth.keys(),
            *("import", "--live", "-o", str(models)),
        )
    found = described(models / "robot.system")
    assert found.keys() == truth.keys()
    for name, node in truth.items():
        seen = visible(found[name])
        assert seen.ends == node.ends
        assert seen.parameters.items() >= node.parameters.items()
    outcome = deros("check", models / "robot.system", "--format", "json")
    assert outcome.code == 0
    # Imported, the safety node is a node without rules.
    assert [each["code"] for each in json.loads(outcome.out)] == ["DRS239"]


@pytest.mark.ros
def test_shadow_of_the_imported_robot_says_what_the_original_says(
    ros_env: dict[str, str], ros_peer: Peer, tmp_path: Path
) -> None:
    """Event for event, when sensors and the controller hang and come back."""
    models = tmp_path / "models"
    example_module("feeding_robot", "demonstration.build").build(SYSTEM.parent, tmp_path / "src")
    names = {node.full_name for node in flatten(load(SYSTEM)).nodes}
    command = [DEROS, "up", str(SYSTEM), "--package-path", str(tmp_path / "src")]
    with _run(command, ros_env) as robot:
        ros_peer.until(lambda: names <= set(_full_names(ros_peer)))
        words = ("import", "--live", "-o", str(models))
        deros_until(ros_env, lambda _: names <= _names(models), *words)
        text = RULES.read_text(encoding="utf-8")
        used = 'use "feeding_robot.system" import FeedingRobot'
        assert used in text
        rules = models / RULES.name
        rules.write_text(text.replace(used, 'use "robot.system" import robot'), encoding="utf-8")
        watch = [DEROS, "run", "--shadow", "--startup-grace", "60", str(rules)]
        with _run(watch, {**ros_env, "XDG_CACHE_HOME": str(tmp_path / "cache")}):
            said = {name: _events(ros_peer, name) for name in ("safety", SHADOW)}
            for name in said:  # there is a heartbeat when all inputs have come
                _heartbeat(ros_peer, name)
            begun = {name: len(events) for name, events in said.items()}
            robot.until(*(f"{each} started, process" for each in HANGING))
            for hung, behaviour in HANGING.items():
                awaited = [Awaited(events, len(events), behaviour) for events in said.values()]
                freeze(robot.started()[hung])
                for each in awaited:
                    ros_peer.until(each.has_come)
                thaw(robot.started()[hung])

            def same() -> bool:
                one, other = (events[begun[name] :] for name, events in said.items())
                return one == other

            ros_peer.until(same)


HANGING = {
    "imu_driver": "sensor_lost",
    "mission_controller": "controller_lost",
    "lidar_driver": "sensor_lost",
}
"""Nodes that hang, and the behaviour that answers."""


class Awaited(NamedTuple):
    """What a safety node is about to say."""

    events: list[Said]
    begun: int
    behaviour: str

    def has_come(self) -> bool:
        """Tell whether the behaviour has triggered something."""
        return any(each.get("behaviour") == self.behaviour for each in self.events[self.begun :])


@contextlib.contextmanager
def _run(command: list[str], env: dict[str, str]) -> Iterator[Run]:
    run = Run(command, env)
    try:
        yield run
    finally:
        run.close()
        print("\n".join(run.lines))


def _full_names(peer: Peer) -> list[str]:
    found = peer.node.get_node_names_and_namespaces()
    return [f"{space.rstrip('/')}/{name}" for name, space in found]


def _events(peer: Peer, name: str) -> list[Said]:
    """Return the events of a safety node, as they come."""
    from diagnostic_msgs.msg import DiagnosticStatus
    from rclpy.qos import QoSDurabilityPolicy, QoSProfile

    found: list[Said] = []
    latched = QoSProfile(depth=1000, durability=QoSDurabilityPolicy.TRANSIENT_LOCAL)

    def take(event: DiagnosticStatus) -> None:
        said = {each.key: each.value for each in event.values if not each.key.endswith("_ns")}
        found.append({"message": event.message, **said})

    peer.node.create_subscription(DiagnosticStatus, f"/{name}/events", take, latched)
    return found


def _heartbeat(peer: Peer, name: str) -> None:
    """Wait for a sign of life of a safety node."""
    from std_msgs.msg import UInt64

    beats: list[UInt64] = []
    subscription = peer.node.create_subscription(UInt64, HEARTBEATS[name], beats.append, 10)
    peer.until(lambda: len(beats) > 1)
    peer.node.destroy_subscription(subscription)


def _names(models: Path) -> set[str]:
    return set(described(models / "robot.system")) if models.exists() else set()
