"""``deros new``: initial models without findings, which never overwrite files."""

from __future__ import annotations

from pathlib import Path

import pytest

from deros.cli.scaffolds import KINDS
from deros.metamodels.languages import language_of
from tests.support.cli import deros


@pytest.mark.parametrize("kind", KINDS)
def test_new_models_have_no_findings(kind: str, tmp_path: Path) -> None:
    """There are not even warnings or notes in any of the files."""
    assert deros("new", kind, "courier", "-o", tmp_path / "models").code == 0
    files = sorted(each for each in (tmp_path / "models").iterdir() if language_of(each))
    outcome = deros("check", "--strict", *files)
    assert (outcome.code, outcome.out) == (
        0,
        f"{len(files)} file{'s' * (len(files) > 1)} checked, no findings\n",
    )


@pytest.mark.parametrize(
    ("kind", "name", "target"),
    [
        ("node", "courier.rnd", "python"),
        ("system", "courier.system", "script"),
        ("rules", "courier.deros", "python"),
    ],
)
def test_new_models_can_be_generated(kind: str, name: str, target: str, tmp_path: Path) -> None:
    """Code can be generated from each kind of model at once."""
    deros("new", kind, "courier", "-o", tmp_path)
    outcome = deros("generate", tmp_path / name, "--target", target, "-o", tmp_path / "out")
    assert outcome.code == 0, outcome.err
    assert any((tmp_path / "out").rglob("*.py"))


def test_existing_files_are_never_overwritten(tmp_path: Path) -> None:
    """If one of several files exists, none is written."""
    kept = tmp_path / "courier_base.rnd"
    kept.write_text("mine")
    outcome = deros("new", "system", "courier", "-o", tmp_path)
    assert outcome.code == 2
    assert "courier_base.rnd" in outcome.err
    assert [p.name for p in tmp_path.iterdir()] == ["courier_base.rnd"]
    assert kept.read_text() == "mine"


@pytest.mark.parametrize("name", ["2nd", "with space", "a/b", "", "../up", "grün"])
def test_invalid_ros_name_is_a_usage_error(name: str, tmp_path: Path) -> None:
    """The name becomes that of a node and of a file."""
    outcome = deros("new", "node", name, "-o", tmp_path)
    assert outcome.code == 2
    assert "Usage:" in outcome.err
    assert list(tmp_path.iterdir()) == []


def test_unknown_kind_is_a_usage_error(tmp_path: Path) -> None:
    """Only the three kinds of model can be created."""
    assert deros("new", "robot", "r2d2", "-o", tmp_path).code == 2


def test_folder_that_cannot_be_created(tmp_path: Path) -> None:
    """A file in place of the folder is reported, without a traceback."""
    (tmp_path / "models").write_text("")
    outcome = deros("new", "node", "courier", "-o", tmp_path / "models" / "deeper")
    assert outcome.code == 2
    assert "cannot write" in outcome.err


def test_new_rules_have_tests_that_reach_all_of_them(tmp_path: Path) -> None:
    """They pass, and there is nothing in the rules that they do not try."""
    deros("new", "rules", "courier", "-o", tmp_path)
    outcome = deros("test", "--strict", tmp_path)
    assert (outcome.code, outcome.err) == (0, ""), outcome.out


def test_new_rules_never_resume_by_themselves(tmp_path: Path) -> None:
    """The gate waits for a reset and for the controller, so there is not even a note."""
    deros("new", "rules", "courier", "-o", tmp_path)
    rules = (tmp_path / "courier.deros").read_text()
    assert "zero until reset;" in rules
    assert "resume on zero command;" in rules
    assert "DRS357" not in deros("check", tmp_path / "courier.deros").out
