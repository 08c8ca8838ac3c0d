"""The launch file of the documentation becomes the system that stands below it."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.support.cli import deros
from tests.support.pages import blocks


def test_launch_file_of_the_page(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """By the command that is printed above it, without anything that is left out."""
    page = [block for block in blocks() if block.page == "docs/importing.md"]
    command, launch, system = (
        next(block.text for block in page if block.language == language)
        for language in ("console", "xml", "rossystem")
    )
    (tmp_path / "bringup.launch.xml").write_text(launch, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    outcome = deros(*command.removeprefix("$ deros ").split())
    assert outcome.code == 0, outcome.out
    assert (tmp_path / "models/bringup.system").read_text(encoding="utf-8") == system
    assert deros("check", "models/bringup.system").code == 0


def test_parameter_file_of_the_page(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """By the command that is printed in its section."""
    page = [block for block in blocks() if block.page == "docs/importing.md"]
    command = next(b.text for b in page if b.language == "console" and "params.yaml" in b.text)
    (tmp_path / "params.yaml").write_text("lidar:\n  ros__parameters: {rate: 1.0}\n")
    monkeypatch.chdir(tmp_path)
    assert deros(*command.removeprefix("$ deros ").split()).code == 0
    assert deros("check", "models/robot.system").code == 0
