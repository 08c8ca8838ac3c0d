"""The stages of a test run, what is run once more, and what is kept of it."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from pathlib import Path

import pytest

from tests.support.record import Result, read, write
from tools import reruns
from tools.reruns import Rerun
from tools.slow_tests import LEAST

ROOT = Path(__file__).resolve().parents[2]

PLAIN = "def test_plain(): pass\n"
NEEDS = """
from tests.support.needs import needs
@needs("no-such-program")
def test_needs(): pass
"""
PASSES_ALONE = """
import pathlib, pytest

@pytest.mark.ros
@pytest.mark.parametrize("number", range({count}))
def test_flaky(number):
    first = pathlib.Path(f"first_{{number}}")
    assert first.exists() or first.touch(), "the first time it fails"
"""
NEVER = "import pytest\n@pytest.mark.ros\ndef test_never(): assert False, 'broken'\n"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Return a folder for tests that are run in stages."""
    (tmp_path / "conftest.py").write_text(
        'pytest_plugins = [f"tests.support.{name}" for name in ("needs", "record", "stages")]\n'
        "def pytest_configure(config):\n"
        "    for mark in ('ros', 'slow', 'essential'): config.addinivalue_line('markers', mark)\n"
    )
    return tmp_path


def run(folder: Path, *arguments: str) -> tuple[int, str]:
    """Run all tests of a folder; return the exit code and what was printed."""
    files = [f"--record={folder / 'record.json'}", f"--reruns={folder / 'reruns.jsonl'}"]
    done = subprocess.run(
        [sys.executable, "-m", "tools.run_tests", *files, "-n", "0", *arguments],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": str(ROOT), "PYTEST_ADDOPTS": "-p no:cacheprovider"},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        check=False,
    )
    return done.returncode, done.stdout


def test_stages_are_counted_and_what_passes_alone_is_kept(folder: Path) -> None:
    """The run passes; a line says how long a rerun took, and at which load it had failed."""
    (folder / "test_a.py").write_text(
        f"{PASSES_ALONE.format(count=2)}{PLAIN}{NEEDS}@pytest.mark.ros\ndef test_ros(): pass\n"
    )
    code, output = run(folder)
    assert code == 0, output
    assert "rerun: test_a.py::test_flaky[0]: failed after" in output
    assert "(AssertionError: the first time it fails" in output
    kept = reruns.of_the_week(folder / "reruns.jsonl")
    assert [each.test for each in kept] == [f"test_a.py::test_flaky[{n}]" for n in range(2)]
    assert "--- 4 passed, 0 failed, 1 skipped in" in output
    assert {test: result.outcome for test, result in read(folder / "record.json").items()} == {
        "test_a.py::test_plain": "passed",
        "test_a.py::test_needs": "skipped",
        "test_a.py::test_ros": "passed",
        "test_a.py::test_flaky[0]": "passed",
        "test_a.py::test_flaky[1]": "passed",
    }


def test_too_many_reruns_fail(folder: Path) -> None:
    """More than three are not bad luck."""
    (folder / "test_a.py").write_text(PASSES_ALONE.format(count=4))
    code, output = run(folder, "--only", "ros")
    assert code == 1
    assert "4 tests on ROS failed; at most 3 are run once more" in output
    assert not (folder / "reruns.jsonl").exists()


def test_what_fails_alone_or_without_ros_fails_the_run(folder: Path) -> None:
    """What is broken is not kept as bad luck, and only tests on ROS are run once more."""
    wrong = "def test_wrong(): pathlib.Path('wrong').open('a').write('x'); assert False\n"
    (folder / "test_a.py").write_text(NEVER + PASSES_ALONE.format(count=1) + wrong)
    code, output = run(folder)
    assert code == 1
    assert "2 failed" in output.splitlines()[-1]
    kept = reruns.of_the_week(folder / "reruns.jsonl")
    assert [each.test for each in kept] == ["test_a.py::test_flaky[0]"]
    assert (folder / "wrong").read_text() == "x"


def test_error_in_collection_fails(folder: Path) -> None:
    """No test has failed, and yet not all have run."""
    (folder / "test_a.py").write_text("import no_such_module  # has mark.ros\n")
    assert run(folder, "--only", "ros")[0] == 1


SLOW = """
import pytest
@pytest.mark.slow
@pytest.mark.parametrize("n", range(60))
def test_slow(n): pass
"""


def selected(folder: Path, *arguments: str) -> list[str]:
    """Return the tests of a folder that pytest collects, and its errors."""
    command = [sys.executable, "-m", "pytest", "--collect-only", "-q", *arguments]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True)
    return [line for line in done.stdout.splitlines() if "::" in line]


