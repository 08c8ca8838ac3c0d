"""Managed nodes in the generated script and ``deros up``, on the real middleware."""

from __future__ import annotations

import os
import re
import signal
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from deros.generators.builtin import rossystem_script
from deros.generators.output.writer import write
from deros.generators.system.script.standalone.supervisor import INTERRUPTED
from tests.support import pages
from tests.support.lint import assert_lint_clean
from tests.support.managed import DESCRIPTION, build
from tests.support.stand_ins import Run, await_end
from tests.support.systems import CONTEXT, load_text

Start = Callable[..., Run]


@pytest.fixture(scope="module")
def workspace(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder with the package of the managed node."""
    return build(tmp_path_factory.mktemp("workspace"))


def script_of(folder: Path, body: str) -> Path:
    """Generate the script of a system of managed nodes, which are called ``member``."""
    model = load_text(folder, f'system Crew imports import "*.rnd" {body}', member=DESCRIPTION)
    (file,) = rossystem_script(model, CONTEXT).values()
    script = folder / "crew.py"
    script.write_text(file.text)
    return script


def head(text: str) -> str:
    """Return a system of two nodes on either side of one with certain modifiers and parameters."""
    return f"node first : member autostart node second : member {text} node third : member"


@pytest.fixture
def start(workspace: Path, tmp_path: Path, ros_env: dict[str, str]) -> Iterator[Start]:
    """Return a function that starts the script of a system."""
    runs: list[Run] = []

    def start_script(body: str, *arguments: str) -> Run:
        folder = tmp_path / f"models{len(runs)}"
        folder.mkdir()
        script = script_of(folder, body)
        env = {**ros_env, "MARK": str(tmp_path / "mark")}
        runs.append(Run([sys.executable, script, "--package-path", workspace, *arguments], env))
        return runs[-1]

    yield start_script
    for run in runs:
        run.close()


def reported(run: Run) -> list[str]:
    """Return what the process has said that brings nodes up."""
    mark = "[bring-up] "
    return [line.removeprefix(mark) for line in run.lines if line.startswith(mark)]


def hooks(run: Run, name: str) -> list[str]:
    """Return the transitions that a node itself has said it runs."""
    ours = (line for line in run.lines if line.startswith(f"[{name}] ") and line.endswith(" runs"))
    return [line.split()[1] for line in ours]


ALL = ["configure", "activate", "deactivate", "cleanup", "shutdown"]
UP = ["configured", "activated"]
DOWN = ["deactivated", "cleaned up", "shut down"]


def steps(name: str, *done: str) -> list[str]:
    """Return what is said of the transitions of a node."""
    return [f"/{name} {each}" for each in done]


# Without faults -----------------------------------------------------------------------------------


@pytest.mark.ros
@pytest.mark.essential
def test_nodes_come_up_in_order_and_go_down_in_reverse_order(start: Start) -> None:
    """Each is active before the next is configured; all are down before a process is stopped."""
    run = start(
        "subsystem front autostart { node first : member node second : member } "
        "node third : member activated by first"
    )
    run.until("[bring-up] 2 of 2 managed nodes are active")
    run.signal(signal.SIGINT)
    assert run.end() == INTERRUPTED
    assert reported(run) == [
        *(*steps("first", *UP), *steps("second", *UP), "2 of 2 managed nodes are active"),
        *(*steps("second", *DOWN), *steps("first", *DOWN)),
    ]
    assert (hooks(run, "first"), hooks(run, "second"), hooks(run, "third")) == (ALL, ALL, [])
    assert run.lines.index("[Crew] bring-up stopped") < min(
        run.lines.index(f"[Crew] {name} stopped") for name in ("first", "second", "third")
    )


@pytest.mark.ros
def test_system_ends_with_its_last_node(start: Start) -> None:
    """The process that brings nodes up does not keep the system alive."""
    run = start("node first : member autostart")
    run.until("[bring-up] 1 of 1 managed nodes are active")
    os.kill(run.started()["first"], signal.SIGINT)
    assert run.end() == 0
    assert run.lines[-1] == "[Crew] bring-up ended"


@pytest.mark.ros
def test_deros_up_does_the_same(workspace: Path, tmp_path: Path, ros_env: dict[str, str]) -> None:
    """The modules of the script are those that the command runs."""
    script_of(tmp_path, "node first : member autostart")
    (system,) = tmp_path.glob("*.system")
    deros = Path(sys.prefix, "bin", "deros")
    run = Run([deros, "up", system, "--install", workspace], ros_env)
    try:
        run.until("[bring-up] 1 of 1 managed nodes are active")
        run.signal(signal.SIGINT)
        assert run.end() == INTERRUPTED
    finally:
        run.close()
    assert hooks(run, "first") == ALL


@pytest.mark.ros
def test_page_shows_what_is_printed(start: Start) -> None:
    """The lines in ``docs/running.md`` are those of such a system, but for the processes."""
    (page,) = (
        block.text
        for block in pages.blocks()
        if (block.page, block.language) == ("docs/running.md", "text") and "bring-up" in block.text
    )
    run = start("node lidar : member autostart node planner : member autostart")
    run.until("[bring-up] 2 of 2 managed nodes are active")
    printed = [line for line in run.lines if line.startswith(("[Crew]", "[bring-up]"))]
    assert [re.sub(r"\d{2,}", "N", line) for line in printed] == [
        re.sub(r"\d{2,}", "N", line.replace("[Robot]", "[Crew]")) for line in page.splitlines()
    ]


# Failures -----------------------------------------------------------------------------------------


@pytest.mark.ros
def test_failing_transition_stops_everything(start: Start) -> None:
    """What is up is brought down; what is behind is not touched; the exit code is 1."""
    run = start(
        "subsystem s autostart { node first : member node second : member parameters "
        'param place = "configure" param way = "fail" node third : member }'
    )
    assert run.end() == 1
    assert reported(run) == [
        *steps("first", *UP),
        "/second is not active: it does not configure: the transition has failed",
        *steps("second", "shut down"),
        *steps("first", *DOWN),
    ]
    assert hooks(run, "third") == []
    assert "[Crew] stopping: bring-up has failed" in run.lines


@pytest.mark.ros
def test_hanging_transition_is_bounded_by_the_timeout(start: Start) -> None:
    """The node does not answer any more; the ones before it are brought down all the same."""
    run = start(
        "node first : member autostart node second : member autostart timeout 400 ms parameters "
        'param place = "activate" param way = "hang"',
        "--stop-timeout",
        "2",
    )
    assert run.end() == 1
    assert reported(run) == [
        *steps("first", *UP),
        *steps("second", "configured"),
        "/second is not active: it does not activate within 0.4 s",
        "/second is not shut down: it does not answer",
        *steps("first", *DOWN),
    ]


@pytest.mark.ros
def test_others_run_on_without_an_optional_node(start: Start) -> None:
    """With ``on failure continue``, they come up; the exit code is 1 all the same."""
    run = start(
        "node first : member autostart on failure continue parameters "
        'param place = "configure" param way = "die" node second : member autostart'
    )
    run.until("[bring-up] 1 of 2 managed nodes are active")
    assert "[Crew] first was killed by SIGKILL" in run.lines
    run.signal(signal.SIGINT)
    assert run.end() == 1
    assert reported(run) == [
        "/first is not active: it has ended",
        *(*steps("second", *UP), "1 of 2 managed nodes are active", *steps("second", *DOWN)),
    ]


@pytest.mark.ros
def test_node_that_dies_on_its_way_up_stops_everything(start: Start) -> None:
    """Nobody waits for an answer that cannot come."""
    run = start(
        "subsystem s autostart { node first : member node second : member parameters "
        'param place = "activate" param way = "die" node third : member }'
    )
    assert run.end() == 1
    assert "[Crew] stopping: second has failed" in run.lines
    assert (hooks(run, "first"), hooks(run, "third")) == (ALL, [])


@pytest.mark.ros
def test_respawned_node_is_brought_up_again(start: Start) -> None:
    """Killed on its way up, and when it is active: the services of its dead self answer nobody."""
    run = start(
        "subsystem s autostart { node first : member respawn parameters "
        'param place = "activate" param way = "die once" node second : member }'
    )
    run.until("[bring-up] 2 of 2 managed nodes are active")
    assert reported(run) == [
        *steps("first", "configured", *UP),
        *(*steps("second", *UP), "2 of 2 managed nodes are active"),
    ]
    os.kill(run.started()["first"], signal.SIGKILL)
    run.until("[bring-up] 2 of 2 managed nodes are active", times=2)
    assert reported(run)[-3:-1] == steps("first", *UP)
    run.signal(signal.SIGINT)
    assert run.end() == INTERRUPTED
    assert reported(run)[-6:] == [*steps("second", *DOWN), *steps("first", *DOWN)]


@pytest.mark.ros
def test_second_signal_does_not_wait_for_a_node_to_be_shut_down(start: Start) -> None:
    """A node that hangs in its cleanup holds up the others only until somebody insists."""
    run = start(
        'node first : member autostart parameters param place = "cleanup" param way = "hang"',
        "--stop-timeout",
        "600",
    )
    run.until("[bring-up] 1 of 1 managed nodes are active")
    run.signal(signal.SIGINT)
    run.until("[first] cleanup runs")
    run.signal(signal.SIGINT)
    run.until("[Crew] bring-up is still running, sending SIGTERM", "[Crew] bring-up stopped")
    os.kill(run.started()["first"], signal.SIGKILL)  # the node itself hangs, too
    assert run.end() == 1


@pytest.mark.ros
def test_end_of_the_process_that_brings_nodes_up_stops_everything(start: Start) -> None:
    """Nobody could shut the nodes down in order any more."""
    run = start("node first : member autostart")
    run.until("[bring-up] 1 of 1 managed nodes are active")
    os.kill(run.started()["bring-up"], signal.SIGKILL)
    assert run.end() == 1
    assert "[Crew] stopping: bring-up has failed" in run.lines
    assert "[Crew] first stopped" in run.lines


@pytest.mark.ros
def test_nothing_is_left_of_a_killed_script(start: Start) -> None:
    """The process that brings nodes up ends with them."""
    run = start("node first : member autostart node second : member autostart")
    run.until("[bring-up] 2 of 2 managed nodes are active")
    run.signal(signal.SIGKILL)
    assert all(await_end(pid) for pid in run.started().values())


# Before the start ---------------------------------------------------------------------------------


def test_nothing_is_started_without_rclpy(workspace: Path, tmp_path: Path) -> None:
    """Python without ROS 2 refuses, and says what is missing."""
    script = script_of(tmp_path, "node first : member autostart")
    bare = Path(sys.base_prefix, "bin", f"python3.{sys.version_info.minor}")
    run = Run([bare, script, "--package-path", workspace], {"PATH": os.environ["PATH"]})
    try:
        assert run.end() == 2
    finally:
        run.close()
    text = "\n".join(run.lines)
    assert "has no rclpy and no lifecycle_msgs, so nothing was started" in text
    assert "started, process" not in text


@pytest.mark.ros
def test_node_that_is_started_later_does_not_hold_up_the_others(
    start: Start, tmp_path: Path
) -> None:
    """It is brought up when it has started, and brought down like the others."""
    os.mkfifo(tmp_path / "go")
    run = start(
        f'process wait : "cat" arguments ["{tmp_path}/go"] '
        "node first : member autostart after exit of wait node second : member autostart"
    )
    run.until("[bring-up] 1 of 2 managed nodes are active")
    (tmp_path / "go").write_text("")
    run.until("[bring-up] 2 of 2 managed nodes are active")
    run.signal(signal.SIGINT)
    assert run.end() == INTERRUPTED
    assert reported(run) == [
        *(*steps("second", *UP), "1 of 2 managed nodes are active"),
        *(*steps("first", *UP), "2 of 2 managed nodes are active"),
        *(*steps("second", *DOWN), *steps("first", *DOWN)),
    ]


def test_dry_run_shows_the_order(start: Start) -> None:
    """The turn of each node stands beside its name."""
    run = start(head("autostart"), "--dry-run")
    assert run.end() == 0
    assert [line for line in run.lines if line.startswith("#")] == [
        "# /first, activated as number 1",
        "# /second, activated as number 2",
        "# /third",
    ]


def test_script_passes_the_ament_linters(tmp_path: Path) -> None:
    """flake8 and pep257 with ament's settings find nothing."""
    body = (
        f'system Crew imports import "*.rnd" {head("autostart timeout 1 sec on failure continue")}'
    )
    model = load_text(tmp_path, body, member=DESCRIPTION)
    write(rossystem_script(model, CONTEXT), tmp_path / "out")
    assert_lint_clean(tmp_path / "out")
