"""The list of slow tests follows from what was measured, and names what there is."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.support.record import SLOW, Result, read_slow, write
from tools import slow_tests

ROOT = Path(__file__).resolve().parents[2]


def test_function_is_slow_if_its_cases_are_on_the_average() -> None:
    """Cases that failed, were skipped or say themselves that they are slow do not count."""
    results = {
        "tests/a.py::test_long[1]": Result(seconds=1.5),
        "tests/a.py::test_long[2]": Result(seconds=0.6),
        "tests/a.py::test_long[cpp]": Result("skipped"),
        "tests/a.py::test_short[1]": Result(seconds=0.1),
        "tests/a.py::test_short[many]": Result(seconds=30.0, slow=True),
        "tests/a.py::test_hung": Result("failed", 60.0),
        "tests/a.py::Test::test_in_a_class": Result(seconds=2.0),
        "tests/a.py::test_quick_now": Result(seconds=0.2),
    }
    listed = frozenset({"tests/a.py::test_quick_now", "tests/a.py::test_left_out"})
    assert slow_tests.unlisted(results, listed | {"tests/a.py::Test::test_in_a_class"}) == {
        "tests/a.py::test_long": 2.1
    }
    assert slow_tests.slow_functions(results, listed) == [
        "tests/a.py::Test::test_in_a_class",
        "tests/a.py::test_left_out",
        "tests/a.py::test_long",
    ]


def test_list_is_written_after_a_run(tmp_path: Path) -> None:
    """What is no longer there leaves it; what was not run stays."""
    (tmp_path / "tests").mkdir()
    (tmp_path / "tests/a.py").write_text("def test_old(): ...\ndef test_new(): ...\n")
    gone = "tests/a.py::test_gone\ntests/b.py::test_gone\n"
    (tmp_path / SLOW).write_text(f"tests/a.py::test_old\n{gone}")
    write(tmp_path / "tests.json", {"tests/a.py::test_new": Result(seconds=3.0)})
    arguments = ["--record", str(tmp_path / "tests.json"), "--root", str(tmp_path)]
    assert slow_tests.main(arguments) == 0
    assert (tmp_path / SLOW).read_text() == "tests/a.py::test_new\ntests/a.py::test_old\n"


@pytest.mark.essential
def test_every_listed_test_is_there() -> None:
    """A test that got another name would be run with each change again, unnoticed."""
    listed = read_slow(ROOT)
    assert listed - slow_tests.present(ROOT, listed) == set(), (
        "python -m tools.slow_tests writes the list anew"
    )
