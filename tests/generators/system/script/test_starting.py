"""The generated script with programs that are started later, or whose exit stops all."""

from __future__ import annotations

import os
import signal
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from types import ModuleType

import pytest

from deros.generators.builtin import rossystem_script
from deros.generators.output.writer import write
from deros.generators.system.script.generate import table
from deros.generators.system.script.standalone.node import Node, Program, awaited_by
from deros.generators.system.script.standalone.supervisor import INTERRUPTED
from deros.generators.system.view import system_view
from tests.support.lint import assert_lint_clean
from tests.support.stand_ins import Run, load_system, make_prefix, make_script
from tests.support.systems import CONTEXT, load_text

Start = Callable[..., Run]
STAMP = f'"{sys.executable}" arguments ["-ISc", "import time; print(time.monotonic_ns())"]'


@pytest.fixture
def start(tmp_path: Path) -> Iterator[Start]:
    """Return a function that starts the script of a system with stand-ins in its path."""
    prefix = make_prefix(tmp_path / "prefix")
    runs: list[Run] = []

    def start_script(members: str, *arguments: str) -> Run:
        models = tmp_path / f"models{len(runs)}"
        models.mkdir()
        script = make_script(models, members)
        given = {"PATH": os.environ["PATH"], "AMENT_PREFIX_PATH": str(prefix)}
        runs.append(Run([sys.executable, "-IS", script, *arguments], given))
        return runs[-1]

    yield start_script
    for run in runs:
        run.close()


def said(run: Run) -> list[str]:
    """Return what the script says itself, without the numbers of processes."""
    mark = "[Robot] "
    own = (line.removeprefix(mark) for line in run.lines if line.startswith(mark))
    return [line.partition(", process")[0] for line in own]


def stamp(run: Run, label: str) -> int:
    """Return the time in nanoseconds that a program has printed."""
    (line,) = (each for each in run.lines if each.startswith(f"[{label}] "))
    return int(line.removeprefix(f"[{label}] "))


def test_program_is_started_after_the_exit_of_another(start: Start) -> None:
    """A chain runs in its order, which need not be that of the text."""
    run = start(
        'process last : "true" after exit of next node first : short '
        "node next : short after exit of first"
    )
    assert run.end() == 0
    assert said(run) == [
        *("first started", "first ended", "next started", "next ended"),
        *("last started", "last ended"),
    ]


def test_failure_that_is_awaited_does_not_stop_the_others(start: Start) -> None:
    """Any exit code will do; that of the script tells of the failure in the end."""
    run = start("node driver : failing node other : steady node next : short after exit of driver")
    run.until("[Robot] next ended", "[other] ready")
    run.signal(signal.SIGTERM)
    assert run.end() == 1
    assert "driver exited with code 3" in said(run)
    assert "stopping: driver has failed" not in said(run)


def test_delay_is_counted_from_the_start_or_the_exit(start: Start) -> None:
    """Stamps of the programs themselves are at least as far apart."""
    before = time.monotonic_ns()
    run = start(
        f"process first : {STAMP} delay 300 ms "
        f"process next : {STAMP} after exit of first delay 400 ms"
    )
    assert run.end() == 0
    assert stamp(run, "first") - before >= 300_000_000
    assert stamp(run, "next") - stamp(run, "first") >= 400_000_000


def test_delay_of_the_first_start_is_not_that_of_restarts(start: Start) -> None:
    """A program that is respawned at once has its delay before the first start alone."""
    run = start(f"process again : {STAMP} delay 60 sec respawn max 1", "--dry-run")
    assert run.end() == 0
    assert run.lines[0] == "# again, 60 s after the start of the system"
    run = start("node again : short delay 1 ms respawn max 1")
    assert run.end() == 0
    assert said(run)[1] == "again ended; restart 1 of 1 in 0 s"


@pytest.mark.parametrize("options", [(), ("--keep-going",)])
def test_exit_stops_all_where_it_says_so(start: Start, options: tuple[str, ...]) -> None:
    """Also one with code 0, which else leaves the others alone."""
    run = start('node other : steady process panel : "true" on exit stop all delay 1 ms', *options)
    assert run.end() == 0
    assert said(run)[-2:] == ["stopping: panel has ended", "other stopped"]


def test_exit_that_stops_all_starts_nothing(start: Start) -> None:
    """What waits for that exit, or for a moment, is not started any more."""
    run = start(
        "node panel : short on exit stop all node next : steady after exit of panel "
        "node late : steady delay 100 sec"
    )
    assert run.end() == 0
    assert said(run) == ["panel started", "panel ended", "stopping: panel has ended"]


