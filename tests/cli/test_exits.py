"""Exit codes of all commands: wrong arguments, missing files, closed pipes."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from deros.cli.main import COMMANDS
from tests.support.builds import PROGRAM
from tests.support.cli import deros
from tests.support.needs import needs

# Arguments of each command for a file; other commands are called without one.
ON_A_FILE: dict[str, list[str]] = {
    "check": ["check", "{}.system"],
    "generate": ["generate", "{}.system", "--target", "launch"],
    "graph": ["graph", "{}.system"],
    "simulate": ["simulate", "{}.deros", "--trace", "trace.jsonl"],
    "test": ["test", "{}.md"],
    "up": ["up", "{}.system"],
}
WRONG_VALUES = [
    ["check", "--format", "xml", "x.rnd"],
    ["generate", "x.rnd"],
    ["graph", "x.system", "--format", "nope"],
    ["up", "x.system", "--package-path", "/no/such/folder"],
    ["cmake-dir", "surplus"],
    ["test", "x.md", "--format", "xml"],
    ["new", "nothing", "x"],
]


@pytest.mark.parametrize("name", COMMANDS)
@pytest.mark.parametrize("before", [True, False])
def test_unknown_option_exits_with_2(name: str, before: bool, tmp_path: Path) -> None:
    """An unknown option is a usage error at any position."""
    (tmp_path / "empty.system").write_text("system Empty\n")
    rest = [each.format(tmp_path / "empty") for each in ON_A_FILE.get(name, [name])[1:]]
    arguments = [name, "--nope", *rest] if before else [name, *rest, "--nope"]
    outcome = deros(*arguments)
    assert outcome.code == 2, outcome
    assert "rror: " in outcome.err
    assert "Traceback" not in outcome.err
    assert outcome.out == ""


@pytest.mark.parametrize("arguments", WRONG_VALUES, ids=" ".join)
def test_invalid_value_exits_with_2(arguments: list[str]) -> None:
    """A missing or invalid argument is a usage error."""
    outcome = deros(*arguments)
    assert outcome.code == 2, outcome
    assert "Traceback" not in outcome.err


@pytest.mark.parametrize("name", ON_A_FILE)
def test_missing_file_exits_with_2(name: str, tmp_path: Path) -> None:
    """The message names the file, and the code is that of unreadable input."""
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
def test_up_rejects_arguments_that_its_script_rejects(arguments: list[str], tmp_path: Path) -> None:
    """Arguments that 'up' forwards to the parser of its script are checked as usage errors."""
    (tmp_path / "empty.system").write_text("system Empty\n")
    outcome = deros("up", tmp_path / "empty.system", *arguments)
    assert outcome.code == 2, outcome
    assert "Traceback" not in outcome.err


@needs("bash")
@pytest.mark.parametrize("name", COMMANDS)
def test_help_into_a_closed_pipe_is_silent(name: str) -> None:
    """If the reader is gone before the first line, the code is 141 without a message."""
    command = f"{{ {PROGRAM} {name} --help; echo $? >&2; }} | true"
    done = subprocess.run(
        ["bash", "-c", command], capture_output=True, text=True, timeout=120, check=False
    )
    assert done.stderr.strip() in ("141", "0"), done.stderr


def test_up_with_help_of_its_script_exits_with_0(tmp_path: Path) -> None:
    """Help printed by the script's parser is not a failure."""
    (tmp_path / "empty.system").write_text("system Empty\n")
    assert deros("up", tmp_path / "empty.system", "--", "--help").code == 0
