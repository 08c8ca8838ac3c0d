"""How every command ends: exit codes for wrong arguments, missing files, closed pipes."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from deros.cli.main import COMMANDS
from tests.support.builds import PROGRAM
from tests.support.cli import deros

# How each command is called on a file; those that take none are called without.
ON_A_FILE: dict[str, list[str]] = {
    "check": ["check", "{}.system"],
    "generate": ["generate", "{}.system", "--target", "launch"],
    "graph": ["graph", "{}.system"],
    "simulate": ["simulate", "{}.deros", "--trace", "trace.jsonl"],
    "up": ["up", "{}.system"],
}
WRONG_VALUES = [
    ["check", "--format", "xml", "x.rnd"],
    ["generate", "x.rnd"],
    ["graph", "x.system", "--format", "nope"],
    ["up", "x.system", "--package-path", "/no/such/folder"],
    ["cmake-dir", "surplus"],
    ["new", "nothing", "x"],
]


@pytest.mark.parametrize("name", COMMANDS)
@pytest.mark.parametrize("before", [True, False])
def test_a_wrong_option_exits_with_2(name: str, before: bool, tmp_path: Path) -> None:
    """An option that a command does not have is a usage error, wherever it stands."""
    (tmp_path / "empty.system").write_text("system Empty\n")
    rest = [each.format(tmp_path / "empty") for each in ON_A_FILE.get(name, [name])[1:]]
    arguments = [name, "--nope", *rest] if before else [name, *rest, "--nope"]
    outcome = deros(*arguments)
    assert outcome.code == 2, outcome
    assert "rror: " in outcome.err
    assert "Traceback" not in outcome.err
    assert outcome.out == ""


@pytest.mark.parametrize("arguments", WRONG_VALUES, ids=" ".join)
def test_a_wrong_value_exits_with_2(arguments: list[str]) -> None:
    """An argument that is missing, or is not one of those there are, is a usage error."""
    outcome = deros(*arguments)
    assert outcome.code == 2, outcome
    assert "Traceback" not in outcome.err


@pytest.mark.parametrize("name", ON_A_FILE)
def test_a_missing_file_exits_with_2(name: str, tmp_path: Path) -> None:
    """A file that does not exist is named, and the code is that of unreadable input."""
    arguments = [each.format(tmp_path / "missing") for each in ON_A_FILE[name]]
    outcome = deros(*arguments)
    assert outcome.code == 2, outcome
    assert "missing" in outcome.err + outcome.out
    assert "Traceback" not in outcome.err


@pytest.mark.parametrize(
    "arguments",
    [["--stop-timeout", "soon"], ["--stop-timeout", "-1"], ["--only", "nobody"], ["--", "--nope"]],
    ids=" ".join,
)
def test_up_refuses_what_its_script_refuses(arguments: list[str], tmp_path: Path) -> None:
    """What 'up' hands on to the parser of its script is a usage error there, too."""
    (tmp_path / "empty.system").write_text("system Empty\n")
    outcome = deros("up", tmp_path / "empty.system", *arguments)
    assert outcome.code == 2, outcome
    assert "Traceback" not in outcome.err


@pytest.mark.parametrize("name", COMMANDS)
def test_help_into_a_closed_pipe_is_quiet(name: str) -> None:
    """A reader that is gone before the first line ends a command with 141, without a word."""
    command = f"{{ {PROGRAM} {name} --help; echo $? >&2; }} | true"
    done = subprocess.run(
        ["bash", "-c", command], capture_output=True, text=True, timeout=120, check=False
    )
    assert done.stderr.strip() in ("141", "0"), done.stderr


def test_up_with_help_of_its_script_exits_with_0(tmp_path: Path) -> None:
    """Help that a parser of ours prints is no failure."""
    (tmp_path / "empty.system").write_text("system Empty\n")
    assert deros("up", tmp_path / "empty.system", "--", "--help").code == 0
