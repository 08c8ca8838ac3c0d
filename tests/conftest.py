"""Configuration of all tests; ``tests.support`` is importable by the path in pyproject.toml."""

from __future__ import annotations

import os
import signal
from pathlib import Path

import pytest

from tests.support import profiles

# A shell starts background jobs with SIGINT ignored; the nodes of the tests would inherit this.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)

profiles.register()

# Each check of a test is one: no folder can be made there to keep findings in.
os.environ["XDG_CACHE_HOME"] = os.devnull

pytest_plugins = (
    "pytester",
    "tests.support.needs",
    "tests.support.record",
    "tests.support.stages",
    "tests.support.golden",
    "tests.support.killing_pairs",
    "tests.support.ros",
)

collect_ignore = ["golden"]
"""Generated packages have their own tests, which run where they are built."""


@pytest.fixture
def own_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Work in a folder of the test's own."""
    monkeypatch.chdir(tmp_path)
