"""Parsing in ``make distribution``: requirements of a wheel, missing files, interpreters."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from tests.support.cli import deros
from tools import distribution

METADATA = """\
Metadata-Version: 2.4
Name: deros
Classifier: Programming Language :: Python :: 3
Classifier: Programming Language :: Python :: 3.13
Classifier: Programming Language :: Python :: 3.9
Requires-Dist: click>=8.2.0
Requires-Dist: textx<4.5,>=4.3.0
Requires-Dist: pytest>=8; extra == 'dev'
"""


def test_floors_are_those_of_required_packages() -> None:
    """Upper bounds and extras are ignored, and 3.9 comes before 3.13."""
    promises = distribution.read_promises(METADATA)
    assert promises.floors == {"click": "8.2.0", "textx": "4.3.0"}
    assert promises.pythons == ("3.9", "3.13")


def test_requirement_without_floor_is_rejected() -> None:
    """Without a floor there is no lowest version to test."""
    with pytest.raises(distribution.Failure, match="rich"):
        distribution.read_promises(METADATA.replace("click>=8.2.0", "rich<16"))


def test_missing_source_files_are_named() -> None:
    """Folders that other folders link to were once missing from the source distribution."""
    tracked = ["src/deros/__init__.py", "src/deros/generators/output/writer.py", "README.md"]
    packed = ["src/deros/__init__.py", "generators/output/writer.py"]
    assert distribution.missing_files(tracked, packed) == ["src/deros/generators/output/writer.py"]


def test_interpreters_that_do_not_start_are_skipped(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Version managers put programs on the PATH for inactive versions."""
    version = "{}.{}".format(*sys.version_info)
    stand_in = tmp_path / "python3.99"
    stand_in.write_text("#!/bin/sh\nexit 127\n", encoding="utf-8")
    stand_in.chmod(0o755)
    (tmp_path / f"python{version}").symlink_to(sys.executable)
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setenv("PYENV_ROOT", str(tmp_path / "none"))
    assert list(distribution.find_pythons(("3.99", version))) == [version]


def test_trace_of_a_fresh_installation_ends_in_a_stop(tmp_path: Path) -> None:
    """Its messages are read, and each sensor is then missed at its own time."""
    commands = [each for each in distribution.commands(tmp_path) if "simulate" in each]
    assert len(commands) == 2
    for _, *arguments in commands:
        run = deros(*arguments, "--format", "text")
        assert (run.code, run.err) == (0, "")
        assert "speed" in run.out
        assert "orientation" in run.out
