"""The campaign's command: output and exit code."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

import pytest

from tests.support.chaos import campaign
from tests.support.chaos.referee import Verdict, Violation
from tests.support.chaos.rules import Broken
from tests.support.chaos.schedule import Schedule, draw
from tests.support.needs import needs

HELD = Verdict([Broken("stop zone", 1.0, 2.0)], [], slowest=0.2, moved=True)
FAILED = Verdict([], [Violation("gate", 1.5, "it passes 0.40 m/s")], moved=True)


def play(
    monkeypatch: pytest.MonkeyPatch, folder: Path, verdicts: Sequence[Verdict | None]
) -> tuple[int, list[Schedule]]:
    """Run a campaign with the given verdicts; return the code and the rounds."""
    rounds = [draw(3, number) for number in range(len(verdicts))]

    def played(
        batch: Sequence[Schedule], _robot: object, place: Path
    ) -> Iterator[campaign.Outcome]:
        place.mkdir(parents=True)
        for schedule in batch:
            verdict = verdicts[schedule.number]
            yield campaign.Outcome(schedule, verdict, "" if verdict else "waited 8 s")

    monkeypatch.setattr(campaign, "_play", played)
    monkeypatch.setattr(campaign, "generate_packages", lambda *_: None)
    return campaign.run(rounds, folder, 2, 10.0), rounds


@needs("gcc")
def test_passing_rounds_exit_with_0(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A round that could not be played is reported, and is not a violation."""
    code, _ = play(monkeypatch, tmp_path, [*[HELD] * 10, None])
    printed = capsys.readouterr().out
    assert code == 0
    assert "seed 3: 11 rounds" in printed
    assert "not played" in printed
    assert "10 of 11 rounds played" in printed


@needs("gcc")
def test_violation_exits_with_1_and_is_kept(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Seed, round, reason and folder are printed; the folder has the schedule for a replay."""
    code, rounds = play(monkeypatch, tmp_path, [HELD, HELD, FAILED])
    printed = capsys.readouterr().out
    assert code == 1
    assert "at 1.50 s, gate: it passes 0.40 m/s" in printed
    assert "--seed 3 --round 2" in printed
    kept = tmp_path / "3.1" / "3-2.json"
    assert str(kept) in printed
    assert Schedule.load(kept) == rounds[2]


@needs("gcc")
@pytest.mark.parametrize("verdict", [None, Verdict([], [], moved=False)])
def test_campaign_without_evidence_fails(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, verdict: Verdict | None
) -> None:
    """Rounds that were not played, or in which the robot did not drive, are not evidence."""
    assert play(monkeypatch, tmp_path, [HELD, verdict])[0] == 1
