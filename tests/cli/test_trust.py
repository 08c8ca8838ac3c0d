"""Trust: a third-party model can only determine files below the output folder."""

from __future__ import annotations

import ast
import shutil
from pathlib import Path

import pytest

from tests.support.cli import deros
from tests.support.examples import EXAMPLES

ROBOT = EXAMPLES / "intelligent_one"

HOSTILE_NAMES = {
    "python": 'a"""\nimport evil\n"""',
    "quotes": "a'''\nimport evil\n'''\"",
    "c": "a\n#error evil\n",
    "line": "evil name\\",
    "cmake": 'a"\n${evil}\n"',
}
"""File names that end a docstring, string or line and continue with code, or join lines."""


def _without_safety(models: Path) -> Path:
    """Return the system of a copy of the example that names no rules, and computes nothing."""
    system = shutil.copytree(ROBOT, models) / "intelligent_one.system"
    text = system.read_text(encoding="utf-8").replace(" when simulated", "")
    system.write_text(text[: text.index("subsystem Safety")], encoding="utf-8")
    return system


@pytest.mark.parametrize("name", HOSTILE_NAMES.values(), ids=HOSTILE_NAMES.keys())
@pytest.mark.parametrize("target", ["python", "cpp", "c"])
def test_file_name_of_rules_cannot_inject_code(name: str, target: str, tmp_path: Path) -> None:
    """No line of the output starts with the code in the file name of the rules."""
    models = tmp_path / "models"
    _without_safety(models)
    rules = models / f"{name}.deros"
    (models / "intelligent_one.deros").rename(rules)
    outcome = deros("generate", rules, "--target", target, "-o", tmp_path / "out")
    assert outcome.code == 0, outcome.err
    _assert_harmless(tmp_path / "out", name)


@pytest.mark.parametrize("name", HOSTILE_NAMES.values(), ids=HOSTILE_NAMES.keys())
@pytest.mark.parametrize("target", ["python", "cpp"])
def test_file_name_of_node_cannot_inject_code(name: str, target: str, tmp_path: Path) -> None:
    """The same holds for node descriptions, and for scaffolding scripts."""
    models = tmp_path / "models"
    models.mkdir()
    node = models / f"{name}.rnd"
    shutil.copy(ROBOT / "marking_robot.rnd", node)
    outcome = deros("generate", node, "--target", target, "-o", tmp_path / "out")
    assert outcome.code == 0, outcome.err
    _assert_harmless(tmp_path / "out", name)
    outcome = deros("generate", node, "--target", target, "--scaffold", models)
    assert outcome.code == 0, outcome.err
    for script in (models / "CMakeLists.txt", models / "setup.py"):
        if script.exists():
            assert not _injected_lines(script), script


@pytest.mark.parametrize("name", HOSTILE_NAMES.values(), ids=HOSTILE_NAMES.keys())
@pytest.mark.parametrize("target", ["launch", "script", "params"])
def test_file_name_of_system_cannot_inject_code(name: str, target: str, tmp_path: Path) -> None:
    """The same holds for systems."""
    models = tmp_path / "models"
    system = _without_safety(models).rename(models / f"{name}.system")
    (models / "intelligent_one.deros").unlink()
    outcome = deros("generate", system, "--target", target, "-o", tmp_path / "out")
    assert outcome.code == 0, outcome.err
    _assert_harmless(tmp_path / "out", name)


def test_check_and_generate_write_only_below_the_output(tmp_path: Path) -> None:
    """Models do not change, and no files appear next to them."""
    models = tmp_path / "models"
    shutil.copytree(ROBOT, models)
    before = _contents(models)
    assert deros("check", models / "intelligent_one.deros").code == 0
    for target in ("python", "cpp", "c"):
        out = tmp_path / "out" / target
        assert deros("generate", models / "intelligent_one.deros", "--target", target, "-o", out)
    assert _contents(models) == before
    assert {path.name for path in tmp_path.iterdir()} == {"models", "out"}


_EVIL = ("import evil", "${evil", "#error evil", "error evil")


def _contents(folder: Path) -> dict[Path, bytes]:
    return {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def _assert_harmless(folder: Path, name: str) -> None:
    written = [path for path in folder.rglob("*") if path.is_file()]
    assert written
    for path in written:
        text = path.read_text(encoding="utf-8")
        assert f"{name}\n" not in text, path
        assert not _injected_lines(path), path
        if path.suffix == ".py":
            ast.parse(text)


def _injected_lines(path: Path) -> list[str]:
    lines = path.read_text(encoding="utf-8").splitlines()
    return [line for line in lines if line.strip(" #/*\"'").startswith(_EVIL)]
