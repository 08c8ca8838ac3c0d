"""The least that Python allows: sleep, and look at the clock; no ROS. Prints how late, in ns."""

from __future__ import annotations

import json
import signal
import sys
import time
from types import FrameType

from reaction_nodes.timers import time_exactly

SECONDS = 0.4


def main() -> None:
    """Sleep again and again until SIGINT or SIGTERM."""
    time_exactly()
    signal.signal(signal.SIGINT, _leave)
    signal.signal(signal.SIGTERM, _leave)
    late: list[int] = []
    try:
        while True:
            start = time.monotonic_ns()
            time.sleep(SECONDS)
            late.append(time.monotonic_ns() - start - round(SECONDS * 1e9))
    finally:
        json.dump(late, sys.stdout)


def _leave(_number: int, _frame: FrameType | None) -> None:
    sys.exit(0)


if __name__ == "__main__":
    main()
