"""Processes to break: they can be killed, frozen and fed."""

from __future__ import annotations

import base64
import contextlib
import json
import re
import select
import signal
import subprocess
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, TextIO

from tests.support.played import button, command, imu, scan, speed
from tests.support.processes import freeze, thaw
from tests.support.ros import LIMIT

_SENSOR = Path(__file__).with_name("sensor.py")
_ALARMS = re.compile(
    r"Traceback|\[FATAL\]|Segmentation|terminate called|core dumped", re.IGNORECASE
)


def waited(pid: int) -> float:
    """Return the seconds for which a process was ready to run and other processes ran instead.

    Those of all its threads are added up. It is 0 where the kernel does not count them.
    """
    total = 0
    for counted in Path(f"/proc/{pid}/task").glob("*/schedstat"):
        with contextlib.suppress(OSError):  # the thread has ended
            total += int(counted.read_text(encoding="ascii").split()[1])
    return total / 1e9


class Process:
    """A process of the robot: its output goes to a file, because a full pipe would block it."""

    def __init__(
        self, command: Sequence[str], env: Mapping[str, str], log: Path, stdin: int | None = None
    ) -> None:
        """Start the command."""
        self.name = log.stem
        self.command, self.env = command, env
        self._log = log
        self._waited = 0.0
        with log.open("w") as file:
            self.popen = subprocess.Popen(
                command, env=env, stdin=stdin, stdout=file, stderr=subprocess.STDOUT, text=True
            )

    def kill(self) -> None:
        """End it as a crash would: without a word."""
        self.waited()
        self.popen.kill()
        self.popen.wait(LIMIT)

    def freeze(self) -> None:
        """Let it hang, as a deadlock or a swapping machine would."""
        freeze(self.popen.pid)

    def thaw(self) -> None:
        """Let it go on."""
        thaw(self.popen.pid)

    def output(self) -> str:
        """Return what it has printed up to now."""
        return self._log.read_text(encoding="utf-8", errors="replace")

    def waited(self) -> float:
        """Return the seconds for which it has been ready to run and other processes ran instead.

        Those of a process that has ended are the last known ones.
        """
        self._waited = max(self._waited, waited(self.popen.pid))
        return self._waited

    def memory(self) -> int:
        """Return the bytes of memory that are its own."""
        status = Path(f"/proc/{self.popen.pid}/status").read_text(encoding="ascii")
        return int(re.findall(r"RssAnon:\s+(\d+) kB", status)[0]) * 1024

    def end(self) -> None:
        """End it by SIGINT.

        Raises:
            AssertionError: if that does not end it well, or it has printed what no node should.
        """
        self.popen.send_signal(signal.SIGINT)
        try:
            code = self.popen.wait(LIMIT)
        except subprocess.TimeoutExpired:
            raise AssertionError(f"{self.name} hangs: it does not end by SIGINT") from None
        assert code == 0, f"{self.name} ended with {code}"
        found = _ALARMS.search(self.output())
        assert found is None, f"{self.name} printed {found and found[0]}"


class Sensors:
    """The process that plays the robot's sensors, by :mod:`tests.support.sensor`."""

    def __init__(self, topics: Mapping[str, str], env: Mapping[str, str]) -> None:
        """Start it, with a publisher for each topic."""
        self._topics = topics.keys()
        self._frozen = False
        self._waited = 0.0
        command = [sys.executable, str(_SENSOR), *(f"{t}={name}" for t, name in topics.items())]
        self._popen = subprocess.Popen(
            command, env=env, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )
        self._answer()

    def match(self, *topics: str) -> None:
        """Wait until the safety node listens to each of the topics.

        The test's end listens to the speed, too.
        """
        for topic in topics:
            self._do({"match": topic, "count": 2 if topic == "/speed" else 1})

    def play(self, topic: str, *messages: Any, rate: float = 50.0) -> None:
        """Publish the messages in turn, again and again."""
        self._do({"play": topic, "messages": _serialized(messages), "rate": rate})

    def drive(self) -> None:
        """Play a robot that keeps to its rules, and an operator who undoes what was before."""
        played = {
            "/speed": [speed(0.3)],
            "/imu": [imu()],
            "/button": [button(True), button(False)],
            "/cmd_vel_nav": [command()],
        }
        for topic in played.keys() & self._topics:
            self.play(topic, *played[topic])
        if "/scan" in self._topics:
            self.play("/scan", scan(5.0), rate=10.0)
        self.match(*{"/speed", "/imu", "/button"} & self._topics)

    def quiet(self, topic: str) -> int:
        """Publish nothing on this topic any more; return how many messages have been played."""
        return self._do({"quiet": topic})

    def send(self, topic: str, *messages: Any, times: int = 0, rate: float = 1e6) -> None:
        """Publish the messages in turn, each once or so many ``times`` in all; wait for the end."""
        command = {"send": topic, "messages": _serialized(messages), "rate": rate}
        self._do({**command, "times": times or len(messages)})

    def waited(self) -> float:
        """Return the seconds for which it has been ready to run and other processes ran instead.

        Those of a process that has ended are the last known ones.
        """
        self._waited = max(self._waited, waited(self._popen.pid))
        return self._waited

    def kill(self) -> None:
        """End the sensors as a crash would."""
        self.waited()
        self._popen.kill()
        self._popen.wait(LIMIT)

    def freeze(self) -> None:
        """Let the sensors hang."""
        freeze(self._popen.pid)
        self._frozen = True

    def thaw(self) -> None:
        """Let the sensors go on."""
        thaw(self._popen.pid)
        self._frozen = False

    def close(self) -> None:
        """End the process, in whatever state it is: in an orderly way, if it can.

        Then all others know at once that its publishers are gone, and not after the lease.
        """
        with contextlib.suppress(BrokenPipeError), self._popen:
            if self._frozen:
                self._popen.kill()
            _present(self._popen.stdin).close()
            try:
                self._popen.wait(LIMIT)
            finally:
                self._popen.kill()

    def _do(self, command: dict[str, Any]) -> int:
        pipe = _present(self._popen.stdin)
        pipe.write(json.dumps(command) + "\n")
        pipe.flush()
        return self._answer()

    def _answer(self) -> int:
        pipe = _present(self._popen.stdout)
        assert select.select([pipe], [], [], LIMIT)[0], "the sensors do not answer"
        answer = pipe.readline().strip()
        assert answer.isdigit(), "the sensors have failed"
        return int(answer)


def _present(pipe: Any) -> TextIO:
    assert pipe is not None
    return pipe  # type: ignore[no-any-return]


def _serialized(messages: Sequence[Any]) -> list[str]:
    """Return messages as the sensors take them; bytes are passed on as they are."""
    from rclpy.serialization import serialize_message

    raw = (each if isinstance(each, bytes) else serialize_message(each) for each in messages)
    return [base64.b64encode(each).decode("ascii") for each in raw]
