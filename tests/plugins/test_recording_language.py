"""A fourth language is one declaration: loader, checks, commands and textX follow from it."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from deros import codes
from deros.cli import textx_plugin
from deros.metamodels import languages
from deros.metamodels.load import Repository
from deros.pipeline.workspace import check_one
from tests.plugins.recording_language.language import RECORDING, Recording

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture
def declared(monkeypatch: pytest.MonkeyPatch) -> None:
    """Declare the fourth language for one test."""
    monkeypatch.setattr(languages, "LANGUAGES", (*languages.LANGUAGES, RECORDING))


def _deros(*arguments: object) -> subprocess.CompletedProcess[str]:
    """Run ``deros`` with the fourth language in a separate process."""
    command = [sys.executable, "-m", "tests.plugins.recording_language", *map(str, arguments)]
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)


@pytest.mark.usefixtures("declared")
def test_repository_loads_the_language() -> None:
    """The loader parses a text with the grammar and calls the converter."""
    model = Repository().load_text("a.recording", "recording a topics /odom /scan").model
    assert isinstance(model, Recording)
    assert [topic for topic, _ in model.topics] == ["/odom", "/scan"]


@pytest.mark.usefixtures("declared")
def test_syntax_errors_have_a_position() -> None:
    """Syntax errors of the language are explained like those of any other."""
    (finding,) = Repository().load_text("a.recording", "recording a topic /odom").diagnostics
    assert finding.code is codes.SYNTAX_ERROR
    assert finding.span.text == "topic"


@pytest.mark.usefixtures("declared")
def test_common_mistakes_are_explained() -> None:
    """Explanations that belong to no language apply to a new one as well."""
    text = "# all of it\nrecording a topics /odom"
    (finding,) = Repository().load_text("a.recording", text).diagnostics
    assert finding.message == "'#' does not begin a comment here"


@pytest.mark.usefixtures("declared")
def test_pipeline_runs_the_checks_of_the_language(tmp_path: Path) -> None:
    """A check of the language reports at the position in the file."""
    file = tmp_path / "a.recording"
    file.write_text("recording a topics /odom /odom")
    _, (finding,) = check_one(str(file), ())
    assert (finding.code, finding.span.start) == (codes.DUPLICATE_TOPIC, 25)


@pytest.mark.usefixtures("declared")
def test_textx_knows_the_language() -> None:
    """The object for the entry point describes the language to textX, including the metamodel."""
    description = textx_plugin.recording
    assert (description.name, description.pattern) == ("recording", "*.recording")
    assert description.metamodel().model_from_str("recording a topics /odom").name == "a"


def test_commands_know_the_language(tmp_path: Path) -> None:
    """``deros new`` starts a model that ``deros check`` finds in its folder and accepts."""
    created = _deros("new", "recording", "lap", "-o", tmp_path)
    assert created.returncode == 0, created.stderr
    assert (tmp_path / "lap.recording").read_text() == "recording lap topics /odom\n"
    checked = _deros("check", tmp_path)
    assert (checked.returncode, checked.stdout) == (0, "1 file checked, no findings\n")
    assert "recordings (*.recording)" in " ".join(_deros("check", "--help").stdout.split())
    assert "recordings (*.recording)" in " ".join(_deros("--help").stdout.split())


def test_finding_of_the_language_fails_the_command(tmp_path: Path) -> None:
    """``deros check`` exits with 1 and gives the position."""
    file = tmp_path / "a.recording"
    file.write_text("recording a topics /odom /odom\n")
    checked = _deros("check", file)
    assert checked.returncode == 1
    assert f"{file}:1:26: error[DRS218 duplicate-topic]" in checked.stdout, checked.stdout


def test_undeclared_language_is_rejected(tmp_path: Path) -> None:
    """Without the declaration, the same file is not a model."""
    file = tmp_path / "a.recording"
    file.write_text("recording a topics /odom\n")
    (finding,) = Repository().load(file).diagnostics
    assert finding.code is codes.UNKNOWN_LANGUAGE
    with pytest.raises(AttributeError, match="recording"):
        _ = textx_plugin.recording
