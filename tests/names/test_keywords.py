"""Keywords of the target languages, listed once."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest

from deros.names.keywords import CPP, CPP_20, C
from tests.support.needs import needs

SOURCE = Path(__file__).resolve().parents[2] / "src" / "deros"


@pytest.mark.parametrize(
    ("compiler", "standard", "words"),
    [
        pytest.param("cc", "c99", C, id="C", marks=needs("cc")),
        pytest.param("c++", "c++17", CPP, id="C++17", marks=needs("c++")),
        pytest.param("c++", "c++20", CPP_20, id="C++20", marks=needs("c++")),
    ],
)
def test_compiler_rejects_keywords_as_names(
    compiler: str, standard: str, words: frozenset[str], tmp_path: Path
) -> None:
    """Every keyword is a syntax error as a variable name; another word is not.

    All are compiled at once. The function with another word between any two of them has no errors,
    so none of the others is a consequence of the ones before.
    """
    listed = [name for word in sorted(words) for name in (word, "names")]
    lines = [
        f"int f{number}(void); int f{number}(void) {{ int {name} = 1; return {name}; }}\n"
        for number, name in enumerate(listed)
    ]
    file = tmp_path / "names.txt"
    file.write_text("".join(lines))
    language = "c" if standard.startswith("c9") else "c++"
    command = [compiler, f"-std={standard}", "-fsyntax-only", "-x", language, str(file)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    rejected = {int(line) for line in re.findall(r"names\.txt:(\d+):\d+: error:", done.stderr)}
    assert {listed[line - 1] for line in rejected} == words
    assert len(rejected) == len(words)


def test_keywords_are_listed_in_one_module() -> None:
    """A second list would diverge."""
    listing = [path for path in SOURCE.rglob("*.py") if "reinterpret_cast" in path.read_text()]
    assert [path.name for path in listing] == ["keywords.py"]
