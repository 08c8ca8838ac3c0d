"""What benchmarks read of the machine."""

from __future__ import annotations

import os
import time
from pathlib import Path

import pytest

from benchmarks.support import usage


def test_theft_is_a_share_of_all_processors(monkeypatch: pytest.MonkeyPatch) -> None:
    """Half a second out of ten, on two processors."""
    stolen_s, now_ns = iter([7.0, 7.5]), iter([1_000_000_000, 11_000_000_000])
    monkeypatch.setattr(usage, "stolen_s", lambda: next(stolen_s))
    monkeypatch.setattr(time, "monotonic_ns", lambda: next(now_ns))
    monkeypatch.setattr(os, "cpu_count", lambda: 2)
    assert usage.Theft.start().percent() == pytest.approx(2.5)


def test_the_stolen_time_is_the_eighth_of_all_processors(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """It comes in ticks, of which the system says how many make a second."""
    text = "cpu  1 2 3 4 5 6 7 150 9 10\ncpu0 1 2 3 4 5 6 7 99 9 10\n"
    monkeypatch.setattr(Path, "read_text", lambda *_, **__: text)
    monkeypatch.setattr(os, "sysconf", lambda name: {"SC_CLK_TCK": 100}[name])
    assert usage.stolen_s() == 1.5
