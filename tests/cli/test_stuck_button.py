"""What users start from: a button that is stuck releases no robot."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.support import fragments, pages
from tests.support.cli import deros


def _documented(folder: Path) -> tuple[Path, str, str]:
    """Write the first program of the page on rules."""
    (block, *_) = (each for each in pages.blocks() if each.page == "docs/languages/rules.md")
    shutil.copy(fragments.DATA / "Courier.system", folder)
    (folder / "courier.deros").write_text(block.text, encoding="utf-8")
    return folder / "courier.deros", "/release", "released"


def _started(folder: Path) -> tuple[Path, str, str]:
    """Write the rules that ``deros new`` starts with."""
    assert deros("new", "rules", "courier", "-o", folder).code == 0
    return folder / "courier.deros", "/resume", "resume"


def _trace(button: str, topic: str, sensors: bool) -> str:
    """Return ten seconds of messages, one of the button each 0.1 s: ``1``, ``0`` or ``-``, none."""
    messages = []
    for number, state in enumerate(button, start=1):
        t = number / 10
        if sensors:
            upright = {"orientation.w": 1.0, "orientation.x": 0.0}
            upright |= {"orientation.y": 0.0, "orientation.z": 0.0}
            messages.append({"t": f"{t:.2f}", "topic": "/imu", "data": upright})
        still = {"twist.twist.linear.x": "NaN" if number == 5 else 0.0}
        messages.append({"t": f"{t + 0.01:.2f}", "topic": "/odom", "data": still})
        if state != "-":
            pressed = {"data": state == "1"}
            messages.append({"t": f"{t + 0.02:.2f}", "topic": topic, "data": pressed})
    return "".join(json.dumps(each) + "\n" for each in messages)


@pytest.mark.parametrize("program", [_documented, _started])
@pytest.mark.parametrize(
    ("button", "resets"),
    [
        ("1" * 80, 0),  # stuck from the start, before the stop
        ("1" * 20 + "-" * 20 + "1" * 20, 0),  # and back after a gap
        ("-" * 20 + "1" * 20, 0),  # comes late, already pressed
        ("0" * 20 + "-" * 25 + "1" * 20, 0),  # pressed while nobody saw it
        ("0" * 20 + "-" * 15 + "1" * 20, 0),  # the same, and back soon after the timeout
        ("0" * 30 + "1" * 10, 1),  # pressed before their eyes
        ("1" * 30 + "0" * 5 + "1" * 10, 1),  # released first
    ],
)
def test_stuck_button_releases_nothing(
    tmp_path: Path,
    program: Callable[[Path], tuple[Path, str, str]],
    button: str,
    resets: int,
) -> None:
    """Only a press that was seen resets the stop, which each trace begins with."""
    rules, topic, action = program(tmp_path)
    trace = tmp_path / "trace.jsonl"
    trace.write_text(_trace(button, topic, topic == "/release"), encoding="utf-8")
    outcome = deros("simulate", rules, "--trace", trace, "--until", len(button) / 10)
    assert outcome.code == 0, outcome
    events = [json.loads(line) for line in outcome.out.splitlines()]
    triggers = [each["action"] for each in events if each["event"] == "trigger"]
    assert "stop" in triggers
    assert triggers.count(action) == resets
    assert [each["action"] for each in events if each["event"] == "reset"] == ["stop"] * resets
