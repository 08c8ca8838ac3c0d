"""Runs ``deros`` as a person does at a robot: as a process, in the robot's domain."""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Callable, Mapping
from pathlib import Path

from tests.support.cli import Outcome
from tests.support.ros import LIMIT

DEROS = str(Path(sys.executable).with_name("deros"))


def deros_at(env: Mapping[str, str], *arguments: str) -> Outcome:
    """Run ``deros`` in an environment, with the limit of the tests as its own."""
    done = subprocess.run(
        [DEROS, arguments[0], "--timeout", str(LIMIT), *arguments[1:]],
        env=env,
        capture_output=True,
        text=True,
        timeout=2 * LIMIT,
        check=False,
    )
    return Outcome(done.returncode, done.stdout, done.stderr)


def deros_until(
    env: Mapping[str, str], accepted: Callable[[Outcome], bool], *arguments: str
) -> Outcome:
    """Run ``deros`` again and again until its outcome is accepted, and return that.

    Raises:
        AssertionError: if that does not happen in time.
    """
    end = time.monotonic() + 2 * LIMIT
    while not accepted(outcome := deros_at(env, *arguments)):
        assert time.monotonic() < end, outcome
    return outcome
