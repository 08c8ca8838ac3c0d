"""Rules that are run at once: their nodes act, or watch as a shadow, and are gone at the end."""

from __future__ import annotations

import signal
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

from deros.generators.api.protocol import File
from deros.pipeline.kept import kept
from tests.support.cli import deros
from tests.support.ros import Peer, running, stop

SYSTEM = """system Robot
topics
  external topic /odometry : nav_msgs.Odometry
  external topic /wish : geometry_msgs.Twist
  external topic /command : geometry_msgs.Twist
  external topic halt : std_msgs.Bool
"""
RULES = """use "robot.system" import Robot

action halt publishes true on halt : std_msgs.Bool

const limit = 1.0 m/s tunable in [0.1, 2.0] m/s "Greatest speed"
input speed = topic /odometry.twist.twist.linear.x timeout 60 sec

entity drive {
  fast: abs(speed) > limit;
  silent: speed.missing();
}

behaviour too_fast: if drive.fast or drive.silent then { halt; };

gate /wish -> /command : geometry_msgs.Twist rate 20 Hz {
  halt: zero;
  lost heartbeat for 0.5 sec: zero;
  lost input for 0.5 sec: zero;
}
"""


@pytest.fixture
def rules(tmp_path: Path) -> Path:
    """Return the path of rules with all that they need."""
    (tmp_path / "robot.system").write_text(SYSTEM)
    path = tmp_path / "speed.deros"
    path.write_text(RULES)
    return path


@pytest.fixture
def environment(ros_env: dict[str, str], tmp_path: Path) -> dict[str, str]:
    """Return an environment with caches and a home of its own."""
    return {**ros_env, "XDG_CACHE_HOME": str(tmp_path / "cache"), "HOME": str(tmp_path)}


def _command(rules: Path, *words: str) -> list[str]:
    return [sys.executable, "-m", "deros", "run", str(rules), *words]


def _watch(peer: Peer, topic: str) -> list[bool]:
    """Return what comes on the topic of a state, as it comes."""
    from rclpy.qos import QoSDurabilityPolicy, QoSProfile
    from std_msgs.msg import Bool

    heard: list[bool] = []
    latched = QoSProfile(depth=1, durability=QoSDurabilityPolicy.TRANSIENT_LOCAL)
    peer.node.create_subscription(Bool, topic, lambda message: heard.append(message.data), latched)
    return heard


def _hear_events(peer: Peer, node: str, events: list[str]) -> None:
    """Append the events of a node as they come."""
    from diagnostic_msgs.msg import DiagnosticStatus
    from rclpy.qos import QoSDurabilityPolicy, QoSProfile

    latched = QoSProfile(depth=100, durability=QoSDurabilityPolicy.TRANSIENT_LOCAL)
    peer.node.create_subscription(
        DiagnosticStatus, f"{node}/events", lambda event: events.append(str(event)), latched
    )


def _drive(peer: Peer, speed: float) -> Any:
    """Return a function that publishes a speed, and is true for what it is asked about."""
    from nav_msgs.msg import Odometry

    publisher = peer.node.create_publisher(Odometry, "/odometry", 10)
    message = Odometry()
    message.twist.twist.linear.x = speed

    def until(found: Any) -> Any:
        publisher.publish(message)
        return found()

    return until


def test_safety_node_and_gate_act_without_a_package(
    rules: Path, environment: Mapping[str, str], ros_peer: Peer
) -> None:
    """With a tunable constant from a file; all end by one Ctrl-C."""
    tuned = rules.with_name("tuned.yaml")
    tuned.write_text("/**: {ros__parameters: {limit: 0.3}}\n")
    command = _command(rules, "--params-file", str(tuned))
    drive = _drive(ros_peer, 0.5)
    halted = _watch(ros_peer, "/halt")
    with running(command, dict(environment)) as process:
        ros_peer.until(lambda: drive(lambda: True in halted))
        ros_peer.until(lambda: ros_peer.node.count_publishers("/command") == 1)
        code, said = stop(process, signal.SIGINT)
    assert code == 130, said
    assert "too_fast" in said
    assert said.count(" stopped") == 2


def test_shadow_reports_and_does_nothing(
    rules: Path, environment: Mapping[str, str], ros_peer: Peer
) -> None:
    """No gate, and no message where the robot listens; what it would do is below its own name."""
    real = rules.with_name("real.latches")
    tuned = rules.with_name("tuned.yaml")
    tuned.write_text(f"/**: {{ros__parameters: {{state_file: {real}}}}}\n")
    rules.write_text(RULES.replace("std_msgs.Bool", "std_msgs.Bool latched"))
    drive = _drive(ros_peer, 1.5)
    name = "/speed_safety_node_shadow"
    shown = _watch(ros_peer, f"{name}/shadow/halt")
    events: list[str] = []
    _hear_events(ros_peer, name, events)
    command = _command(rules, "--shadow", "--params-file", str(tuned))
    with running(command, dict(environment)) as process:
        ros_peer.until(lambda: drive(lambda: True in shown and events))
        assert ros_peer.node.count_publishers("/halt") == 0
        assert ros_peer.node.count_publishers("/command") == 0
        assert "speed_safety_node" not in ros_peer.node.get_node_names()
        code, said = stop(process, signal.SIGINT)
    assert code == 130, said
    assert "halt, by too_fast" in said
    assert not real.exists()


