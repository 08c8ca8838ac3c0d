"""``deros up``: checks before the start, and the behaviour of the launch script."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from deros.cli.interrupts import INTERRUPTED
from deros.generators.builtin import rosnode_python
from deros.generators.output.writer import write
from deros.metamodels.load import Repository
from tests.support.interrupted import LOST
from tests.support.stand_ins import Run, await_end, load_system, make_prefix, make_script
from tests.support.systems import CONTEXT

if TYPE_CHECKING:
    from tests.support.ros import Peer

DEROS = Path(sys.executable).with_name("deros")

Up = Callable[..., Run]


@pytest.fixture
def up(tmp_path: Path) -> Iterator[Up]:
    """Return a function that runs a system of stand-ins with ``deros up``."""
    prefix = make_prefix(tmp_path / "install" / "demo")
    runs: list[Run] = []

    def start(
        members: str, *arguments: str, env: Mapping[str, str] | None = None, install: bool = True
    ) -> Run:
        load_system(tmp_path, members)
        places = ["--install", str(prefix.parent)] if install else []
        command: list[str | Path] = [DEROS, "up", tmp_path / "robot.system", *places, *arguments]
        runs.append(Run(command, {**os.environ, "AMENT_PREFIX_PATH": "", **(env or {})}))
        return runs[-1]

    yield start
    for run in runs:
        run.close()


def test_system_runs_until_interrupted(up: Up) -> None:
    """Nodes of the install space start, and stop in order; the code says that it was Ctrl-C."""
    run = up("node a : steady subsystem s namespace s { node b : steady }")
    run.until("[a] ready", "[b] ready")
    run.signal(signal.SIGINT)
    assert run.end() == INTERRUPTED
    assert {"[a] got SIGINT", "[b] got SIGINT"} <= set(run.lines)


def test_words_variables_and_prefix_reach_the_program(up: Up) -> None:
    """As the script passes them; a process is started beside the nodes."""
    run = up(
        """
        argument level : int = 5
        env LEVEL = $level
        node ears : arguments arguments ["-d", $level] prefix "env -u LEVEL"
        process told : "sh" arguments ["-c", "echo level $LEVEL"]
        """,
        "level:=7",
    )
    assert run.end() == 0
    assert "[told] level 7" in run.lines
    (ears,) = (line for line in run.lines if line.startswith("[ears] "))
    assert ears.startswith('[ears] ["-d", "7", "--ros-args"')


def test_failed_node_fails_the_command(up: Up) -> None:
    """The exit code is 1."""
    run = up("node a : steady node b : failing")
    assert run.end() == 1
    assert "[Robot] stopping: b has failed" in run.lines


def test_model_with_errors_is_not_started(up: Up) -> None:
    """Findings and exit code are those of ``deros check``, and nothing is started."""
    run = up("node a : short wirings connect nothing to /x")
    assert run.end() == 1
    text = "\n".join(run.lines)
    assert "error[DRS204 unknown-port]" in text
    assert "started" not in text


def test_warnings_do_not_prevent_the_start(up: Up) -> None:
    """Warnings are shown before the system runs."""
    run = up("topics topic /lonely node a : short")
    assert run.end() == 0
    text = "\n".join(run.lines)
    assert text.index("warning[DRS212 unused-topic]") < text.index("[a] done")


def test_unsupported_parameter_value_prevents_the_start(up: Up, tmp_path: Path) -> None:
    """``up`` rejects a value that the generator of the script rejects."""
    (tmp_path / "bytes.rnd").write_text("node bytes : demo parameters name b : byte[] = [1]")
    run = up("node a : bytes parameters param b = [2]")
    assert run.end() == 1
    assert "error[DRS402 unsupported-by-target]" in "\n".join(run.lines)


def test_missing_programs_are_named_and_exit_with_2(up: Up) -> None:
    """Without the install space there are no programs."""
    run = up("node a : short node b : steady", install=False)
    assert run.end() == 2
    text = "\n".join(run.lines)
    assert "/a: package 'demo' has no program 'short'" in text
    assert "/b: package 'demo' has no program 'steady'" in text


@pytest.mark.essential
def test_dry_run_matches_the_script(up: Up, tmp_path: Path) -> None:
    """Command and script print the same commands for the same system."""
    members = "node a : short subsystem s namespace /s { node b : steady log_level warn }"
    run = up(members, "--dry-run")
    assert run.end() == 0
    (tmp_path / "again").mkdir()
    script = make_script(tmp_path / "again", members)
    places = ["--package-path", str(tmp_path / "install")]
    command = [sys.executable, str(script), "--dry-run", *places]
    env = {**os.environ, "AMENT_PREFIX_PATH": ""}  # as `up` has it
    done = subprocess.run(command, env=env, capture_output=True, text=True, check=True)
    assert run.lines[-4:] == done.stdout.splitlines()


@pytest.mark.slow
@pytest.mark.parametrize("arguments", [["--only", "b"], ["--", "--only", "b"], ["--except", "a"]])
def test_nodes_can_be_selected(up: Up, arguments: list[str]) -> None:
    """Arguments of the script are options of the command, and may also follow ``--``."""
    run = up("node a : short node b : short", *arguments)
    assert run.end() == 0
    assert "[b] done" in run.lines
    assert "[a] done" not in run.lines


def test_log_files_and_table_are_those_of_the_script(up: Up, tmp_path: Path) -> None:
    """The command has the options, too."""
    assert up("node a : short", "--log-dir", str(tmp_path / "logs")).end() == 0
    assert (tmp_path / "logs" / "a.log").read_text().endswith(" done\n")
    run = up("node a : short", "--table")
    assert run.end() == 2
    assert run.lines[-1] == "--table draws on a terminal, and the output is none"


def test_only_systems_can_be_run(tmp_path: Path) -> None:
    """A node description is a usage error, and a missing file is reported."""
    (tmp_path / "a.rnd").write_text("node a : demo")
    for name, words in (("a.rnd", "takes system descriptions (*.system)"), ("b.system", "DRS001")):
        done = subprocess.run(
            [DEROS, "up", tmp_path / name], capture_output=True, text=True, check=False
        )
        assert done.returncode == 2
        assert words in done.stderr


def test_nodes_end_when_the_command_is_killed(up: Up) -> None:
    """SIGKILL of the command leaves no node behind."""
    run = up("node a : stubborn", "--stop-timeout", "0.1")
    run.until("[a] ready")
    run.signal(signal.SIGKILL)
    assert await_end(run.started()["a"])


def test_interrupt_before_the_start_is_not_lost(tmp_path: Path) -> None:
    """The command ends at once, and nothing is started."""
    prefix = make_prefix(tmp_path / "install" / "demo")
    load_system(tmp_path, "node a : short")
    command = [sys.executable, "-c", LOST, "up", str(tmp_path / "robot.system")]
    done = subprocess.run(
        [*command, "--install", str(prefix.parent)], capture_output=True, text=True, check=False
    )
    assert (done.returncode, done.stdout) == (INTERRUPTED, ""), done.stderr


# With real middleware -----------------------------------------------------------------------------

TALKER = """
    node talker : up_demo
    parameters
      name text : string = "nothing"
      name volume : double = 0.0
    publishes
      topic words : std_msgs.String
    timers
      timer tick every 50 ms
