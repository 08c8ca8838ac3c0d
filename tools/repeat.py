"""Run the tests on the real middleware again and again, on a machine that is kept busy.

A test that passes once may still hang on what else the machine does. Each round has those tests
that each change runs, and a tenth of the slow ones, drawn anew; it prints what pytest counted, and
which tests failed; their output is kept. Exit code 1 says that a round failed.
"""

from __future__ import annotations

import argparse
import contextlib
import re
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[1]
_BUSY = "while True: pass"
_EACH = ("-m", "ros", "--slow-share=0.1")
_COUNTED = re.compile(r"^=* ?(?P<counts>\d+ (?:passed|failed).*?) in [\d.]+s", re.MULTILINE)
_FAILED = re.compile(r"^(?:FAILED|ERROR) (?P<test>\S+)", re.MULTILINE)


def main(arguments: Sequence[str] | None = None) -> int:
    """Print how each round went; return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=10)
    parser.add_argument("--busy", type=int, default=2, help="processes that never rest")
    parser.add_argument("--jobs", type=int, default=2, help="tests at once")
    parser.add_argument("--output", type=Path, default=REPOSITORY / ".tmp" / "repeat")
    parser.add_argument("--draw", default="", help="a text by which the slow tests are drawn")
    parser.add_argument("tests", nargs="*", help="what pytest is to run instead, in each round")
    options = parser.parse_args(arguments)
    options.output.mkdir(parents=True, exist_ok=True)
    failed = 0
    with _busy(options.busy):
        for number in range(1, options.rounds + 1):
            log = options.output / f"{number}.log"
            tests = options.tests or [*_EACH, f"--draw={options.draw} {number}"]
            failed += not _round(f"{number} of {options.rounds}", log, options.jobs, tests)
    print(f"{options.rounds - failed} of {options.rounds} rounds passed", flush=True)
    return 1 if failed else 0


def _round(title: str, log: Path, jobs: int, tests: Sequence[str]) -> bool:
    """Run the tests once, and tell how it went; return whether all passed."""
    command = [sys.executable, "-m", "pytest", "-q", "-n", str(jobs), "--dist", "worksteal"]
    begun = time.monotonic()
    with log.open("w", encoding="utf-8") as output:
        code = subprocess.run(
            [*command, *tests], cwd=REPOSITORY, stdout=output, stderr=subprocess.STDOUT
        ).returncode
    text = log.read_text(encoding="utf-8", errors="replace")
    counts = _COUNTED.findall(text)
    minutes, seconds = divmod(round(time.monotonic() - begun), 60)
    reported = counts[-1] if counts else f"pytest ended with {code}"
    print(f"round {title}: {reported}, {minutes} min {seconds} s", flush=True)
    for test in _FAILED.findall(text):
        print(f"  {test}", flush=True)
    if code:
        print(f"  see {log}", flush=True)
    return code == 0


@contextlib.contextmanager
def _busy(count: int) -> Iterator[None]:
    """Keep so many processes busy."""
    processes = [subprocess.Popen([sys.executable, "-c", _BUSY]) for _ in range(count)]
    try:
        yield
    finally:
        for process in processes:
            process.kill()
            process.wait()


if __name__ == "__main__":
    sys.exit(main())
