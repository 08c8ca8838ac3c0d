"""Tests on ROS that failed, and passed when they were run once more, alone.

Each such rerun is kept in a file of this user's, ``reruns.jsonl`` in ``$XDG_STATE_HOME/deros`` or
``~/.local/state/deros``. A test that needed it twice within a week is a defect: ``python -m
tools.reruns`` lists the week, and ends with exit code 1 if there is one.
"""

from __future__ import annotations

import json
import os
import sys
import time
from collections import Counter
from collections.abc import Iterable
from dataclasses import asdict, dataclass, field
from pathlib import Path

WEEK_S = 7 * 24 * 3600.0
MOST = 1
"""How many reruns of a test in a week are still bad luck."""


@dataclass(frozen=True)
class Rerun:
    """One of them.

    Attributes:
        test: its id.
        failure: how it failed, in one line.
        first_s, alone_s: what it took, with the others and alone.
        load: processes that wanted to run per processor, in the minute before its end.
        time: when, in seconds since the epoch.
    """

    test: str
    failure: str
    first_s: float
    alone_s: float
    load: float
    time: float = field(default_factory=time.time)

    def __str__(self) -> str:
        """Return the line that a developer reads."""
        return (
            f"{self.test}: failed after {self.first_s:.1f} s at a load of {self.load:.1f} per "
            f"processor ({self.failure}), passed alone in {self.alone_s:.1f} s"
        )


def default_path() -> Path:
    """Return the file of this user."""
    state = os.environ.get("XDG_STATE_HOME") or Path.home() / ".local" / "state"
    return Path(state) / "deros" / "reruns.jsonl"


def keep(reruns: Iterable[Rerun], path: Path) -> None:
    """Append reruns to a file."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("a", encoding="utf-8") as file:
        file.writelines(json.dumps(asdict(rerun)) + "\n" for rerun in reruns)


def of_the_week(path: Path) -> list[Rerun]:
    """Return the reruns of the last seven days in a file."""
    if not path.exists():
        return []
    lines = path.read_text(encoding="utf-8").splitlines()
    found = [Rerun(**json.loads(line)) for line in lines]
    return [rerun for rerun in found if time.time() - rerun.time < WEEK_S]


def defects(reruns: Iterable[Rerun]) -> list[str]:
    """Return the tests that needed more reruns than bad luck explains."""
    counts = Counter(rerun.test for rerun in reruns)
    return sorted(test for test, count in counts.items() if count > MOST)


def main() -> int:
    """List the reruns of the week; return the exit code."""
    reruns = of_the_week(default_path())
    for rerun in reruns:
        print(rerun)
    for test in defects(reruns):
        print(f"{test} needed it more than once within a week: mend its cause")
    return 1 if defects(reruns) else 0


if __name__ == "__main__":
    sys.exit(main())