"""
LISTENER = """
    node listener : up_demo
    subscribes
      topic heard : std_msgs.String
    publishes
      topic ~/answer : std_msgs.String
"""
SYSTEM = """
    system Talk
    imports
      import "*.rnd"
    topics
      topic /room
      external topic /answers : std_msgs.String
    subsystem front namespace /front {
      node speaker : talker
      parameters
        param text = "true"
        param volume = 11
      wirings
        connect words to /room
    }
    subsystem back namespace /back {
      node ear : listener respawn
      wirings
        connect heard to /room
        connect ~/answer to /answers
    }
"""
BODIES = {
    "talker": (
        "self.get_logger().warning('on_tick does nothing yet', once=True)",
        "self.publish_words(String(data=f'{self.parameters.text} {self.parameters.volume!r}'))",
    ),
    "listener": (
        "self.get_logger().warning('on_heard does nothing yet', once=True)",
        "self.publish_answer(String(data=f'{self.get_fully_qualified_name()}: {msg.data}'))",
    ),
}


def generate_package(folder: Path) -> None:
    """Generate the package of both nodes and fill in their code."""
    (folder / "talker.rnd").write_text(TALKER)
    (folder / "listener.rnd").write_text(LISTENER)
    loaded = Repository().load(folder / "talker.rnd")
    assert loaded.diagnostics == ()
    write(rosnode_python(loaded.model, CONTEXT), folder)
    for name, (empty, filled) in BODIES.items():
        path = folder / "up_demo" / "up_demo" / f"{name}.py"
        text = path.read_text()
        assert empty in text
        text = text.replace(empty, filled)
        if "import String" not in text:
            text = text.replace(
                "\nfrom up_demo", "\nfrom std_msgs.msg import String\nfrom up_demo", 1
            )
        path.write_text(text)


@pytest.mark.ros
@pytest.mark.essential
def test_generated_nodes_communicate_as_described(
    tmp_path: Path, ros_env: dict[str, str], ros_peer: Peer
) -> None:
    """Two generated packages run from their sources under their names and exchange messages.

    Names, namespaces, both kinds of remapping and a string that looks like a boolean arrive; a
    killed node is restarted; and all ends at a Ctrl-C.
    """
    from std_msgs.msg import String

    generate_package(tmp_path)
    (tmp_path / "talk.system").write_text(SYSTEM)
    answers: list[tuple[str, float]] = []

    def receive(message: String, info: dict[str, int]) -> None:
        answers.append((message.data, info["source_timestamp"] / 1e9))

    ros_peer.node.create_subscription(String, "/answers", receive, 10)
    run = Run([DEROS, "up", tmp_path / "talk.system", "--install", tmp_path], ros_env)
    try:
        ros_peer.until(lambda: answers)
        assert answers[0][0] == "/back/ear: true 11.0"
        # Names are transferred separately from the messages, and may arrive after them.
        names = {("speaker", "/front"), ("ear", "/back")}
        ros_peer.until(lambda: names <= set(ros_peer.node.get_node_names_and_namespaces()))
        run.until("ear started")
        os.kill(run.started()["ear"], signal.SIGKILL)
        run.until("ear was killed by SIGKILL; restart 1 in 0 s")
        killed = time.time()
        ros_peer.until(lambda: answers[-1][1] > killed)  # earlier messages may still arrive
        run.signal(signal.SIGINT)
        assert run.end() == INTERRUPTED, "\n".join(run.lines)
    finally:
        run.close()
