"""``deros format``: what it writes, what it leaves, and how it exits."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.support.cli import deros

BAD = "node lidar:lidar_driver\npublishes\ntopic scan:sensor_msgs.LaserScan;\n"
GOOD = "node lidar : lidar_driver\npublishes\n  topic scan : sensor_msgs.LaserScan;\n"
BROKEN = "node lidar : lidar_driver\npublishes\ntopic scan :\n"


@pytest.fixture
def model(tmp_path: Path) -> Path:
    """Return a file that is not formatted."""
    path = tmp_path / "lidar.rnd"
    path.write_text(BAD, encoding="utf-8")
    return path


def _leftovers(folder: Path) -> set[str]:
    return {each.name for each in folder.iterdir()}


def test_files_and_folders_are_formatted(model: Path) -> None:
    """The second run has nothing to do, and does not touch the file."""
    outcome = deros("format", model.parent)
    assert (outcome.code, outcome.out, outcome.err) == (0, f"formatted {model}\n", "")
    assert model.read_text(encoding="utf-8") == GOOD
    before = model.stat()
    assert deros("format", model) == deros("format", model.parent)
    after = model.stat()
    assert (before.st_mtime_ns, before.st_ino) == (after.st_mtime_ns, after.st_ino)
    assert _leftovers(model.parent) == {"lidar.rnd"}


def test_check_and_diff_write_nothing(model: Path) -> None:
    """``--check`` fails on what would change; ``--diff`` alone does not."""
    checked, shown = deros("format", "--check", model), deros("format", "--diff", model)
    both = deros("format", "--check", "--diff", model)
    assert (checked.code, checked.out, checked.err) == (1, "", f"would format {model}\n")
    assert (shown.code, both.code) == (0, 1)
    assert "-topic scan:sensor_msgs.LaserScan;\n" in shown.out
    assert "+  topic scan : sensor_msgs.LaserScan;\n" in shown.out
    assert both.out == shown.out
    assert model.read_text(encoding="utf-8") == BAD
    model.write_text(GOOD, encoding="utf-8")
    assert deros("format", "--check", "--diff", model) == deros("format", model)


def test_a_syntax_error_is_shown_and_left(model: Path) -> None:
    """Other files are formatted all the same."""
    broken = model.parent / "broken.rnd"
    broken.write_text(BROKEN, encoding="utf-8")
    outcome = deros("format", broken, model)
    assert outcome.code == 2
    assert "broken.rnd:3:13: error[DRS003" in outcome.err
    assert broken.read_text(encoding="utf-8") == BROKEN
    assert model.read_text(encoding="utf-8") == GOOD


def test_links_modes_and_marks_stay(model: Path) -> None:
    """A link still leads to the file, which has its mode, its mark and its line ends."""
    model.write_bytes(b"\xef\xbb\xbf" + BAD.replace("\n", "\r\n").encode())
    model.chmod(0o750)
    link = model.parent / "link.rnd"
    link.symlink_to("lidar.rnd")
    assert deros("format", link).code == 0
    assert link.is_symlink()
    assert model.read_bytes() == b"\xef\xbb\xbf" + GOOD.replace("\n", "\r\n").encode()
    assert model.stat().st_mode & 0o777 == 0o750
    assert deros("format", "--check", model).code == 0


def test_what_cannot_be_written_is_said(model: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A file that is write-protected is not replaced, though its folder would allow it."""
    monkeypatch.setattr(
        os, "access", lambda _, mode, **__: mode != os.W_OK
    )  # root may write everything
    outcome = deros("format", model)
    assert (outcome.code, outcome.out) == (2, "")
    assert f"cannot write '{model}': it is write-protected" in outcome.err
    assert model.read_text(encoding="utf-8") == BAD


@pytest.mark.parametrize(
    ("arguments", "why"),
    [
        (["-"], "- needs --stdin-filename NAME"),
        (["-", "lidar.rnd"], "- stands alone"),
        (["lidar.txt"], "'lidar.txt' is not a model: its name ends in none of .rnd"),
        (["-", "--stdin-filename", "lidar"], "'lidar' is not a model"),
    ],
)
def test_wrong_use_is_said(arguments: list[str], why: str) -> None:
    """Nothing is read before."""
    outcome = deros("format", *arguments)
    assert outcome.code == 2
    assert why in outcome.err


def test_a_file_that_is_not_there_is_said(tmp_path: Path) -> None:
    """As ``deros check`` says it."""
    outcome = deros("format", tmp_path / "none.rnd")
    assert outcome.code == 2
    assert "DRS001" in outcome.err


@pytest.mark.parametrize(
    ("data", "code", "out", "err"),
    [
        (BAD.encode(), 0, GOOD.encode(), b""),
        (BAD.replace("\n", "\r\n").encode(), 0, GOOD.replace("\n", "\r\n").encode(), b""),
        (f'{BAD.replace(";", "")} "\N{GREEK SMALL LETTER OMEGA}"'.encode(), 0, None, b""),
        (BROKEN.encode(), 2, b"", b"a.rnd:3:13: error[DRS003"),
        (b"node \xff", 2, b"", b"'a.rnd' is not UTF-8 text"),
    ],
)
def test_standard_input_becomes_standard_output(
    data: bytes, code: int, out: bytes | None, err: bytes
) -> None:
    """Byte for byte, whatever the encoding of the terminal is; of a broken text, nothing."""
    done = subprocess.run(
        [sys.executable, "-m", "deros", "format", "-", "--stdin-filename", "a.rnd"],
        input=data,
        capture_output=True,
        env={**os.environ, "PYTHONIOENCODING": "ascii"},
        check=False,
        timeout=60,
    )
    assert done.returncode == code, done.stderr
    if out is not None:
        assert done.stdout == out
    else:
        assert "\N{GREEK SMALL LETTER OMEGA}".encode() in done.stdout
    assert err in done.stderr
