"""Golden files: generated text under ``tests/golden``, refreshed by ``pytest --refresh-golden``."""

from __future__ import annotations

import os
import shutil
from dataclasses import dataclass
from pathlib import Path

import pytest

from deros.generators.api.protocol import Files, Owner
from deros.generators.output.banner import with_banner
from deros.generators.output.writer import write

GOLDEN = Path(__file__).resolve().parent.parent / "golden"


@dataclass(frozen=True, slots=True)
class Golden:
    """Compares generated files with those kept, or keeps the generated ones."""

    refresh: bool

    def check(self, name: str, files: Files) -> None:
        """Hold ``files`` against ``tests/golden/<name>``, as the writer would put them there."""
        folder = GOLDEN / name
        if self.refresh:
            shutil.rmtree(folder, ignore_errors=True)
            write(files, folder)
        kept = {
            path.relative_to(folder).as_posix(): path.read_text(encoding="utf-8")
            for path in folder.rglob("*")
            if path.is_file()
        }
        assert sorted(kept) == sorted(files)
        for path, file in files.items():
            assert os.access(folder / path, os.X_OK) >= file.executable, path
            generated = file.owner is Owner.GENERATOR
            text = with_banner(path, file.text) if generated else file.text
            assert text == kept[path], f"{path}: refresh with pytest --refresh-golden"


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the option that accepts the generated text of this run."""
    parser.addoption(
        "--refresh-golden",
        action="store_true",
        help="replace the golden files by what is generated now",
    )


@pytest.fixture
def golden(request: pytest.FixtureRequest) -> Golden:
    """Give the comparison with golden files."""
    return Golden(bool(request.config.getoption("--refresh-golden")))
