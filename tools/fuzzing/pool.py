"""Worker processes that run mutants, and the watchdog over them.

A worker runs mutants one after another in one process, since starting one takes longer than a
thousand mutants. One that dies, or has to be killed, costs the mutant that it was at: another
process takes over behind it.
"""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import shutil
import signal
import tempfile
import time
import traceback
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from multiprocessing.connection import Connection, wait
from pathlib import Path
from typing import Any

from tools.fuzzing.findings import Finding, signature
from tools.fuzzing.limits import (
    Limits,
    TooMuch,
    TooSlow,
    enforce,
    kept_mb,
    limited,
    usage,
)
from tools.fuzzing.minimising import minimise
from tools.fuzzing.mutants import KINDS, Drawing, Kind, Mutant, Rules
from tools.fuzzing.projects import Project
from tools.fuzzing.running import Runner

_BATCH = 50
_WARM_UP = 1500
_LIFE = 12_000
"""How many mutants one process runs, so that leaks add up, and then make room again."""

_CHECKED_EVERY_S = 0.2
_PATIENCE = 1.6
_BLOCKED_S = 120.0
_LEAVING_S = 5.0

_CONTEXT = multiprocessing.get_context("spawn")


@dataclass(frozen=True)
class Job:
    """What a worker needs to know.

    Attributes:
        projects: what mutants are drawn from.
        rules: what traces and messages are drawn for.
        seed: of the run.
        kinds: of mutants to draw.
        limits: for each mutant.
        given: mutants to run instead of drawn ones.
        runner: makes what runs the mutants, from the folder that it may use.
    """

    projects: tuple[Project, ...] = ()
    rules: Rules = field(default_factory=dict)
    seed: int = 0
    kinds: tuple[Kind, ...] = KINDS
    limits: Limits = field(default_factory=Limits)
    given: tuple[Mutant, ...] = ()
    runner: Callable[[Path], Any] = Runner


@dataclass(frozen=True)
class Report:
    """What a worker has done since its last report.

    Attributes:
        done: how many mutants.
        kinds: how many of each kind.
        ends: how they ended.
        findings: what went wrong.
        slowest: the longest processor time of one, in seconds.
        kept_mb: by which the process has grown since it was warm.
    """

    done: int = 0
    kinds: Counter[str] = field(default_factory=Counter)
    ends: Counter[str] = field(default_factory=Counter)
    findings: tuple[Finding, ...] = ()
    slowest: float = 0.0
    kept_mb: float = 0.0


