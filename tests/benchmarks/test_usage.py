"""Machine statistics read by the benchmarks."""

from __future__ import annotations

import os
import time
from pathlib import Path

import pytest

from benchmarks.support import usage


def test_stolen_share_is_relative_to_all_processors(monkeypatch: pytest.MonkeyPatch) -> None:
    """Half a second out of ten on two processors, with 100 ticks per second."""
    texts = iter(
        f"cpu  1 2 3 4 5 6 7 {ticks} 9 10\ncpu0 1 2 3 4 5 6 7 99 9 10\n" for ticks in (700, 750)
    )
    now_ns = iter([1_000_000_000, 11_000_000_000])
    monkeypatch.setattr(Path, "read_text", lambda *_, **__: next(texts))
    monkeypatch.setattr(os, "sysconf", lambda name: {"SC_CLK_TCK": 100}[name])
    monkeypatch.setattr(os, "cpu_count", lambda: 2)
    monkeypatch.setattr(time, "monotonic_ns", lambda: next(now_ns))
    assert usage.Meter.start(usage.stolen_ns).percent() == pytest.approx(2.5)


def test_stolen_time_is_the_eighth_field_of_all_processors(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The first line is the sum; a single processor equals the average."""
    text = "cpu  1 2 3 4 5 6 7 150 9 10\ncpu0 1 2 3 4 5 6 7 99 9 10\n"
    monkeypatch.setattr(Path, "read_text", lambda *_, **__: text)
    monkeypatch.setattr(os, "sysconf", lambda name: {"SC_CLK_TCK": 100}[name])
    monkeypatch.setattr(os, "cpu_count", lambda: 1)
    assert usage.stolen_ns() == 1_500_000_000
