"""Keywords of the target languages, listed once."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

from deros.interfaces.keywords import CPP, CPP_20, C

SOURCE = Path(__file__).resolve().parents[2] / "src" / "deros"


@pytest.mark.parametrize(
    ("compiler", "standard", "words"),
    [("cc", "c99", C), ("c++", "c++17", CPP), ("c++", "c++20", CPP_20)],
    ids=["C", "C++17", "C++20"],
)
def test_compiler_rejects_keywords_as_names(
    compiler: str, standard: str, words: frozenset[str], tmp_path: Path
) -> None:
    """Every keyword is a syntax error as a variable name; another word is not."""
    if shutil.which(compiler) is None:
        pytest.skip(f"no {compiler}")
    file = tmp_path / "names.txt"
    language = "c" if standard.startswith("c9") else "c++"
    for word in sorted(words):
        file.write_text(f"int f(void);\nint f(void) {{ int {word} = 1; return {word}; }}\n")
        command = [compiler, f"-std={standard}", "-fsyntax-only", "-x", language, str(file)]
        done = subprocess.run(command, capture_output=True, check=False)
        assert done.returncode != 0, word
    file.write_text("int f(void);\nint f(void) { int names = 1; return names; }\n")
    subprocess.run(command, capture_output=True, check=True)


def test_keywords_are_listed_in_one_module() -> None:
    """A second list would diverge."""
    listing = [path for path in SOURCE.rglob("*.py") if "reinterpret_cast" in path.read_text()]
    assert [path.name for path in listing] == ["keywords.py"]