def run(job: Job, numbers: Sequence[int], workers: int, until: float | None) -> Iterator[Report]:
    """Run the mutants of these numbers; yield what was done, as it comes.

    Args:
        job: what to draw from.
        numbers: which mutants.
        workers: how many processes.
        until: the time of the steady clock at which no further mutants are begun.
    """
    with contextlib.ExitStack() as stack:
        share = -(-len(numbers) // workers) if numbers else 0
        shares = [numbers[start : start + share] for start in range(0, len(numbers), share or 1)]
        crew = [_Worker(job, each, until) for each in shares]
        for worker in crew:
            stack.callback(worker.close)
        while any(worker.alive for worker in crew):
            pipes = [worker.pipe for worker in crew if worker.alive]
            wait(pipes, _CHECKED_EVERY_S)
            for worker in crew:
                yield from worker.reports()


def minimised(job: Job, finding: Finding, seconds: float) -> Mutant | None:
    """Return the mutant of a finding as small as it goes, or as it is if its process gets lost.

    It is run again and again in one process, under the same limits.
    """
    if finding.mutant is None:
        return None
    ours, theirs = _CONTEXT.Pipe(duplex=False)
    with tempfile.TemporaryDirectory(prefix="deros-fuzz-", dir=_memory()) as folder:
        arguments = (job, finding, seconds, theirs, folder)
        process = _CONTEXT.Process(target=_minimise, args=arguments, daemon=True)
        process.start()
        theirs.close()
        smallest = finding.mutant
        with contextlib.suppress(EOFError, OSError):
            if ours.poll(seconds * 2 + _BLOCKED_S):
                smallest = ours.recv()
        process.kill()
        process.join()
    return smallest


def _minimise(job: Job, finding: Finding, seconds: float, pipe: Connection, where: str) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    enforce(job.limits)
    runner = job.runner(Path(where))

    def fails(mutant: Mutant) -> bool:
        try:
            with limited(job.limits):
                for _ in runner.stages(mutant):
                    pass
        except (Exception, TooSlow) as error:
            return signature(error) == finding.signature
        return False

    assert finding.mutant is not None
    still = fails(finding.mutant)
    pipe.send(minimise(finding.mutant, fails, seconds) if still else finding.mutant)


class _Worker:
    """One share of the numbers, and the process that is at work on it."""

    def __init__(self, job: Job, numbers: Sequence[int], until: float | None) -> None:
        self._job = job
        self._numbers = numbers
        self._until = until
        self._at = 0  # the place in the numbers that the process began with
        self._begun: Any = _CONTEXT.RawValue("q", -1)
        self._folder = tempfile.mkdtemp(prefix="deros-fuzz-", dir=_memory())
        self.alive = True
        self._start()

    def _start(self) -> None:
        self._begun.value = -1
        self.pipe, theirs = _CONTEXT.Pipe(duplex=False)
        rest = self._numbers[self._at : self._at + _LIFE]
        arguments = (self._job, rest, self._until, theirs, self._begun, self._folder)
        self._process = _CONTEXT.Process(target=_work, args=arguments, daemon=True)
        self._process.start()
        theirs.close()
        self._seen = -1
        self._since_cpu = 0.0
        self._since = time.monotonic()

    def reports(self) -> Iterator[Report]:
        """Yield what the process has sent; replace one that is stuck, dead or at its end."""
        if not self.alive:
            return
        ended = gone = False
        try:
            while self.pipe.poll():
                report = self.pipe.recv()
                if report is None:
                    ended = True
                    break
                yield report
        except (EOFError, OSError):
            gone = True
        if ended:
            self._next(len(self._numbers[self._at : self._at + _LIFE]))
        elif gone:
            self._process.join(_LEAVING_S)
            yield self._lost(f"the process died with {self._process.exitcode}")
        elif why := self._stuck():
            yield self._lost(why)

    def _stuck(self) -> str:
        """Say how the mutant at work breaks its limits, if the timer has not ended it."""
        begun = self._begun.value
        now = usage(self._process.pid or 0)
        used = now.seconds if now is not None else 0.0
        if now is not None and now.runnable:
            self._since = time.monotonic()  # it waits for nothing but its turn
        if begun != self._seen:
            self._seen, self._since, self._since_cpu = begun, time.monotonic(), used
        elif begun >= 0 and used - self._since_cpu > self._job.limits.seconds * _PATIENCE:
            return f"took more than {used - self._since_cpu:.1f} s, in code that is not Python"
        elif begun >= 0 and time.monotonic() - self._since > _BLOCKED_S:
            return f"waited for more than {_BLOCKED_S:.0f} s"
        return ""

    def _lost(self, why: str) -> Report:
        """Make the finding of a process that is lost, and go on behind its mutant."""
        place = self._begun.value
        self._kill()
        # One that died before its first mutant is at the first one again, and would be for ever.
        place = max(place, 0)
        number = self._numbers[self._at + place] if self._at + place < len(self._numbers) else -1
        drawn = _given(self._job, number) if number >= 0 else None
        finding = Finding(f"Lost: {why.split(' with ')[0]} ({_kind(drawn)})", why, number, drawn)
        self._next(place + 1)
        return Report(done=1, findings=(finding,))

    def _next(self, done: int) -> None:
        self._kill()
        self._at += done
        late = self._until is not None and time.monotonic() >= self._until
        if self._at >= len(self._numbers) or late:
            self.alive = False
        else:
            self._start()

    def _kill(self) -> None:
        if self._process.is_alive():
            self._process.join(0.5)
            self._process.kill()
        self._process.join()
        self.pipe.close()

    def close(self) -> None:
        """Leave no process and no file behind."""
        if self.alive:
            self._kill()
        shutil.rmtree(self._folder, ignore_errors=True)


def _memory() -> str | None:
    """Return a folder that no disk slows down, if there is one."""
    return "/dev/shm" if os.access("/dev/shm", os.W_OK) else None


def _kind(mutant: Mutant | None) -> str:
    return mutant.kind if mutant is not None else "none"


def _given(job: Job, number: int) -> Mutant:
    if job.given:
        return job.given[number]
    return Drawing(job.projects, job.seed, job.rules).draw(number, job.kinds)


# In the worker ------------------------------------------------------------------------------------


def _work(
    job: Job, numbers: Sequence[int], until: float | None, pipe: Connection, begun: Any, where: str
) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the parent ends the run
    folder = Path(tempfile.mkdtemp(dir=where))
    enforce(job.limits)
    runner = job.runner(folder)
    drawing = None if job.given else Drawing(job.projects, job.seed, job.rules)
    warm = 0.0
    report = _Counting()
    for place, number in enumerate(numbers):
        if until is not None and time.monotonic() >= until:
            break
        mutant = job.given[number] if drawing is None else drawing.draw(number, job.kinds)
        begun.value = place
        report.run(runner, mutant, number, job.limits)
        if place == _WARM_UP:
            warm = kept_mb()
        if place % _BATCH == _BATCH - 1:
            grown = kept_mb() - warm if place > _WARM_UP and place % 1000 == 999 else 0.0
            if grown > job.limits.kept_mb:
                error = TooMuch(f"{place} mutants have kept {grown:.0f} MB")
                report.findings.append(Finding("TooMuch kept by many", str(error), number))
                warm += grown
            pipe.send(report.sent(runner.ends, grown))
            report = _Counting()
            runner.ends = Counter()
    pipe.send(report.sent(runner.ends, 0.0))
    shutil.rmtree(folder, ignore_errors=True)
    pipe.send(None)


class _Counting:
    """Counts until the next report."""

    def __init__(self) -> None:
        self.done = 0
        self.kinds: Counter[str] = Counter()
        self.findings: list[Finding] = []
        self.slowest = 0.0

    def run(self, runner: Any, mutant: Mutant, number: int, limits: Limits) -> None:
        """Run one mutant, and note what goes wrong."""
        self.done += 1
        self.kinds[mutant.kind] += 1
        before = time.process_time()
        try:
            with limited(limits):
                for completed in runner.stages(mutant):
                    mutant = completed
        except (Exception, TooSlow) as error:
            text = "".join(traceback.format_exception(error)[-12:])
            self.findings.append(Finding(signature(error), text, number, mutant))
        self.slowest = max(self.slowest, time.process_time() - before)

    def sent(self, ends: Counter[str], grown: float) -> Report:
        """Return the report."""
        return Report(self.done, self.kinds, ends, tuple(self.findings), self.slowest, grown)
