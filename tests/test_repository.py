"""What is kept under version control: text, and the pictures of the documentation."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from tests.support.needs import needs

REPOSITORY = Path(__file__).resolve().parents[1]


@needs("git")
def test_all_is_text_but_the_pictures_of_the_documentation() -> None:
    """A program, an archive or a package that was left lying about is not taken in by mistake."""
    if not (REPOSITORY / ".git").exists():
        pytest.skip("no checkout: the sources of a release")
    listed = subprocess.run(
        ["git", "ls-files", "-z"], cwd=REPOSITORY, stdout=subprocess.PIPE, text=True, check=True
    )
    files = [REPOSITORY / each for each in listed.stdout.split("\0") if each]
    binary = [each for each in files if each.is_file() and b"\0" in each.read_bytes()]
    assert binary, "the pictures are not seen"
    assert [each for each in binary if each.parent.parts[-2:] != ("docs", "images")] == []
