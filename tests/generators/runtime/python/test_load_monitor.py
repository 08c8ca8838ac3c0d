"""The load monitor on real middleware: it publishes while the node runs, and only then."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest

from deros.generators.runtime.python.deros_runtime.process import run
from tests.support.burners import BURNS, burning, named, until_used
from tests.support.cli import deros
from tests.support.ros import Peer, read_line, running

PROGRAM = f"{run.__module__.rpartition('.')[0]}.load_monitor"


def command(*parameters: str, node: str = "/front/burner_load") -> list[str]:
    """Return the command line of a monitor."""
    words = [word for each in parameters for word in ("-p", each)]
    return [sys.executable, "-m", PROGRAM, *named(node), *words]


def loads(peer: Peer) -> list[float]:
    """Return the list in which all loads will be that are published."""
    from std_msgs.msg import Float64

    received: list[float] = []
    peer.node.create_subscription(Float64, "/front/load", lambda msg: received.append(msg.data), 10)
    return received


def read_until(process: subprocess.Popen[str], text: str) -> str:
    """Return the first line of the output that has a text."""
    while text not in (line := read_line(process)):
        assert line, f"the program has ended without {text!r}"
    return line


@pytest.mark.ros
def test_load_is_published_while_the_node_runs(ros_env: dict[str, str], ros_peer: Peer) -> None:
    """A node that is named relative to the monitor's namespace; gone, and started again."""
    received = loads(ros_peer)
    with running(command("node:=burner", "period:=0.2"), ros_env) as monitor:
        fault = read_until(monitor, "no load is published")
        assert "no process on this computer has been started as node /front/burner" in fault
        with burning("/front/burner", 1.0, env=ros_env) as (first, _):
            assert f"/front/burner is process {first.pid}" in read_until(monitor, "is process")
            ros_peer.until(lambda: any(load > 20.0 for load in received))
        read_until(monitor, "no load is published")
        number = len(received)
        with burning("/front/burner", 0.0, env=ros_env) as (second, _):
            assert f"is process {second.pid}" in read_until(monitor, "is process")
            # What was still on its way of the first one comes before.
            ros_peer.until(lambda: len(received) > number + 2)
            assert max(received[-2:]) < 20.0


SYSTEM = """\
system Robot
imports
  import "burner.rnd"
  import "deros:load_monitor.rnd"
topics
  external topic /front/load : std_msgs.Float64

subsystem front namespace front {
  node burner : burner arguments ["1.0"] respawn prefix "env PYTHONUNBUFFERED=1"
  node burner_load : load_monitor
  parameters
    param node = "burner"
    param period = 0.2
  wirings
    connect load to /front/load
}
"""

SETUP = """\
from setuptools import setup
setup(name="burner", entry_points={"console_scripts": ["burner = burner.burner:main"]})
"""


@pytest.mark.ros
def test_node_that_deros_up_starts_again_is_measured_again(
    tmp_path: Path, ros_env: dict[str, str], ros_peer: Peer
) -> None:
    """Of what the system has started, and not of a stranger that has the same name."""
    (tmp_path / "burner.rnd").write_text("node burner : burner\n", encoding="utf-8")
    (tmp_path / "robot.system").write_text(SYSTEM, encoding="utf-8")
    package = tmp_path / "packages/burner"
    (package / "burner").mkdir(parents=True)
    (package / "setup.py").write_text(SETUP, encoding="utf-8")
    body = "".join(f"    {line}\n" for line in BURNS.splitlines())
    (package / "burner/burner.py").write_text(f"def main():\n{body}", encoding="utf-8")
    assert deros("check", "--strict", tmp_path / "robot.system").code == 0
    assert deros("runtime", tmp_path / "packages").code == 0
    script = str(Path(sys.executable).with_name("deros"))
    up = [script, "up", str(tmp_path / "robot.system"), "--package-path", str(package.parent)]
    received = loads(ros_peer)
    with (
        burning("/front/burner", 0.0, env=ros_env) as (stranger, _),
        running(up, ros_env) as system,
    ):
        first = _measured(system)
        ros_peer.until(lambda: any(load > 20.0 for load in received))
        os.kill(first, signal.SIGKILL)
        second = _measured(system)
        assert stranger.pid not in (first, second)
        assert first != second
        received.clear()
        until_used(second, 0.1)
        ros_peer.until(lambda: any(load > 20.0 for load in received))


def _measured(system: subprocess.Popen[str]) -> int:
    """Return the number of the process that a monitor has found, when it says so."""
    return int(read_until(system, "/front/burner is process").split()[-1])


@pytest.mark.parametrize(
    ("parameters", "reason"),
    [
        ([], "parameter 'node' has to name the node whose load is measured"),
        (["node:=/"], "parameter 'node' has to name the node whose load is measured"),
        (["node:=/burner", "period:=0.01"], "period"),
        (["node:=/burner", "period:=often"], "period"),
        (["node:=7"], "node"),
    ],
)
@pytest.mark.ros
def test_parameters_that_cannot_be_used_end_it(
    parameters: Sequence[str], reason: str, ros_env: dict[str, str]
) -> None:
    """With the reason, the exit code 1 and no traceback."""
    done: Any = subprocess.run(
        command(*parameters), env=ros_env, capture_output=True, text=True, timeout=60, check=False
    )
    assert done.returncode == 1
    assert reason in done.stderr
    assert "Traceback" not in done.stderr
