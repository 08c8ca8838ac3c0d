"""``deros runtime``, and all ways to set the option ``--runtime``."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from tests.support.cli import deros


@pytest.fixture
def rules(tmp_path: Path) -> Path:
    """Create rules without findings."""
    assert deros("new", "rules", "robot", "-o", tmp_path / "models").code == 0
    return tmp_path / "models/robot.deros"


def test_runtime_package_is_written_and_refreshed(tmp_path: Path) -> None:
    """A second run changes nothing; an edited file is kept."""
    outcome = deros("runtime", tmp_path)
    assert outcome.code == 0, outcome.err
    module = tmp_path / "deros_runtime/deros_runtime/process.py"
    assert f"wrote {module}\n" in outcome.out
    assert "wrote" not in deros("runtime", tmp_path).out
    text = module.read_text()
    module.write_text(f"{text}# mine\n")
    outcome = deros("runtime", tmp_path)
    assert outcome.code == 0
    assert "1 file edited by hand, kept" in outcome.out
    assert deros("runtime", tmp_path, "--overwrite").code == 0
    assert module.read_text() == text


def test_folder_that_cannot_be_written_is_an_error(tmp_path: Path) -> None:
    """The message gives the reason."""
    (tmp_path / "deros_runtime").write_text("not a folder")
    outcome = deros("runtime", tmp_path)
    assert outcome.code == 2
    assert "cannot write" in outcome.err


def _depends(folder: Path) -> bool:
    return "deros_runtime" in (folder / "robot_safety/package.xml").read_text()


def test_runtime_is_chosen_by_command_line_and_project(rules: Path, tmp_path: Path) -> None:
    """The command line has precedence; without both it is a package."""
    command = ("generate", rules, "--target", "python")
    assert deros(*command, "-o", tmp_path / "a").code == 0
    assert _depends(tmp_path / "a")
    (rules.parent / "deros.toml").write_text('runtime = "copy"\n')
    assert deros(*command, "-o", tmp_path / "b").code == 0
    assert not _depends(tmp_path / "b")
    assert deros(*command, "--runtime", "package", "-o", tmp_path / "c").code == 0
    assert _depends(tmp_path / "c")


def test_textx_generate_has_the_option(rules: Path, tmp_path: Path) -> None:
    """It is passed on like every option of a generator."""
    textx = str(Path(sys.executable).with_name("textx"))
    command = [textx, "generate", str(rules), "--target", "python"]
    for runtime, depends in (("copy", False), ("package", True)):
        output = tmp_path / runtime
        done = subprocess.run(
            [*command, "--runtime", runtime, "-o", str(output)], capture_output=True, check=False
        )
        assert done.returncode == 0, done.stderr
        assert _depends(output) is depends
        assert (output / "deros_runtime").is_dir() is depends
        assert (f"wrote {output}/deros_runtime".encode() in done.stdout) is depends


def test_unknown_runtime_is_a_usage_error(rules: Path, tmp_path: Path) -> None:
    """The message names both valid values; nothing is written."""
    command = ("generate", rules, "--target", "python", "--runtime", "link")
    outcome = deros(*command, "-o", tmp_path / "out")
    assert outcome.code == 2
    assert "runtime 'link' is neither 'copy' nor 'package'" in outcome.err
    assert not (tmp_path / "out").exists()
