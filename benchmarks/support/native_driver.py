"""The driver in C++ (``reaction_cpp/driver.cpp``), controlled in a process of its own."""

from __future__ import annotations

import math
import subprocess
import time
from collections import defaultdict
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from support.processes import ProcessError
from support.reaction_rules import Lane

_TILTED = math.radians(20.0)


class NativeChannel:
    """Both topics of a lane, from the driver's side; as :class:`support.experiment.Channel`."""

    def __init__(self, driver: NativeDriver, number: int, lane: Lane, resets: bool) -> None:
        """Stand for the lane of that number."""
        self._driver = driver
        self._number = number
        self.lane = lane
        self.resets = resets
        self.sent = 0
        self.received = 0

    def tilt(self) -> None:
        """Tilt; the answer is a true state, some time."""
        self._send("send", True)

    def ask(self, tilted: bool, limit: int) -> bool:
        """Tilt or level, and receive until the answer comes, for at most ``limit`` ns.

        Returns:
            whether it came.
        """
        self._send("ask", tilted, str(limit))
        return self.received != 0

    def _send(self, command: str, tilted: bool, *more: str) -> None:
        self.received = 0
        roll = _TILTED if tilted else 0.0
        expected = "1" if tilted or not self.resets else "0"
        words = (command, str(self._number), str(roll), expected, *more)
        self.sent = self._driver.command(*words)


class NativeDriver:
    """The process with all its channels; ends with :meth:`close`.

    Args:
        program: the driver.
        env: the environment it runs in.
        lanes: the lanes, and whether the other side's state turns false when it is levelled.
        records: topics of events that are kept.
    """

    def __init__(
        self,
        program: Path,
        env: Mapping[str, str],
        lanes: Sequence[tuple[Lane, bool]],
        records: Sequence[str],
    ) -> None:
        """Start it."""
        ends = [f"lane:{lane.imu}:{lane.state}" for lane, _ in lanes]
        ends += [f"record:{topic}" for topic in records]
        pipe = subprocess.PIPE
        self._process = subprocess.Popen(
            [str(program), *ends], env=env, stdin=pipe, stdout=pipe, text=True, bufsize=1
        )
        self.channels = [
            NativeChannel(self, number, lane, resets) for number, (lane, resets) in enumerate(lanes)
        ]

    def command(self, *words: str) -> int:
        """Have something done, take in what has come, and return when a message was sent."""
        sent, *pairs = map(int, self._answer(*words).split())
        for number, instant in zip(pairs[::2], pairs[1::2], strict=True):
            self.channels[number].received = instant
        return sent

    def meet(self, seconds: float, watch: Callable[[], None]) -> None:
        """Wait until all endpoints are connected; ``watch`` is called often.

        Raises:
            TimeoutError: if there still is not after so many seconds.
        """
        end = time.monotonic() + seconds
        while missing := self._answer("meet", "20").split():
            if time.monotonic() > end:
                raise TimeoutError(f"no endpoint is connected to {', '.join(missing)}")
            watch()

    def spin_until(self, instant: int) -> None:
        """Receive until an instant of CLOCK_MONOTONIC, in ns."""
        self.command("until", str(instant))

    def records(self) -> dict[str, list[bytes]]:
        """Return the messages that have come on each topic of events."""
        found: dict[str, list[bytes]] = defaultdict(list)
        for record in self._answer("records").split():
            topic, _, data = record.partition(":")
            found[topic].append(bytes.fromhex(data))
        return found

    def close(self) -> None:
        """End the process."""
        try:
            self._process.communicate(timeout=10.0)  # closes its stdin, which ends it
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.communicate()

    def _answer(self, *words: str) -> str:
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        try:
            self._process.stdin.write(" ".join(words) + "\n")
            answer = self._process.stdout.readline()
        except BrokenPipeError:
            answer = ""
        if not answer:
            raise ProcessError(f"the driver has ended with {self._process.wait(10.0)}")
        return answer
