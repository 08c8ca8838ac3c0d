"""One run of the demo: the system is started, the cases are played, the recordings handed back."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from demonstration.build import changed_system
from demonstration.cases import Case, play, prepare
from demonstration.recording import Recording, Result
from demonstration.referee import NOTHING
from demonstration.robot import Robot
from demonstration.stage import OverdueError, Stage

Report = Callable[[Result], None]
Begin = Callable[[Case], None]


@dataclass(frozen=True)
class Workshop:
    """Where the parts of a run are: the model, the folders of packages, the folder for logs."""

    system: Path
    packages: tuple[Path, ...]
    logs: Path

    def on_simulated_time(self) -> Path:
        """Write the same system with its safety node on simulated time; return the model's path.

        The PLC goes on in real time, as its hardware does. On a busy machine it may have to wait
        for a step of simulated time, and for the heartbeat in it, so it gets all its patience.

        Raises:
            ValueError: if the model does not state the node's grace and the PLC's patience.
        """
        changes = (
            ("param startup_grace", "param use_sim_time = true\n    param startup_grace"),
            ("param keep_alive_timeout = 0.5", "param keep_alive_timeout = 10.0"),
        )
        return changed_system(self.system, self.logs / "on_simulated_time", changes)


def run(
    workshop: Workshop, cases: Sequence[Case], repeat: int, begin: Begin, report: Report
) -> list[Recording]:
    """Play the cases ``repeat`` times, those on simulated time in a second start of the system.

    Args:
        workshop: the system to start.
        cases: what to play.
        repeat: how often; only the first round is recorded.
        begin: called before each case.
        report: called with the result of each case.
    """
    recordings = []
    for simulated in (False, True):
        chosen = [case for case in cases if case.simulated is simulated]
        if chosen:
            recordings.append(
                _run(workshop, chosen * repeat, len(chosen), simulated, begin, report)
            )
    return recordings


def _run(
    workshop: Workshop,
    cases: Sequence[Case],
    recorded: int,
    simulated: bool,
    begin: Begin,
    report: Report,
) -> Recording:
    recording = Recording(simulated)
    system = workshop.on_simulated_time() if simulated else workshop.system
    log = workshop.logs / ("simulated_time.log" if simulated else "real_time.log")
    with (
        Robot(system, workshop.packages, log) as robot,
        Stage(lambda: robot.process_of("safety"), simulated) as stage,
    ):
        robot.on_end(stage.abandon)
        stage.listen(recording.feed)
        for index, case in enumerate(cases):
            begin(case)
            result = _play(case, stage, recording)
            report(result)
            if index < recorded:
                recording.results.append(result)
            if index == recorded - 1:
                stage.unlisten(recording.feed)
    return recording


def _play(case: Case, stage: Stage, recording: Recording) -> Result:
    observed, time = NOTHING, None
    start = stage.now
    try:
        prepare(stage, case.driving)
        start = stage.now
        referee = play(case, stage)
        observed, time, failure = (
            frozenset(referee.observed),
            referee.reaction_time,
            referee.verdict,
        )
    except OverdueError as error:
        failure = str(error)
    return Result(
        case.number,
        case.title,
        case.expected,
        observed,
        time,
        failure,
        recording.seconds(start),
        recording.seconds(stage.now),
        case.simulated,
    )
