"""``deros import``: what is wrong on the command line, and what the output says of files."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from deros.cli.commands import import_
from deros.live.snapshots import End, SeenNode, Snapshot
from deros.models.common import QosProfile
from deros.models.node import PortKind
from tests.support.cli import deros


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ([], "say what to import: FILES, or --live for the running graph"),
        (["--live", "--name", "my robot"], "'my robot' cannot be the name of a system"),
        (["--live", "--name", "../x"], "'../x' cannot be the name of a system"),
        (["--live", "--domain", "233"], "Invalid value for '--domain'"),
        (["--live", "--timeout", "0"], "Invalid value for '--timeout'"),
    ],
)
def test_mistakes_are_usage_errors(arguments: list[str], said: str, tmp_path: Path) -> None:
    """Nothing is looked at or written."""
    outcome = deros("import", *arguments, "-o", tmp_path / "out")
    assert outcome.code == 2
    assert said in outcome.err
    assert not (tmp_path / "out").exists()


def test_environment_without_rclpy_says_what_to_install(tmp_path: Path) -> None:
    """It is a usage error like any other, without a traceback."""
    script = (
        "import sys; sys.modules['rclpy'] = None; from deros.cli.main import main;"
        "main(['import', '--live'])"
    )
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=False, cwd=tmp_path
    )
    assert done.returncode == 2
    assert "source the setup file of ROS 2" in done.stderr
    assert list(tmp_path.iterdir()) == []


def _at(monkeypatch: pytest.MonkeyPatch, *topics: str) -> None:
    """Let a graph with a lidar run, which publishes some topics."""
    qos = QosProfile(reliability="reliable", durability="volatile")
    ends = tuple(End(PortKind.PUBLISHER, each, "std_msgs/msg/Bool", qos) for each in topics)
    seen = Snapshot((SeenNode("/lidar", ends, ()),))
    monkeypatch.setattr(import_, "_seen", lambda *_: seen)


def test_output_names_the_files(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Written ones, then nothing for those that have not changed."""
    _at(monkeypatch, "/a")
    first, second = (deros("import", "--live", "-o", tmp_path) for _ in range(2))
    following = f"next: deros check {tmp_path}/robot.system\n"
    written = f"wrote {tmp_path}/nodes/lidar.rnd\nwrote {tmp_path}/robot.system\n"
    assert (first.code, first.out) == (0, written + following)
    assert (second.code, second.out) == (0, following)


def test_edited_and_old_files_are_named(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """An edit below the line makes the exit code 1: the model is not what runs."""
    _at(monkeypatch, "/a")
    deros("import", "--live", "-o", tmp_path)
    path = tmp_path / "nodes/lidar.rnd"
    path.write_text(path.read_text(encoding="utf-8") + "// mine\n", encoding="utf-8")
    (tmp_path / "nodes/radar.rnd").write_text("node radar : radar\n", encoding="utf-8")
    _at(monkeypatch, "/b")
    outcome = deros("import", "--live", "-o", tmp_path)
    assert outcome.code == 1
    lines = outcome.out.splitlines()
    edited = "what was imported was edited there; compare it with nodes/lidar.rnd.new"
    assert f"kept {path}: {edited}" in lines
    assert f"kept {tmp_path}/nodes/radar.rnd: no node of this type runs now" in lines


def test_folder_that_cannot_be_written_is_an_error(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """A file where the folder has to be, and a folder where a file has to be."""
    _at(monkeypatch, "/a")
    (tmp_path / "nodes").write_text("", encoding="utf-8")
    assert deros("import", "--live", "-o", tmp_path).code == 2
    (tmp_path / "other" / "robot.system").mkdir(parents=True)
    outcome = deros("import", "--live", "-o", tmp_path / "other")
    assert outcome.code == 2
    assert "Traceback" not in outcome.err