def test_nothing_is_started_while_all_is_stopped(start: Start) -> None:
    """Neither after an exit that the stop has caused, nor after a delay."""
    run = start(
        "node first : steady node next : steady after exit of first node late : steady delay 1 sec"
        " node slow : slow",
        *("--stop-timeout", "1.5"),  # the delay passes while `slow` is stopped
    )
    run.until("[first] ready", "[slow] ready")
    run.signal(signal.SIGINT)
    assert run.end() == INTERRUPTED
    assert sorted(run.started()) == ["first", "slow"]


def test_program_does_not_wait_for_what_is_left_out(start: Start) -> None:
    """With --only, it is started by itself, and the script says so."""
    run = start(
        "node first : steady node next : short after exit of first delay 1 ms", "--only", "next"
    )
    assert run.end() == 0
    assert said(run) == [
        *("next does not wait for first, which is left out", "next started", "next ended"),
    ]


def test_program_that_cannot_be_started_has_no_exit(start: Start, tmp_path: Path) -> None:
    """What waits for it, directly or not, is not started; the system ends all the same."""
    broken = tmp_path / "broken"
    broken.write_text("#!/nowhere/at/all\n")
    broken.chmod(0o755)
    run = start(
        f'process first : "{broken}" process next : "true" after exit of first '
        'process last : "true" after exit of next',
        "--keep-going",
    )
    assert run.end() == 1
    assert said(run)[0].startswith("first cannot be started: ")
    assert said(run)[1:] == [
        "next is not started: it waits for the exit of first",
        "last is not started: it waits for the exit of next",
    ]


def test_innermost_program_of_the_name_is_awaited(start: Start) -> None:
    """One of the same subsystem hides one around it; a path leads further in."""
    run = start(
        """
        process first : "sleep" arguments ["100"]
        subsystem inner {
          process first : "true"
          subsystem deep { process next : "true" after exit of first }
        }
        process last : "true" after exit of inner/deep/next on exit stop all
        """
    )
    assert run.end() == 0
    order = [line for line in said(run) if line.endswith("ended")]
    assert order[:3] == ["inner/first ended", "next ended", "last ended"]


def test_dry_run_tells_what_is_waited_for(start: Start) -> None:
    """Behind each program, before the number of its bring-up."""
    run = start(
        "node first : short subsystem s { node next : short after exit of first delay 500 ms } "
        'process panel : "true" delay 2 sec on exit stop all',
        "--dry-run",
    )
    assert run.end() == 0
    assert [line for line in run.lines if line.startswith("#")] == [
        *("# /first", "# /next (s), 0.5 s after the exit of /first"),
        "# panel, 2 s after the start of the system, whose exit stops all",
    ]


def test_rows_without_the_script_are_those_of_its_table(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """``deros up`` runs what the script would run."""
    members = (
        "node first : short node next : short after exit of first delay 500 ms "
        'process panel : "true" delay 2 sec on exit stop all'
    )
    (tmp_path / "models").mkdir()
    script = make_script(tmp_path / "models", members)
    module = ModuleType("script_of_robot")
    monkeypatch.setitem(sys.modules, module.__name__, module)
    exec(compile(script.read_text(), str(script), "exec"), vars(module))
    model = load_system(tmp_path / "models", members)
    assert repr(module.NODES) == repr(table(system_view(model)))


def test_awaited_row_is_looked_for_outwards() -> None:
    """Names that only end alike are others."""
    rows: list[Node | Program] = [
        Node("first", "/", "", ""),
        Node("first", "/", "", "", subsystem="left"),
        Program("first", "", subsystem="right/inner"),
    ]

    def awaited(subsystem: str, after: str = "first") -> int | None:
        found = awaited_by(Program("next", "", subsystem=subsystem, after=after), rows)
        return None if found is None else rows.index(found)

    assert [awaited(each) for each in ("", "left", "left/deep", "right", "right/inner")] == [
        *(0, 1, 1, 0, 2),
    ]
    assert awaited("right", "inner/first") == awaited("left", "right/inner/first") == 2
    assert awaited("left", "irst") is None
    assert awaited("left", "") is None


def test_script_passes_the_ament_linters(tmp_path: Path) -> None:
    """A delay, an exit that is awaited, and one that stops all."""
    model = load_text(
        tmp_path,
        'system s argument fast : bool = true process first : "true" '
        'process next : "true" after exit of first delay 2 sec on exit stop all when fast',
    )
    write(rossystem_script(model, CONTEXT), tmp_path / "out")
    assert_lint_clean(tmp_path / "out")
