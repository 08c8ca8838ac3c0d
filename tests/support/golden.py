"""Golden files: generated text under ``tests/golden``, refreshed by ``pytest --refresh-golden``.

Copies of the runtime are not among them: a package's ``runtime_files.txt`` lists those that it
carries, and each is compared with the file that it is a copy of. Nor are lines that stand in a
template or in a golden file before it: a golden file names that. The digest in its head is that of
the whole text.
"""

from __future__ import annotations

import os
import shutil
from dataclasses import dataclass
from pathlib import Path

import pytest

from deros.generators.api.protocol import File, Files, Owner
from deros.generators.output.banner import with_banner
from deros.generators.output.writer import write
from tests.support.golden_runtime import assert_copies, is_copy
from tests.support.golden_templates import shortened, unrepeated

GOLDEN = Path(__file__).resolve().parent.parent / "golden"


RUNTIME_FILES = "runtime_files.txt"


@dataclass(frozen=True, slots=True)
class Golden:
    """Compares generated files with those kept, or keeps the generated ones."""

    refresh: bool
    root: Path = GOLDEN

    def check(self, name: str, files: Files) -> None:
        """Hold ``files`` against ``tests/golden/<name>``, as the writer would put them there."""
        folder = self.root / name
        reviewed = with_copies_listed(files)
        shown = unrepeated(
            {path: shortened(_written(path, file)) for path, file in reviewed.items()}
        )
        if self.refresh:
            shutil.rmtree(folder, ignore_errors=True)
            write(reviewed, folder)
            for path, text in shown.items():
                (folder / path).write_text(text, encoding="utf-8")
        kept = {
            path.relative_to(folder).as_posix(): path.read_text(encoding="utf-8")
            for path in folder.rglob("*")
            if path.is_file()
        }
        assert sorted(kept) == sorted(reviewed)
        for path, file in reviewed.items():
            assert os.access(folder / path, os.X_OK) >= file.executable, path
            assert shown[path] == kept[path], f"{path}: refresh with pytest --refresh-golden"


def _written(path: str, file: File) -> str:
    """Return the text of a file as the writer would put it there."""
    return with_banner(path, file.text) if file.owner is Owner.GENERATOR else file.text


def with_copies_listed(files: Files) -> Files:
    """Return the files to read: the list of the runtime's copies in place of the copies."""
    assert_copies(files)
    copies = [path for path in files if is_copy(path)]
    if not copies:
        return files
    assert RUNTIME_FILES not in files
    listed = File("".join(f"{path}\n" for path in sorted(copies)))
    rest = {path: file for path, file in files.items() if path not in copies}
    return {**rest, RUNTIME_FILES: listed}


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
