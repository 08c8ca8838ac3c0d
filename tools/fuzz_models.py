"""Fuzz everything that reads: models, message definitions, traces, and messages as bytes.

Each mutant runs the whole way, in a process with limits on time and memory: load, check, every
generator, what they made read back, and where the model is sound, a simulation by the reference and
by the generated monitor. An exception, a hang, growth, a difference between the two monitors, or
generated text that its reader refuses is a finding: it is made as small as it goes and kept under
``.tmp/fuzz-models``. Move a folder from there to ``tests/data/fuzzing``, add to its ``mutant.json``
how it ends and with which errors, and the tests replay it.

Exit code 1 says that there were findings.
"""

from __future__ import annotations

import argparse
import os
import random
import sys
import time
from collections import Counter
from pathlib import Path

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

from tools.fuzzing.findings import CORPUS, Finding, keep
from tools.fuzzing.limits import Limits
from tools.fuzzing.mutants import KINDS, Kind
from tools.fuzzing.pool import Job, minimised, run
from tools.fuzzing.projects import ROOT, projects
from tools.fuzzing.running import sound_rules

_NO_LIMIT = 10**9
_MINIMISING_S = 60.0


def main() -> int:
    """Fuzz for a time, or a number of mutants; return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n\n")[0] if __doc__ else "")
    parser.add_argument("--seconds", type=float, help="stop after this time  [default: 60]")
    parser.add_argument("--mutants", type=int, help="stop after so many mutants")
    parser.add_argument("--seed", type=int, help="draw the mutants of an earlier run again")
    parser.add_argument("--first", type=int, default=0, help="number of the first mutant")
    parser.add_argument("--kind", action="append", choices=KINDS, help="mutate nothing else")
    parser.add_argument("--limit", type=float, default=5.0, help="processor time of a mutant, in s")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="worker processes")
    arguments = parser.parse_args()
    seed = random.randrange(2**32) if arguments.seed is None else arguments.seed
    seconds = arguments.seconds
    if seconds is None and arguments.mutants is None:
        seconds = 60.0
    kinds: tuple[Kind, ...] = tuple(arguments.kind or KINDS)
    found = projects(CORPUS)
    job = Job(found, sound_rules(found), seed, kinds, Limits(seconds=arguments.limit))
    count = arguments.mutants if arguments.mutants is not None else _NO_LIMIT
    numbers = range(arguments.first, arguments.first + count)
    print(f"seed {seed}", flush=True)
    tally = Tally()
    started = time.monotonic()
    until = None if seconds is None else started + seconds
    try:
        _fuzz(job, numbers, arguments.jobs, until, tally)
    except KeyboardInterrupt:
        print("stopped by hand", flush=True)
    for line in tally.summary(time.monotonic() - started):
        print(line, flush=True)
    folder = ROOT / ".tmp" / "fuzz-models"
    for finding in tally.findings.values():
        _store(finding, job, folder / finding.file_name)
    return 1 if tally.findings else 0


class Tally:
    """What a run has done.

    Attributes:
        findings: the first of each signature.
    """

    def __init__(self) -> None:
        self.done = 0
        self.kinds: Counter[str] = Counter()
        self.ends: Counter[str] = Counter()
        self.findings: dict[str, Finding] = {}
        self.repeats: Counter[str] = Counter()
        self.slowest = 0.0
        self.grown_mb = 0.0

    def summary(self, seconds: float) -> list[str]:
        """Return what is printed at the end."""
        kinds = ", ".join(f"{self.kinds[kind]:,} of a {kind}" for kind in KINDS if self.kinds[kind])
        ends = ", ".join(f"{count:,} {end}" for end, count in self.ends.most_common())
        lines = [
            f"{self.done:,} mutants in {seconds:.0f} s: {kinds}",
            f"how they ended: {ends}",
            f"slowest: {self.slowest:.2f} s of processor time; memory kept by a process after its"
            f" warm-up: at most {self.grown_mb:.0f} MB",
        ]
        for name, finding in self.findings.items():
            lines.append(f"FINDING ({self.repeats[name]} times, first {finding.number}): {name}")
        lines.append(f"{len(self.findings)} findings" if self.findings else "no findings")
        return lines


def _fuzz(job: Job, numbers: range, workers: int, until: float | None, tally: Tally) -> None:
    console = Console(stderr=True)
    columns = (TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn())
    endless = len(numbers) >= _NO_LIMIT
    with Progress(*columns, console=console, transient=True) as progress:
        task = progress.add_task("fuzzing", total=None if endless else len(numbers))
        for report in run(job, numbers, workers, until):
            tally.done += report.done
            tally.kinds += report.kinds
            tally.ends += report.ends
            tally.slowest = max(tally.slowest, report.slowest)
            tally.grown_mb = max(tally.grown_mb, report.kept_mb)
            for finding in report.findings:
                tally.repeats[finding.signature] += 1
                if finding.signature not in tally.findings:
                    tally.findings[finding.signature] = finding
                    console.print(f"mutant {finding.number}: {finding.signature}", markup=False)
            text = f"{tally.done:,} mutants, {len(tally.findings)} findings"
            progress.update(task, completed=tally.done, description=text)


def _store(finding: Finding, job: Job, folder: Path) -> None:
    """Keep a finding, as small as it goes."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "finding.txt").write_text(
        f"{finding.signature}\nseed {job.seed}, mutant {finding.number}\n\n{finding.text}\n",
        encoding="utf-8",
        errors="backslashreplace",
    )
    mutant = minimised(job, finding, _MINIMISING_S)
    if mutant is not None:
        keep(folder / "mutant", mutant)
        print(f"kept in {folder.relative_to(ROOT)}", flush=True)


if __name__ == "__main__":
    sys.exit(main())
