"""Real ROS 2 in tests: domains of their own, processes that surely end, and a peer to talk to.

Nothing here waits for a time: every wait is for an event, with a limit after which the test fails.
"""

from __future__ import annotations

import contextlib
import fcntl
import itertools
import os
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import pytest

from tests.support.examples import EXAMPLES

LIMIT = 30.0
"""Seconds after which an awaited event is taken not to come; discovery alone may need three."""

_PIPE_BYTES = 1 << 20
"""Size of a pipe for the output of a process; the most that Linux allows a user."""

_PORTS_FROM, _PORTS_EACH = 7400, 250
"""Where the ports of Fast DDS begin, and how many there are for each domain."""


def _domains() -> range:
    """Return the domains whose ports this machine does not give to outgoing connections."""
    try:
        text = Path("/proc/sys/net/ipv4/ip_local_port_range").read_text(encoding="ascii")
        first = int(text.split()[0])
    except (OSError, ValueError):
        first = 32_768
    last = min((first - _PORTS_FROM) // _PORTS_EACH, 102)
    return range(1, last if last > 10 else 102)  # with too few of them, luck has to do


_DOMAINS = _domains()
_NEXT = itertools.count(os.getpid())

_CONFINED = {
    "FASTRTPS_DEFAULT_PROFILES_FILE": str(EXAMPLES / "feeding_robot/demonstration/loopback.xml"),
    "ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET",  # LOCALHOST would bring shared memory back
}
_SHARED_MEMORY = Path("/dev/shm")
_PORT = re.compile(r"(?:sem\.)?fastrtps_port(?P<number>\d+)(?:_\w+)?")


@contextlib.contextmanager
def own_domain() -> Iterator[int]:
    """Hold a ROS_DOMAIN_ID that no other test process of this machine holds.

    Each time it is another one, as long as there are any: what is on its way in the last one, or
    has been left behind there, is not met in this one.
    """
    folder = Path(tempfile.gettempdir()) / "deros-test-domains"
    folder.mkdir(mode=0o777, exist_ok=True)
    first = next(_NEXT) % len(_DOMAINS)
    for number in [*_DOMAINS[first:], *_DOMAINS[:first]]:
        with (folder / str(number)).open("w") as lock:
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                continue
            try:
                yield number
            finally:
                _clear_shared_memory(number)
            return
    raise RuntimeError("all ROS domains are taken by other tests")


def _clear_shared_memory(domain: int) -> None:
    """Remove the ports of a domain that killed processes have left in shared memory.

    They hold locks, for which Fast DDS may wait.
    """
    first = _PORTS_FROM + _PORTS_EACH * domain
    ports = range(first, first + _PORTS_EACH)
    for path in _SHARED_MEMORY.glob("*fastrtps_port*"):
        match = _PORT.fullmatch(path.name)
        if match and int(match["number"]) in ports:
            path.unlink(missing_ok=True)


@pytest.fixture
def ros_env(tmp_path: Path) -> Iterator[dict[str, str]]:
    """Give the environment for ROS 2 processes of one test: loopback, domain and home their own."""
    with own_domain() as domain:
        yield environment(domain) | {"ROS_HOME": str(tmp_path / "ros_home")}


def environment(domain: int) -> dict[str, str]:
    """Return this process's environment, confined to the loopback and to one domain.

    It is UDP throughout: tests kill and freeze processes, and one that holds a lock in shared
    memory then would keep the others waiting for seconds (``docs/gate.md``).
    """
    env = dict(os.environ)
    env.setdefault("AMENT_PREFIX_PATH", sys.prefix)
    return {**env, **_CONFINED, "ROS_DOMAIN_ID": str(domain), "PYTHONUNBUFFERED": "1"}


DEFAULT_LEASE_S = 20
"""Seconds for which Fast DDS keeps the publishers of a process that was killed."""


def with_lease(profiles: str, folder: Path, seconds: int) -> dict[str, str]:
    """Return an environment for processes that are forgotten sooner when they are killed.

    Who reads the shorter lease are the others, so it is the killed one that needs it.

    Args:
        profiles: the profiles of Fast DDS that would be used otherwise.
        folder: where the changed ones are written.
        seconds: the lease.
    """
    lease = f"""<builtin><discovery_config>
      <leaseDuration><sec>{seconds}</sec></leaseDuration>
      <leaseAnnouncement><nanosec>{10**9 // 4}</nanosec></leaseAnnouncement>
    </discovery_config></builtin>"""
    path = folder / f"lease_{seconds}.xml"
    path.write_text(profiles.replace("</rtps>", f"{lease}\n    </rtps>"), encoding="utf-8")
    return {"FASTRTPS_DEFAULT_PROFILES_FILE": str(path)}


def short_lease(folder: Path) -> dict[str, str]:
    """Return the same for processes on the loopback, with a second's lease."""
    profiles = Path(_CONFINED["FASTRTPS_DEFAULT_PROFILES_FILE"]).read_text(encoding="utf-8")
    return with_lease(profiles, folder, 1)


@contextlib.contextmanager
def running(command: Sequence[str], env: dict[str, str]) -> Iterator[subprocess.Popen[str]]:
    """Run a program with its output in one pipe; it is gone when the block ends.

    What the block has not read of the output is printed, for pytest to show when the test fails.

    Raises:
        AssertionError: if it does not end by SIGINT.
    """
    with subprocess.Popen(
        command,
        env=env,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        pipesize=_PIPE_BYTES,
    ) as process:
        try:
            yield process
        finally:
            _end(process, command[0])


def _end(process: subprocess.Popen[str], name: str) -> None:
    """End a process by SIGINT, if it still runs, and print the rest of its output."""
    if process.poll() is None:
        process.send_signal(signal.SIGINT)
    if process.stdout is None or process.stdout.closed:
        return  # its output has been read to the end, so it has ended
    try:
        output, _ = process.communicate(timeout=LIMIT)
    except subprocess.TimeoutExpired:
        process.kill()
        output, _ = process.communicate()
        raise AssertionError(f"{name} does not end by SIGINT") from None
    finally:
        print(f"--- the rest of what {name} printed:\n{output}")


def stop(process: subprocess.Popen[str], number: signal.Signals) -> tuple[int, str]:
    """Send a signal and return the exit code and all that was printed."""
    process.send_signal(number)
    output, _ = process.communicate(timeout=LIMIT)
    return process.returncode, output


def read_line(process: subprocess.Popen[str]) -> str:
    """Return the next line that a program prints; if none comes in time, the program is killed."""
    assert process.stdout is not None
    watchdog = threading.Timer(LIMIT, process.kill)
    watchdog.start()
    try:
        return process.stdout.readline()
    finally:
        watchdog.cancel()


_TURN = 0.05
"""Seconds for which a peer waits for a message before it looks at its condition again."""


class Peer:
    """A node of the test itself, in the domain of ``env``, that spins only while it waits.

    Attributes:
        held_up: seconds, over all waits, for which the machine did not let it go on. A bound on
            a reaction counts the program's own time; one that a test measures allows for these.
    """

    def __init__(self, domain: int, name: str = "test_peer") -> None:
        """Start the node; end it with :meth:`close`."""
        import rclpy
        from rclpy.context import Context
        from rclpy.executors import SingleThreadedExecutor
        from rclpy.node import Node
        from rclpy.parameter import Parameter

        self._context = Context()
        rclpy.init(context=self._context, domain_id=domain)
        # Without what every node has and no test asks for: it is found, and gone, the sooner.
        described = Parameter("start_type_description_service", value=False)
        self.held_up = 0.0
        self.node: Any = Node(
            name,
            context=self._context,
            enable_rosout=False,
            start_parameter_services=False,
            parameter_overrides=[described],
        )
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self.node)

    def until(self, condition: Callable[[], Any], limit: float = LIMIT) -> Any:
        """Spin until ``condition()`` is true, and return what it returned.

        Raises:
            AssertionError: if that does not happen within ``limit`` seconds, those not counted
                for which the machine held the test up.
        """
        left, now = limit, time.monotonic()
        while not (result := condition()):
            assert left > 0, "the awaited event did not come"
            self._executor.spin_once(timeout_sec=_TURN)
            before, now = now, time.monotonic()
            counted = min(now - before, 2 * _TURN)
            left -= counted
            self.held_up += now - before - counted
        return result

    def call(self, client: Any, request: Any) -> Any:
        """Call a service once its server is there, and return the response."""
        self.until(client.service_is_ready)
        future = client.call_async(request)
        self.until(future.done)
        return future.result()

    def close(self) -> None:
        """Take the node out of the domain."""
        self._executor.remove_node(self.node)
        self.node.destroy_node()
        self._executor.shutdown()
        self._context.try_shutdown()


def set_parameter(peer: Peer, node: str, **values: Any) -> list[Any]:
    """Set parameters of a node by its service and return the results."""
    from rcl_interfaces.srv import SetParameters
    from rclpy.parameter import Parameter

    client = peer.node.create_client(SetParameters, f"/{node}/set_parameters")
    wanted = [Parameter(name, value=value).to_parameter_msg() for name, value in values.items()]
    return list(peer.call(client, SetParameters.Request(parameters=wanted)).results)


@pytest.fixture
def ros_peer(ros_env: dict[str, str], monkeypatch: pytest.MonkeyPatch) -> Iterator[Peer]:
    """Give a node in the test's own process that shares the domain of ``ros_env``.

    Fast DDS reads the profile once in a process, so it is the same for all tests.
    """
    for name, value in _CONFINED.items():
        monkeypatch.setenv(name, value)
    peer = Peer(int(ros_env["ROS_DOMAIN_ID"]))
    yield peer
    peer.close()
