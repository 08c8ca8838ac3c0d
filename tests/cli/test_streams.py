"""Output that cannot be written as it is: characters that the terminal lacks, a full disk."""

from __future__ import annotations

import io
import json
import os
import resource
import subprocess
import sys
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from deros.cli import streams

ENCODINGS = ("ascii", "latin-1", "cp1252", "utf-8")
LIMIT = 60.0

SYSTEM = """system Robot
topics
  external topic /effort : std_msgs.Float64
"""
RULES = """use "robot.system" import Robot
entity drive {{ overload: topic /effort.data > {limit}; }}
behaviour protect: if drive.overload then {{ log_state("too much"); }};
"""


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    """Return a folder with a robot, rules, and rules with a slip."""
    (tmp_path / "robot.system").write_text(SYSTEM)
    (tmp_path / "rules.deros").write_text(RULES.format(limit=30), encoding="utf-8")
    (tmp_path / "slip.deros").write_text(RULES.format(limit="“30” → 5"), encoding="utf-8")
    return tmp_path


def run(
    *arguments: str, folder: Path, encoding: str = "utf-8", full: bool = False, room: int = -1
) -> subprocess.CompletedProcess[str]:
    """Run ``python -m deros`` with standard output in an encoding, or to a full disk.

    Args:
        *arguments: of the command.
        folder: to run in.
        encoding: of the output.
        full: whether the output goes to a disk without room.
        room: bytes that a file may have at most; any number if negative.
    """
    command = [sys.executable, "-m", "deros", *arguments]
    environment = {**os.environ, "PYTHONIOENCODING": encoding, "NO_COLOR": "1"}
    with Path("/dev/full").open("w", encoding="utf-8") as nowhere:
        return subprocess.run(
            command,
            check=False,
            timeout=LIMIT,
            cwd=folder,
            env=environment,
            stdout=nowhere if full else subprocess.PIPE,
            stderr=subprocess.PIPE,
            encoding=encoding,
            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (room, room)),
        )


@pytest.mark.parametrize("encoding", ENCODINGS)
def test_finding_is_shown_in_any_encoding(robot: Path, encoding: str) -> None:
    """The finding, its line and its exit code stay; no character is lost without a trace."""
    done = run("check", "slip.deros", folder=robot, encoding=encoding)
    assert done.returncode == 1, done
    assert "slip.deros:2:" in done.stdout
    assert ("” → 5" if encoding == "utf-8" else "-> 5") in done.stdout
    assert "bug" not in done.stderr


@pytest.mark.parametrize("encoding", ENCODINGS)
def test_json_stays_json_in_any_encoding(robot: Path, encoding: str) -> None:
    """What stands for a character ends no string."""
    done = run("check", "slip.deros", "--format", "json", folder=robot, encoding=encoding)
    assert done.returncode == 1, done
    told = "or', …" if encoding in ("utf-8", "cp1252") else "or', ..."
    assert any(told in each["message"] for each in json.loads(done.stdout))


@given(st.text())
def test_any_text_can_be_written(text: str) -> None:
    """Each character gives something, and none that ends a line or a string of JSON."""
    assert streams  # registers the way to write them
    raw = io.BytesIO()
    with io.TextIOWrapper(raw, "ascii", "deros.readable", newline="") as out:
        out.write(text)
        out.flush()
        written = raw.getvalue().decode("ascii")
    for character in set(text):
        if not character.isascii():
            instead = character.encode("ascii", "deros.readable").decode("ascii")
            assert instead
            assert not set(instead) & set('"\\\n\r\t'), character
    assert len(written) >= len(text)


@pytest.mark.parametrize(
    "command",
    ["check rules.deros", "explain DRS317", "--help", "check --help", "graph robot.system"],
)
def test_output_on_a_full_disk_is_told(robot: Path, command: str) -> None:
    """In one line, as a fault of the output, without a traceback."""
    done = run(*command.split(), folder=robot, full=True)
    assert done.returncode == 2
    assert done.stderr == "deros: cannot write the output: No space left on device\n"


def test_new_on_a_full_disk_leaves_nothing(robot: Path) -> None:
    """The message has the path; the next run, with room, is not hindered by halves of files."""
    arguments = ("new", "system", "courier", "-o", "models")
    done = run(*arguments, folder=robot, room=0)
    assert done.returncode == 2, done
    assert "cannot write models" in done.stderr
    assert not (robot / "models").exists()
    assert run(*arguments, folder=robot).returncode == 0
