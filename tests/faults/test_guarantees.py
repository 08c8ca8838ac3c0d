"""The page that tells safety engineers how each guarantee is tested."""

from __future__ import annotations

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs/guarantees.md").read_text(encoding="utf-8")
_TEST = re.compile(r"^def (test_\w+)", re.MULTILINE)


def named_in(path: Path) -> set[str]:
    """Return the names of the tests in a file, or in the files of a folder."""
    files = [path] if path.is_file() else sorted(path.glob("*.py"))
    return {name for file in files for name in _TEST.findall(file.read_text(encoding="utf-8"))}


def test_every_test_that_is_named_is_there() -> None:
    """No guarantee rests on a test that has been renamed or removed."""
    paths = {ROOT / path for path in re.findall(r"`(tests/[\w/.]+)`", PAGE)}
    assert paths
    assert all(path.exists() for path in paths)
    named = set(re.findall(r"`(test_\w+)`", PAGE))
    assert named <= set().union(*map(named_in, paths))


def test_every_fault_is_named() -> None:
    """A test of a fault that holds no guarantee would be one whose meaning nobody knows."""
    faults = named_in(ROOT / "tests/faults") - named_in(Path(__file__))
    assert sorted(name for name in faults if f"`{name}`" not in PAGE) == []
