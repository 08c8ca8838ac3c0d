"""The textX plug-ins in this environment; ``test_textx.py`` tries them from the wheel alone."""

from __future__ import annotations

import logging
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import CliRunner
from textx.cli import textx

from tests.support.cli import Outcome, deros

LISTED = {
    "list-languages": ("rosnode (*.rnd)", "rossystem (*.system)", "deros (*.deros)"),
    "list-generators": ("rosnode -> python", "rossystem -> launch", "deros -> c"),
}

Run = Callable[..., Outcome]


@pytest.fixture
def run_textx(caplog: pytest.LogCaptureFixture) -> Run:
    """Return a function that runs ``textx`` in this process; it prints by ``logging``."""

    def run(*arguments: object) -> Outcome:
        caplog.clear()
        with caplog.at_level(logging.INFO):
            done = CliRunner().invoke(
                textx, [str(each) for each in arguments], catch_exceptions=False
            )
        return Outcome(done.exit_code, done.output, "\n".join(caplog.messages))

    return run


@pytest.fixture
def rules(tmp_path: Path) -> Path:
    """Create a new model of rules."""
    assert deros("new", "rules", "courier", "-o", tmp_path).code == 0
    return tmp_path / "courier.deros"


@pytest.mark.parametrize("command", LISTED)
def test_textx_lists_languages_and_generators(run_textx: Run, command: str) -> None:
    """Both are found by their entry points."""
    printed = run_textx(command).err
    assert [each for each in LISTED[command] if each not in printed] == []


def test_textx_and_deros_generate_the_same_files(
    run_textx: Run, rules: Path, tmp_path: Path
) -> None:
    """``textx check`` accepts the model; ``textx generate`` and ``deros`` write the same files."""
    assert run_textx("check", rules).err.endswith("courier.deros: OK.")
    trees = []
    for name, run in (("textx", run_textx), ("deros", deros)):
        assert run("generate", rules, "--target", "python", "-o", tmp_path / name).code == 0
        files = (path for path in (tmp_path / name).rglob("*") if path.is_file())
        trees.append({path.relative_to(tmp_path / name): path.read_bytes() for path in files})
    assert trees[0] == trees[1] != {}


def test_textx_check_reports_an_error(run_textx: Run, rules: Path) -> None:
    """The error has its code, and the exit code is 1."""
    rules.write_text(rules.read_text().replace("action", "acton", 1))
    done = run_textx("check", rules)
    assert done.code == 1
    assert "error[DRS003" in done.err