def test_share_of_slow_tests_follows_from_the_draw(folder: Path) -> None:
    """A share of them is run; another draw runs others; without a share none is run."""
    (folder / "test_a.py").write_text(SLOW + PLAIN)
    drawn = [selected(folder, "--slow-share", "0.3", "--draw", draw) for draw in "ab"]
    assert drawn[0] != drawn[1]
    assert all(8 < len(each) < 30 for each in drawn)
    assert selected(folder, "--slow-share", "0") == ["test_a.py::test_plain"]


def test_longest_tests_are_drawn_less_often(folder: Path) -> None:
    """So that a run of a share of them takes its share of the time; all are run if all are."""
    (folder / "test_a.py").write_text(SLOW.replace("mark.slow", "mark.slow(seconds=40)"))
    assert 2 < len(selected(folder, "--slow-share", "0.5", "--draw", "a")) < 16
    assert len(selected(folder)) == 60


def test_listed_tests_are_slow_unless_they_are_essential(folder: Path) -> None:
    """All cases of a function are; what is not listed is not."""
    (folder / "pytest.ini").write_text("[pytest]\n")
    (folder / "tests").mkdir()
    (folder / "tests/slow.txt").write_text("test_a.py::test_long\ntest_a.py::test_held\n")
    (folder / "test_a.py").write_text(
        f"{PLAIN}import pytest\n"
        "@pytest.mark.parametrize('n', range(2))\ndef test_long(n): pass\n"
        "@pytest.mark.essential\ndef test_held(): pass\n"
    )
    quick = ["test_a.py::test_plain", "test_a.py::test_held"]
    assert selected(folder, "--slow-share", "0") == quick
    assert len(selected(folder)) == 4
    assert len(selected(folder, "-m", "slow")) == 2


def test_modules_without_tests_on_ros_are_not_read_for_these(folder: Path) -> None:
    """A test whose module does not spell the mark would be run by no stage, and is an error."""
    (folder / "test_a.py").write_text(NEVER)
    (folder / "test_b.py").write_text("from test_a import test_never\n")
    assert selected(folder, "-m", "ros") == ["test_a.py::test_never"]
    message = "test_b.py::test_never is on ROS: write mark.ros in test_b.py"
    assert message in selected(folder, "-m", "not ros")


def test_tests_that_need_programs_come_last(folder: Path) -> None:
    """The order of modules comes second."""
    (folder / "test_a.py").write_text(NEEDS)
    (folder / "test_b.py").write_text(PLAIN)
    assert selected(folder) == ["test_b.py::test_plain", "test_a.py::test_needs"]


def test_missed_tests_are_run_afterwards(folder: Path) -> None:
    """After a run that lacked a program, only what was skipped for it runs."""
    names = ("missed", "skipped", "plain")
    (folder / "test_a.py").write_text("".join(f"def test_{name}(): pass\n" for name in names))
    missed = Result("skipped", 0.0, "Skipped: no gcc")
    skipped = Result("skipped", 0.0, "Skipped: never")
    results = (missed, skipped, Result())
    recorded = zip((f"test_a.py::test_{name}" for name in names), results, strict=True)
    write(folder / "before.json", dict(recorded))
    assert selected(folder, "--after", "before.json") == ["test_a.py::test_missed"]


def test_second_rerun_of_a_week_is_a_defect(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """An older one does not count."""
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    day = 24 * 3600.0
    old, new = time.time() - 8 * day, time.time() - 6 * day
    once = [Rerun("test_old", "", 1.0, 1.0, 0.5, when) for when in (old, new)]
    reruns.keep(once, reruns.default_path())
    assert reruns.main() == 0
    reruns.keep([Rerun("test_old", "", 1.0, 1.0, 0.5)], reruns.default_path())
    assert reruns.main() == 1
    assert "test_old needed it more than once" in capsys.readouterr().out
    lines = reruns.default_path().read_text(encoding="utf-8").splitlines()
    assert [json.loads(line)["test"] for line in lines] == 3 * ["test_old"]


def test_slow_tests_that_are_not_listed_are_named(folder: Path) -> None:
    """Otherwise those that are new are run with each change, and nobody notices."""
    slow = f"import time\ndef test_slow(): time.sleep({LEAST})\n"
    (folder / "test_a.py").write_text(f"{PLAIN}{slow}")
    code, output = run(folder)
    assert code == 0, output
    assert "--- slow and not listed: test_a.py::test_slow (" in output
