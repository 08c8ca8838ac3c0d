"""The pool detects every failure of a mutant, and continues with the next one."""

from __future__ import annotations

import time
from collections import Counter

import pytest

from tests.support.profiles import slow
from tests.tools.fuzzing.victims import Victim
from tools.fuzzing import pool
from tools.fuzzing.findings import Finding
from tools.fuzzing.limits import Limits
from tools.fuzzing.mutants import Mutant
from tools.fuzzing.pool import Job, Report, minimised, run


def job(*entries: str, seconds: float = 5.0) -> Job:
    """Return a job of mutants that behave as their names say."""
    mutants = tuple(Mutant("model", "p", {"text": b"a\nbad b\nc\n"}, entry) for entry in entries)
    return Job(limits=Limits(seconds=seconds), given=mutants, runner=Victim)


def reports(given: Job, workers: int = 1) -> list[Report]:
    """Run all mutants of a job."""
    return list(run(given, range(len(given.given)), workers, None))


def test_passing_mutants_are_counted() -> None:
    """There are no findings, and every mutant was run."""
    done = reports(job(*["well"] * 130), workers=2)
    assert sum(each.done for each in done) == 130
    assert sum((each.ends for each in done), Counter()) == {"well": 130}
    assert not any(each.findings for each in done)


@pytest.mark.parametrize(
    ("entry", "seconds", "signature"),
    [
        ("raise", 5.0, "ValueError in"),
        ("loop", 0.3, "TooSlow in"),
        slow("regex", 0.5, "Lost: took more than"),
        ("exit", 5.0, "Lost: the process died (model)"),
        slow("peak", 5.0, "TooMuch in"),
    ],
)
def test_failure_costs_one_mutant(entry: str, seconds: float, signature: str) -> None:
    """It is found with its number and mutant, and all others are run."""
    given = job("well", entry, "well", seconds=seconds)
    done = reports(given)
    (finding,) = [found for each in done for found in each.findings]
    assert finding.signature.startswith(signature)
    assert finding.number == 1
    assert finding.mutant == given.given[1]
    assert sum(each.done for each in done) >= 2
    assert "well" in sum((each.ends for each in done), Counter())


def test_blocked_mutant_is_detected(monkeypatch: pytest.MonkeyPatch) -> None:
    """It uses no processor time, so the watchdog checks the clock too."""
    monkeypatch.setattr(pool, "_BLOCKED_S", 5.0)
    done = reports(job("well", "wait"))
    (finding,) = [found for each in done for found in each.findings]
    assert finding.signature.startswith("Lost: waited")


def test_memory_kept_by_mutants_is_detected() -> None:
    """Each takes little, but the sum grows."""
    done = reports(job(*["well"] * 1600, *["keep"] * 420))
    (finding,) = [found for each in done for found in each.findings]
    assert finding.signature == "TooMuch kept by many"


def test_no_mutant_starts_after_the_time_limit() -> None:
    """A run may have a time limit instead of a number."""
    given = job("well")
    assert sum(each.done for each in run(given, range(1), 1, time.monotonic() - 1)) == 0


def test_finding_is_minimised() -> None:
    """Content that the failure does not need is removed."""
    mutant = job("raise if bad").given[0]
    (finding,) = [found for report in reports(job("raise if bad")) for found in report.findings]
    smallest = minimised(job(), Finding(finding.signature, "", 0, mutant), 20.0)
    assert smallest is not None
    assert smallest.files == {"text": b"bad"}
