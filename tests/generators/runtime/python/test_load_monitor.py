"""The load monitor on real middleware: it publishes while the node runs, and only then."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Sequence
from typing import Any

import pytest

from deros.generators.runtime.python.deros_runtime.process import run
from tests.support.burners import burning, named
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
