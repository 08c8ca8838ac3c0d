"""The speeds of monitors, of two versions."""

from __future__ import annotations

import statistics
import subprocess
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

SLOWER = 0.05
"""By how much a monitor may be slower than it was."""


@dataclass(frozen=True, slots=True)
class Speed:
    """How many times as fast as by hand a generated monitor is, by version: medians.

    Attributes:
        before: of the other version; ``None`` if there is none.
    """

    language: str
    now: float
    before: float | None = None

    @property
    def is_slower(self) -> bool:
        """Whether it is clearly slower than it was."""
        return self.before is not None and self.now < self.before * (1 - SLOWER)


def medians(found: Mapping[str, Sequence[Mapping[str, float]]]) -> list[Speed]:
    """Return the medians of some rounds, by language.

    Args:
        found: of each version, ``now`` and perhaps ``before``, what each round measured.
    """
    made = []
    for language in found["now"][0]:
        of_all = {
            name: statistics.median(each[language] for each in rounds if language in each)
            for name, rounds in found.items()
        }
        made.append(Speed(language, of_all["now"], of_all.get("before")))
    return made


def speeds_in(rows: Mapping[str, Any]) -> dict[str, float]:
    """Return the ratios in the results of the throughput benchmark, by language."""
    return {
        row["language"]: row["generated_is_faster"]
        for row in rows["rows"]
        if row["monitor"].startswith("by hand") and row["generated_is_faster"] is not None
    }


def earlier(repository: Path) -> str:
    """Return the last tag before this commit; without one, the last commit before a week ago.

    Empty if there is none, either.
    """
    for words in (
        ["describe", "--tags", "--abbrev=0"],
        ["log", "-1", "--before=1 week ago", "--format=%h"],
    ):
        command = ["git", *words]
        done = subprocess.run(command, cwd=repository, capture_output=True, text=True, check=False)
        if found := done.stdout.strip():
            return found
    return ""
