"""``deros new``: a model to start from, without a finding, and never in place of another."""

from __future__ import annotations

from pathlib import Path

import pytest

from deros.cli.scaffolds import KINDS
from tests.support.cli import deros


@pytest.mark.parametrize("kind", KINDS)
def test_new_models_check_clean(kind: str, tmp_path: Path) -> None:
    """Not even a warning or a remark is found in any of the files."""
    assert deros("new", kind, "courier", "-o", tmp_path / "models").code == 0
    files = sorted((tmp_path / "models").iterdir())
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
def test_new_models_generate(kind: str, name: str, target: str, tmp_path: Path) -> None:
    """Each kind of model can be generated from at once."""
    deros("new", kind, "courier", "-o", tmp_path)
    outcome = deros("generate", tmp_path / name, "--target", target, "-o", tmp_path / "out")
    assert outcome.code == 0, outcome.err
    assert any((tmp_path / "out").rglob("*.py"))


def test_existing_files_are_never_replaced(tmp_path: Path) -> None:
    """If one file of several is there already, none is written."""
    kept = tmp_path / "courier_base.rnd"
    kept.write_text("mine")
    outcome = deros("new", "system", "courier", "-o", tmp_path)
    assert outcome.code == 2
    assert "courier_base.rnd" in outcome.err
    assert [p.name for p in tmp_path.iterdir()] == ["courier_base.rnd"]
    assert kept.read_text() == "mine"


@pytest.mark.parametrize("name", ["2nd", "with space", "a/b", "", "../up", "grün"])
def test_names_that_ros_refuses_are_usage_errors(name: str, tmp_path: Path) -> None:
    """The name becomes that of a node and of a file; what cannot be one is refused at once."""
    outcome = deros("new", "node", name, "-o", tmp_path)
    assert outcome.code == 2
    assert "Usage:" in outcome.err
    assert list(tmp_path.iterdir()) == []


def test_unknown_kinds_are_usage_errors(tmp_path: Path) -> None:
    """Only the three kinds of model can be started."""
    assert deros("new", "robot", "r2d2", "-o", tmp_path).code == 2


def test_a_folder_that_cannot_be_made(tmp_path: Path) -> None:
    """A file in the place of the folder is reported, without a traceback."""
    (tmp_path / "models").write_text("")
    outcome = deros("new", "node", "courier", "-o", tmp_path / "models" / "deeper")
    assert outcome.code == 2
    assert "cannot write" in outcome.err


def test_new_rules_let_nothing_move_again_by_itself(tmp_path: Path) -> None:
    """Not even a remark about the gate: it waits for a person, and for the controller."""
    deros("new", "rules", "courier", "-o", tmp_path)
    rules = (tmp_path / "courier.deros").read_text()
    assert "zero until reset;" in rules
    assert "resume on zero command;" in rules
    assert "DRS357" not in deros("check", tmp_path / "courier.deros").out
