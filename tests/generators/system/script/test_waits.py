"""Programs that wait for what is in the ROS graph, in the script, on the real middleware."""

from __future__ import annotations

import os
import runpy
import signal
import sys
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from selectors import PollSelector
from types import SimpleNamespace

import pytest

from deros.generators.builtin import rossystem_script
from deros.generators.system.script.generate import system_to_run, table
from deros.generators.system.script.standalone.node import Program, Ready
from deros.generators.system.script.standalone.output import Output
from deros.generators.system.script.standalone.process import Process
from deros.generators.system.script.standalone.supervisor import INTERRUPTED
from deros.generators.system.script.standalone.watch.table import Table
from deros.generators.system.view import system_view
from deros.models.common import Scalar
from deros.systems.running.placement import placed
from tests.support.lint import assert_lint_clean
from tests.support.managed import DESCRIPTION, build
from tests.support.stand_ins import Run, make_prefix
from tests.support.systems import CONTEXT, load_text

Start = Callable[..., Run]
# A program that is no node at all, and so never in the graph.
STEADY = "node steady : demo lifecycle"


@pytest.fixture(scope="module")
def workspace(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder with the package of the managed node, and stand-ins for nodes."""
    folder = build(tmp_path_factory.mktemp("workspace"))
    make_prefix(folder / "stand_ins", names=("steady",))
    return folder


def script_text(folder: Path, body: str) -> str:
    """Return the script of a system of managed nodes and programs that are none."""
    text = f'system Crew imports import "*.rnd" {body}'
    model = load_text(folder, text, member=DESCRIPTION, steady=STEADY)
    (file,) = rossystem_script(model, CONTEXT).values()
    return file.text


@pytest.fixture
def start(workspace: Path, tmp_path: Path, ros_env: dict[str, str]) -> Iterator[Start]:
    """Return a function that starts the script of a system."""
    runs: list[Run] = []

    def start_script(body: str, *arguments: str) -> Run:
        folder = tmp_path / f"models{len(runs)}"
        folder.mkdir()
        script = folder / "crew.py"
        script.write_text(script_text(folder, body))
        paths = ("--package-path", workspace, "--package-path", workspace / "stand_ins")
        runs.append(Run([sys.executable, script, *paths, *arguments], ros_env))
        return runs[-1]

    yield start_script
    for run in runs:
        run.close()


def said(run: Run) -> list[str]:
    """Return what the script says itself, without the numbers of processes."""
    mark = "[Crew] "
    own = (line.removeprefix(mark) for line in run.lines if line.startswith(mark))
    return [line.partition(", process")[0] for line in own]


@pytest.mark.ros
@pytest.mark.parametrize(
    "wait",
    ["node first", "active first", "service /first/get_state", "topic /first/transition_event"],
)
def test_program_is_started_when_it_is_there(start: Start, wait: str) -> None:
    """Not with the system, as the node that it waits for comes later; and then at once."""
    run = start(f'node first : member autostart delay 300 ms process next : "true" after {wait}')
    run.until("[Crew] next ended")
    run.signal(signal.SIGINT)
    assert run.end() == INTERRUPTED
    words = said(run)
    assert words.index("first started") < words.index("next started")
    if wait == "active first":
        place = next(n for n, line in enumerate(run.lines) if line.startswith("[Crew] next start"))
        assert run.lines.index("[bring-up] /first activated") < place


@pytest.mark.ros
def test_delay_counts_from_that_moment_and_restarts_do_not_wait(start: Start) -> None:
    """A restart comes after its own delay alone, be the node there or not."""
    run = start(
        "node first : member activated by next "
        'process next : "true" after node first delay 100 ms respawn delay 1 ms max 1'
    )
    run.until("[Crew] next ended;")
    run.signal(signal.SIGINT)
    run.end()
    assert "next ended; restart 1 of 1 in 0.001 s" in said(run)


@pytest.mark.ros
def test_what_never_comes_is_a_failure_of_what_waits(start: Start) -> None:
    """Everything is stopped; what waits for the exit of that program is not started either."""
    run = start(
        "topics external topic /never node other : steady "
        'process next : "true" after service /never timeout 300 ms '
        'process last : "true" after exit of next'
    )
    assert run.end() == 1
    words = said(run)
    reason = "next is not started: it waits for service /never, and it is not there within 0.3 s"
    assert words[words.index(reason) :][1:3] == [
        "last is not started: it waits for the exit of next",
        "stopping: next has failed",
    ]
    assert not {"next started", "last started"} & {*words}


@pytest.mark.ros
def test_others_go_on_without_it_where_they_are_to(start: Start) -> None:
    """With --keep-going, as after any failure."""
    run = start(
        "topics external topic /never node other : steady "
        'process next : "true" after topic /never timeout 300 ms',
        "--keep-going",
    )
    run.until("[Crew] next is not started", "[Crew] graph-watch ended", "[other] ready")
    run.signal(signal.SIGINT)
    assert run.end() == 1
    assert "stopping: next has failed" not in said(run)


@pytest.mark.ros
@pytest.mark.parametrize(
    ("number", "options"), [(signal.SIGINT, ()), (signal.SIGKILL, ("--keep-going",))]
)
def test_node_that_ends_before_it_is_there_is_not_waited_for(
    start: Start, number: signal.Signals, options: tuple[str, ...]
) -> None:
    """Be it killed, or ended with code 0, which else leaves the others alone."""
    run = start('node first : steady process next : "true" after node first', *options)
    run.until("[first] ready", "[Crew] graph-watch started")
    os.kill(run.started()["first"], number)
    assert run.end() == 1
    reason = "next is not started: it waits for node /first, and first is not running any more"
    assert reason in said(run)


@pytest.mark.ros
def test_interrupt_while_waiting_starts_nothing(start: Start) -> None:
    """The process that watches is stopped like any other."""
    run = start('node first : steady process next : "true" after node first')
    run.until("[first] ready", "[Crew] graph-watch started")
    run.signal(signal.SIGINT)
    assert run.end() == INTERRUPTED
    assert "next started" not in said(run)
    assert "graph-watch stopped" in said(run)


@pytest.mark.ros
def test_node_that_cannot_be_brought_up_is_not_waited_for(start: Start) -> None:
    """As soon as that is known, not when the time is over."""
    run = start(
        "node first : member autostart on failure continue "
        'parameters param place = "configure" process next : "true" after active first'
    )
    assert run.end() == 1
    reason = "next is not started: it waits for /first to be active, and it could not be brought"
    assert f"{reason} to active" in said(run)
    assert "stopping: next has failed" in said(run)


@pytest.mark.ros
def test_time_begins_with_the_start_of_a_node_that_is_started_later(start: Start) -> None:
    """A timeout that is shorter than the delay of the awaited node does no harm."""
    run = start(
        "node first : member activated by next delay 11 sec "
        'process next : "true" after node first timeout 10 sec'
    )
    run.until("[Crew] next ended")
    words = said(run)
    assert words.index("first started") < words.index("next started")


@pytest.mark.ros
def test_node_that_is_left_out_is_not_waited_for(start: Start) -> None:
    """The script says so, and needs nothing to watch the graph with."""
    run = start('node first : steady process next : "true" after node first', "--only", "next")
    assert run.end() == 0
    assert said(run)[0] == "next does not wait for node /first, which is left out"
    assert "graph-watch started" not in said(run)


def test_nothing_is_started_without_rclpy(workspace: Path, tmp_path: Path) -> None:
    """Python without ROS 2 refuses, and says what it is needed for."""
    script = tmp_path / "crew.py"
    script.write_text(
        script_text(
            tmp_path,
            'process a : "true" after service /first/get_state\nnode first : member activated by a',
        )
    )
    bare = Path(sys.base_prefix, "bin", f"python3.{sys.version_info.minor}")
    run = Run([bare, script, "--package-path", workspace], {"PATH": os.environ["PATH"]})
    try:
        assert run.end() == 2
    finally:
        run.close()
    text = "\n".join(run.lines)
    assert "Programs wait for what is in the ROS graph, and" in text
    assert "has no rclpy, so nothing was started" in text


def test_dry_run_says_what_is_waited_for(start: Start) -> None:
    """With the time, and the delay from then on."""
    run = start(
        'node first : steady process next : "true" after node first timeout 3 sec delay 1 sec',
        "--dry-run",
    )
    assert run.end() == 0
    assert "# next, 1 s after waiting for node /first, 3 s at most" in run.lines


VARIED = """\
system Crew on pc imports import "*.rnd"
host pc "a" host robot "b"
argument far : bool = false
argument space : string = ""
argument end : string = "go"
topics external topic "/in/$end"
node first : steady namespace "/left/${space}" when far
subsystem Inner namespace in {
  node first : steady namespace x when not far
  process next : "true" after node first
  process last : "true" after service $end
}
node away : steady on robot
process far : "true" after node away
"""


@pytest.mark.parametrize(
    ("values", "expected"),
    [
        ({}, ["/in/x/first", "/in/go", "/away"]),
        ({"far": True}, ["/left/first", "/in/go", "/away"]),
        ({"far": True, "space": "a", "end": "/go"}, ["/left/a/first", "/go", "/away"]),
    ],
)
def test_names_are_those_for_the_values_of_the_arguments(
    tmp_path: Path, values: Mapping[str, Scalar], expected: list[str]
) -> None:
    """Of nodes with conditions and on other hosts, and of ends; in the script and in `deros up`."""
    text = VARIED.replace('topics external topic "/in/$end"\n', "")
    model = load_text(tmp_path, text, steady=STEADY)
    given = {"host": "pc", "far": False, "space": "", "end": "go", **values}
    there = system_to_run(model, SimpleNamespace(**given), {})
    view = system_view(system_to_run(placed(model), SimpleNamespace(**given), {}), everywhere=there)
    rows = table(view)
    assert [each.ready.name for each in rows if each.ready is not None] == expected

    (file,) = rossystem_script(model, CONTEXT).values()
    script = tmp_path / "crew.py"
    script.write_text(file.text)
    made = runpy.run_path(str(script))
    nodes = made["nodes"]
    found = [each.ready for each in nodes(SimpleNamespace(**given))]
    assert [each.name for each in found if each is not None] == expected


def test_description_of_what_is_waited_for() -> None:
    """As it stands in messages."""
    assert str(Ready("node", "/a", 1.0)) == "node /a"
    assert str(Ready("active", "/a", 1.0)) == "/a to be active"


def test_table_says_what_is_waited_for() -> None:
    """Until that is there; then it is waited for no more, but perhaps for a moment."""
    process = Process(Program("next", "true", ready=Ready("topic", "/a", 1.0)), "next", ["true"])
    process.due = None
    display = Table("crew", ["next"], Output(os.open(os.devnull, os.O_WRONLY), PollSelector()))
    lines = display._lines([process], {}, 0.0, 9)
    assert lines[1].endswith("waits for topic /a")
    process.due = 1.0
    assert display._lines([process], {}, 0.0, 9)[1].endswith("waiting")


@pytest.mark.ros
def test_up_waits_like_the_script(workspace: Path, tmp_path: Path, ros_env: dict[str, str]) -> None:
    """It runs the same modules, for a system with arguments, too."""
    (tmp_path / "member.rnd").write_text(DESCRIPTION)
    (tmp_path / "crew.system").write_text(
        'system Crew imports import "member.rnd" argument space : string = "a"\n'
        'node first : member namespace $space autostart process next : "true" after active first'
        ' timeout 20 sec process last : "true" after service "/${space}/first/get_state"\n'
    )
    command = ["-m", "deros", "up", str(tmp_path / "crew.system"), "--install", str(workspace)]
    run = Run([sys.executable, *command, "space:=b"], ros_env)
    try:
        run.until("[Crew] next ended", "[Crew] last ended", "[Crew] graph-watch ended")
        run.signal(signal.SIGINT)
        assert run.end() == INTERRUPTED
    finally:
        run.close()
    place = next(n for n, line in enumerate(run.lines) if line.startswith("[Crew] next started"))
    assert run.lines.index("[bring-up] /b/first activated") < place


def test_script_passes_the_ament_linters(tmp_path: Path) -> None:
    """With all that it may consist of."""
    (tmp_path / "out").mkdir()
    body = 'node first : member autostart process next : "true" after active first'
    (tmp_path / "out" / "crew.py").write_text(script_text(tmp_path, body))
    assert_lint_clean(tmp_path / "out")