def test_shadow_has_the_values_of_the_real_name_and_all_inputs(
    rules: Path, environment: Mapping[str, str], ros_peer: Peer
) -> None:
    """Also one whose topic has the name of a service that it would call."""
    tuned = rules.with_name("tuned.yaml")
    tuned.write_text("speed_safety_node: {ros__parameters: {limit: 0.3}}\n")
    alone, _, _ = RULES.partition("gate")
    state, call = (
        "publishes true on halt : std_msgs.Bool",
        "calls true on /odometry : std_srvs.SetBool",
    )
    rules.write_text(alone.replace(state, call))
    drive = _drive(ros_peer, 0.5)
    events: list[str] = []
    _hear_events(ros_peer, "/speed_safety_node_shadow", events)
    with running(
        _command(rules, "--shadow", "--params-file", str(tuned)), dict(environment)
    ) as process:
        ros_peer.until(lambda: drive(lambda: any("drive.fast" in each for each in events)))
        code, said = stop(process, signal.SIGINT)
    assert code == 130, said


VALUES = """speed_safety_node_shadow: {ros__parameters: {publish_freq: 7.0}}
/speed_safety_node:
  ros__parameters:
    publish_freq: 5.0
    limit: 0.3
    startup_grace: 3.0
    behaviours: {b: {enabled: false}}
/*: {ros__parameters: {texts: ["a", "b c"]}}
/**/speed_safety_node: {ros__parameters: {use_sim_time: true}}
/**: {ros__parameters: {state_file: x, startup_grace: 1.0}}
speed_gate: {ros__parameters: {limit: 0.4}}
"""


@pytest.mark.parametrize("name", ["speed_safety_node", "speed_safety_node_shadow"])
def test_what_is_set_here_is_not_overridden_by_files(
    rules: Path, name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """``/**`` below the key of a node beats it, in ROS 2; a shadow has keys of both names."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    is_shadow = name.endswith("shadow")
    file = rules.with_name("values.yaml")
    file.write_text(VALUES)
    more = ["--shadow"] if is_shadow else []
    words = ["--dry-run", "--params-file", file, "--startup-grace", "7", *more]
    outcome = deros("run", rules, *words)
    assert outcome.code == 0, outcome.err
    line = next(each for each in outcome.out.splitlines() if f"__node:={name} " in each)
    assert "--params-file" not in line
    given = line.split(" -p ")[1:]
    assert {each.split(" -r ")[0].strip("'") for each in given} == {
        f"publish_freq:={7.0 if is_shadow else 5.0}",
        "limit:=0.3",
        "startup_grace:=7.0",
        "behaviours.b.enabled:=false",
        'texts:=["a", "b c"]',
        "use_sim_time:=true",
        f'state_file:="{"" if is_shadow else "x"}"',
    }


def test_file_that_ros_refuses_starts_no_shadow(
    rules: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The place in it is named."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    file = rules.with_name("values.yaml")
    file.write_text("speed_safety_node: {limit: 0.3}\n")
    outcome = deros("run", rules, "--shadow", "--params-file", file)
    assert outcome.code == 2
    assert f"{file}:1:28: ROS 2 refuses this file" in outcome.err


@pytest.mark.parametrize("more", [[], ["--shadow"]])
def test_safety_node_waits_for_its_inputs(
    rules: Path, more: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The gate, which reads none of them, is told nothing."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    outcome = deros("run", rules, "--dry-run", "--startup-grace", "7", *more)
    assert outcome.code == 0, outcome.err
    safety, *gates = outcome.out.split("\n# ")
    assert "startup_grace:=7.0" in safety
    assert not any("startup_grace" in each for each in gates)
    assert len(gates) == (0 if more else 1)
    assert deros("run", rules, "--dry-run", "--startup-grace", "-1").code == 2


def test_what_cannot_be_run_is_refused(rules: Path) -> None:
    """Errors in the rules, actions that need code, another language."""
    outcome = deros("run", rules.with_name("robot.system"))
    assert outcome.code == 2
    assert "robot.system" in outcome.err
    alone, _, _ = RULES.replace(" publishes true on halt : std_msgs.Bool", "").partition("gate")
    rules.write_text(alone)
    outcome = deros("run", rules)
    assert outcome.code == 2
    assert "do not say what 'halt' does" in outcome.err
    rules.write_text(RULES.replace("if drive.fast", "if drive.fats"))
    outcome = deros("run", rules)
    assert outcome.code == 1
    assert "did you mean 'drive.fast'" in outcome.out + outcome.err


def test_kept_files_are_used_only_if_they_are_whole(tmp_path: Path) -> None:
    """One that was changed, is missing or was added has the folder made anew."""
    files = {"p/a.py": File("one"), "p/b/c.py": File("two")}
    place = kept(files, tmp_path)
    (place / "p" / "__pycache__").mkdir()
    compiled = place / "p" / "__pycache__" / "a.pyc"
    compiled.write_bytes(b"x")
    assert kept(files, tmp_path) == place
    assert compiled.exists()
    for spoil in (
        lambda: (place / "p" / "a.py").write_text("other"),
        lambda: (place / "p" / "a.py").unlink(),
        lambda: (place / "p" / "added.py").write_text(""),
    ):
        spoil()
        assert kept(files, tmp_path) == place
        assert {each.name for each in place.rglob("*.py")} == {"a.py", "c.py"}
        assert (place / "p" / "a.py").read_text() == "one"
        assert not compiled.exists()
    assert kept({"p/a.py": File("three")}, tmp_path) != place
    assert sorted(each.name[0] for each in tmp_path.iterdir() if each.name.startswith(".")) == []
