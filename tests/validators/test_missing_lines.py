"""A model that lacks a line, or uses one that does, is checked like any other."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.support import cases

_PARTS = 8
_LONGEST = 8_000
"""Bytes of a file: longer ones are about length, and take long to check."""


def _names(folder: Path) -> list[str]:
    paths = sorted(each for each in folder.iterdir() if each.is_file())
    models = (each for each in paths if each.suffix in (".rnd", ".system", ".deros"))
    return [each.name for each in models if each.stat().st_size <= _LONGEST]


_CASES = _names(cases.DIRECTORY)
_USED = _names(cases.DIRECTORY / "support")


@pytest.fixture
def copy(tmp_path: Path) -> Path:
    """Return a copy of all cases."""
    return Path(shutil.copytree(cases.DIRECTORY, tmp_path / "cases"))


def _without_each_line(path: Path) -> Iterator[int]:
    """Take each line out of a file, one after the other; yield its number while it is out."""
    before = path.read_bytes()
    lines = before.splitlines(keepends=True)
    for number, line in enumerate(lines, start=1):
        if line.strip():
            path.write_bytes(b"".join([*lines[: number - 1], *lines[number:]]))
            yield number
    path.write_bytes(before)


def _check(name: str, copy: Path, what: str) -> None:
    try:
        cases.run(name, copy)
    except Exception as error:
        raise AssertionError(f"{name} without {what}: {error!r}") from error


@pytest.mark.parametrize("part", range(_PARTS))
def test_case_without_a_line_is_checked(part: int, copy: Path) -> None:
    """What is missing may be named elsewhere in the file: that is a finding, or nothing."""
    for name in _CASES[part::_PARTS]:
        for number in _without_each_line(copy / name):
            _check(name, copy, f"line {number}")


@pytest.mark.parametrize("part", range(_PARTS))
def test_case_whose_import_lacks_a_line_is_checked(part: int, copy: Path) -> None:
    """What is missing may be named in the other files that use the file, or that it uses."""
    texts = {name: (copy / name).read_bytes() for name in _CASES}
    for used in _USED[part::_PARTS]:
        users = [name for name, text in texts.items() if f"/{used}".encode() in text]
        for number in _without_each_line(copy / "support" / used):
            for name in users:
                _check(name, copy, f"line {number} of {used}")
