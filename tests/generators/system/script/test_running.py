"""The generated script with real processes: start, arguments, restart, stop."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from deros.generators.system.script.standalone.supervisor import INTERRUPTED
from tests.support.needs import needs
from tests.support.stand_ins import LIMIT, Run, await_end, end_careless, make_prefix, make_script

Start = Callable[..., Run]


@pytest.fixture
def start(tmp_path: Path) -> Iterator[Start]:
    """Return a function that starts the script of a system with stand-ins in its path."""
    prefix = make_prefix(tmp_path / "prefix")
    runs: list[Run] = []

    def start_script(members: str, *arguments: str, nodes: str = "", **env: str) -> Run:
        models = tmp_path / f"models{len(runs)}"
        models.mkdir()
        script = make_script(models, members, nodes)
        given = {"PATH": os.environ["PATH"], "AMENT_PREFIX_PATH": str(prefix), **env}
        # Isolated and without site-packages: the standard library must suffice.
        runs.append(Run([sys.executable, "-IS", script, *arguments], given))
        return runs[-1]

    yield start_script
    for run in runs:
        run.close()


# Starting ---------------------------------------------------------------------------------------


def test_every_node_gets_its_settings_as_arguments(start: Start) -> None:
    """Names, namespace, typed parameters, remappings and log level are ROS arguments."""
    node = """
        node listener : demo
          executable "arguments"
        parameters
          name rate : double = 1.0
          name mode.kind : string = "auto"
        subscribes
          topic in : std_msgs.Bool
    """
    run = start(
        """
        subsystem front namespace /front {
          node ears : listener log_level debug
          parameters param rate = 3  param mode.kind = "yes"
          wirings connect in to /words
        }
        """,
        nodes=node,
    )
    assert run.end() == 0
    arguments_line = next(line for line in run.lines if line.startswith("[ears] "))
    assert json.loads(arguments_line.removeprefix("[ears] ")) == [
        *("--ros-args", "-r", "__node:=ears", "-r", "__ns:=/front"),
        *("-p", "rate:=3.0", "-p", 'mode.kind:="yes"'),
        *("-r", "in:=/words", "--log-level", "front.ears:=debug"),
    ]


def test_arguments_decide_what_is_started_and_with_what(start: Start) -> None:
    """A wrong value starts nothing; a right one reaches the node, and its condition."""
    node = """
        node listener : demo
          executable "arguments"
        parameters
          name rate : double = 1.0
        subscribes
          topic in : std_msgs.Bool
    """
    system = """
        argument robot : string = "front"
        argument rate : int = 3 in [1, 9]
        argument second : bool = false
        node ears : listener namespace $robot
        parameters param rate = $rate * 2
        wirings connect in to "/${robot}/words" when not second
        node more : listener when second
    """

    def told(run: Run) -> dict[str, list[str]]:
        lines = (re.fullmatch(r"\[(\w+)\] (\[.*\])", line) for line in run.lines)
        return {line[1]: json.loads(line[2]) for line in lines if line is not None}

    refused = start(system, "rate:=10", nodes=node)
    assert refused.end() == 2
    assert told(refused) == {}
    usual = start(system, nodes=node)
    assert usual.end() == 0
    assert told(usual) == {
        "ears": [
            *("--ros-args", "-r", "__node:=ears", "-r", "__ns:=/front"),
            *("-p", "rate:=6.0", "-r", "in:=/front/words"),
        ]
    }
    other = start(system, "second:=true", "robot:=back", "rate:=1", nodes=node)
    assert other.end() == 0
    assert told(other) == {
        "ears": ["--ros-args", "-r", "__node:=ears", "-r", "__ns:=/back", "-p", "rate:=2.0"],
        "more": ["--ros-args", "-r", "__node:=more", "-r", "__ns:=/"],
    }


_LISTENER = """
    node listener : demo
      executable "arguments"
    ---
    node teller : demo
      executable "environment"
"""


def test_words_variables_and_prefix_reach_the_program(start: Start, tmp_path: Path) -> None:
    """Words stand before those of ROS 2; variables are the program's own; a prefix runs it."""
    run = start(
        f"""
        env SHARED = "of all"
        argument level : int = 5
        node ears : listener arguments ["-d", "a b", $level, ""] prefix "env -u SHARED nice -n 1"
        node one : teller env OWN = "$HOME \\"x\\"" env SHARED = "mine"
        node two : teller
        process more : "{sys.executable}" arguments ["-c", "import os; print(os.getcwd(),
            os.environ['SHARED'])"] cwd "{tmp_path}"
        """.replace("\n            os", " os"),
        "level:=7",
        nodes=_LISTENER,
    )
    assert run.end() == 0
    said = dict(re.findall(r"^\[(\w+)\] (?=[\[{/])(.*)$", "\n".join(run.lines), re.MULTILINE))
    assert json.loads(said["ears"]) == [
        *("-d", "a b", "7", "", "--ros-args", "-r", "__node:=ears", "-r", "__ns:=/"),
    ]
    one, two = json.loads(said["one"]), json.loads(said["two"])
    assert (one["OWN"], one["SHARED"]) == ('$HOME "x"', "mine")
    assert (two.get("OWN"), two["SHARED"]) == (None, "of all")
    assert said["more"] == f"{tmp_path} of all"


def test_processes_are_watched_as_nodes_are(start: Start, tmp_path: Path) -> None:
    """They are chosen by name, started again, and their failure stops the others."""
    mark = tmp_path / "mark"
    members = f"""
        node steady : steady
        subsystem tools {{
          process once : "sh" arguments ["-c", "echo once"] respawn delay 0.01 sec max 1
          process failing : "sh" arguments ["-c", "read line < {mark}; exit 3"]
        }}
    """
    os.mkfifo(mark)
    run = start(members)
    run.until("[steady] ready", "once ended")
    run.until("[once] once", times=2)
    mark.write_text("go")
    assert run.end() == 1
    assert "[Robot] stopping: failing has failed" in run.lines
    assert "[steady] got SIGINT" in run.lines
    chosen = start(members, "--only", "tools/once")
    assert chosen.end() == 0
    assert set(chosen.started()) == {"once"}
    left = start(members, "--except", "tools", "--except", "steady")
    assert left.end() == 0
    assert left.started() == {}


def test_process_gets_no_signal_but_as_nodes_do(start: Start) -> None:
    """A Ctrl-C stops it with the nodes, and one that is told to stop has ended well."""
    run = start('node steady : steady process waits : "sleep" arguments [60]')
    run.until("[steady] ready", "waits started")
    run.signal(signal.SIGINT)
    assert run.end() == INTERRUPTED
    assert "[Robot] waits stopped" in run.lines


@pytest.mark.parametrize(
    ("part", "fault"),
    [
        ('process p : "no_such_program"', "p: no program 'no_such_program' in the PATH"),
        (
            'node p : short prefix "no_such_tool -x"',
            "/p: its prefix needs the program 'no_such_tool'",
        ),
        ('process p : "ls" env PATH = "/nowhere"', "p: no program 'ls' in the PATH"),
        ('process p : "./ls" cwd "/"', "p: no program './ls'"),
        ('process p : "ls" cwd "/nowhere"', "p: there is no folder '/nowhere'"),
        ("process p : $tool", "p: no program '' in the PATH"),
        ("node p : short prefix $open", 'its prefix "gdb \'x" cannot be taken apart'),
    ],
)
def test_what_cannot_be_started_prevents_the_start(start: Start, part: str, fault: str) -> None:
    """It is found before anything is started, also with the values of arguments."""
    arguments = 'argument tool : string = "ls" argument open : string = ""'
    run = start(f"{arguments} node a : short {part}", "tool:=", "open:=gdb 'x")
    assert run.end() == 2
    text = "\n".join(run.lines)
    assert fault in text
    assert "started, process" not in text


@needs("bash")
def test_dry_run_prints_variables_and_folders(start: Start, tmp_path: Path) -> None:
    """Each line can be pasted into bash, and does what the script does."""
    folder = tmp_path / "a b"
    folder.mkdir()
    run = start(
        'node a : teller env OWN = "it\'s" prefix "nice -n 1"'
        f' process p : "sh" arguments ["-c", "pwd; echo $OWN"] env OWN = "x y" cwd "{folder}"',
        "--dry-run",
        nodes=_LISTENER,
    )
    assert run.end() == 0
    assert run.lines[0] == "# /a"
    assert run.lines[1].startswith("OWN='it'\"'\"'s' nice -n 1 ")
    assert run.lines[2] == "# p"
    done = subprocess.run(["bash", "-c", run.lines[3]], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines() == [str(folder), "x y"]


def test_unusual_parameter_names_are_passed_in_a_file(start: Start) -> None:
    """The command line of rcl has no names with '-', or with a part that starts with a digit."""
    node = """
        node listener : demo
          executable "arguments"
        parameters
          name rate : double = 1.0
          name qos_overrides./tf.publisher.depth : int = 1
          name max-age : double = 1.0
          name "3d.on" : bool = false
    """
    members = """
        node ears : listener
        parameters
          param qos_overrides./tf.publisher.depth = 7
          param max-age = inf
          param "3d.on" = true
          param rate = nan
    """
    run = start(members, nodes=node)
    assert run.end() == 0
    arguments_line = next(line for line in run.lines if line.startswith("[ears] "))
    arguments = json.loads(arguments_line.removeprefix("[ears] "))
    file = Path(arguments.pop())
    assert arguments == [
        *("--ros-args", "-r", "__node:=ears", "-r", "__ns:=/"),
        *("-p", "qos_overrides./tf.publisher.depth:=7", "-p", "rate:=.nan", "--params-file"),
    ]
    assert not file.parent.exists()
    shown = start(members, "--dry-run", nodes=node)
    assert shown.end() == 0
    assert shown.lines[1].endswith(
        """ <(echo '{/**: {ros__parameters: {"max-age": .inf, "3d.on": true}}}')"""
    )


def test_all_missing_programs_are_named_before_the_start(start: Start) -> None:
    """Two of three programs are missing: both are named, the third is not started."""
    nodes = "node ghost : demo --- node stranger : elsewhere"
    run = start("node a : short node b : ghost node c : stranger", nodes=nodes)
    assert run.end() == 2
    text = "\n".join(run.lines)
    assert "/b: package 'demo' has no program 'ghost'" in text
    assert "/c: package 'elsewhere' has no program 'stranger'" in text
    assert "started, process" not in text


def test_programs_are_found_through_the_environment(start: Start, tmp_path: Path) -> None:
    """DEROS_PACKAGE_PATH names install spaces, like --package-path."""
    elsewhere = str(tmp_path / "prefix")
    run = start("node a : short", AMENT_PREFIX_PATH="", DEROS_PACKAGE_PATH=f"/nowhere:{elsewhere}")
    assert run.end() == 0
    assert "[a] done" in run.lines


@needs("bash")
def test_dry_run_prints_the_commands_and_starts_nothing(start: Start, tmp_path: Path) -> None:
    """The commands can be pasted into a shell."""
    run = start('subsystem arm "The arm" { node a : short }', "--dry-run")
    assert run.end() == 0
    program = tmp_path / "prefix" / "lib" / "demo" / "short"
    label, command = run.lines
    assert label == "# /a (arm)"
    assert command.endswith(f"{program} --ros-args -r __node:=a -r __ns:=/")
    pasted = subprocess.run(["bash", "-c", command], capture_output=True, text=True, check=False)
    assert (pasted.returncode, pasted.stdout) == (0, "done\n")


@needs("bash", "env")
def test_printed_command_runs_a_package_from_its_sources(start: Start, tmp_path: Path) -> None:
    """The environment set by --package-path is part of the command."""
    package = tmp_path / "given" / "talk" / "talk"
    package.mkdir(parents=True)
    (package.parent / "setup.py").write_text("entry_points = ['speaker = talk.speaker:main']\n")
    (package / "__init__.py").write_text("")
    (package / "speaker.py").write_text("def main():\n    print('spoken')\n")
    given = str(tmp_path / "given")
    run = start(
        "node a : speaker", "--dry-run", "--package-path", given, nodes="node speaker : talk"
    )
    assert run.end() == 0
    command = ["env", "-i", "bash", "-c", run.lines[1]]
    pasted = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (pasted.returncode, pasted.stdout) == (0, "spoken\n"), pasted.stderr


def test_nodes_are_selected_by_name_pattern_and_subsystem(start: Start) -> None:
    """--only and --except accept names, full names, patterns and subsystems with their contents."""
    members = """
        subsystem base {
          subsystem wheels namespace /wheels { node left : short node right : short }
        }
        node eye : short
    """

    def shown(*arguments: str) -> list[str]:
        run = start(members, "--dry-run", *arguments)
        assert run.end() == 0
        return [line.split()[1] for line in run.lines if line.startswith("#")]

    assert shown("--only", "eye") == ["/eye"]
    assert shown("--only", "/wheels/left", "--only", "eye") == ["/wheels/left", "/eye"]
    assert shown("--only", "base", "--except", "*/left") == ["/wheels/right"]
    assert shown("--except", "base/wheels") == ["/eye"]


def test_unknown_selected_node_is_a_usage_error(start: Start) -> None:
    """The message lists the existing nodes."""
    run = start("node eye : short", "--only", "ear")
    assert run.end() == 2
    assert "no node is called 'ear'; there are: /eye" in run.lines[-1]


def test_program_that_cannot_be_run_is_a_failure(start: Start, tmp_path: Path) -> None:
    """An invalid interpreter line ends the system with 1 and a message."""
    run_later = tmp_path / "prefix" / "lib" / "demo" / "short"
    run_later.write_text("#!/no/such/interpreter\n")
    run = start("node a : steady node b : short")
    assert run.end() == 1
    assert any(line.startswith("[Robot] b cannot be started: ") for line in run.lines)
    assert "[Robot] a stopped" in run.lines


# Output -----------------------------------------------------------------------------------------


def test_each_line_has_the_name_of_its_node(start: Start) -> None:
    """An incomplete last line is prefixed too; equal names are distinguished."""
    run = start("node a : unfinished node b : short namespace /x node b : short namespace /y")
    assert run.end() == 0
    assert [line for line in run.lines if line.startswith("[a]")] == [
        "[a] one",
        "[a] two",
        "[a] three",
    ]
    assert {"[/x/b] done", "[/y/b] done"} <= set(run.lines)


def test_colours_are_used_only_on_a_terminal(start: Start, tmp_path: Path) -> None:
    """Prefixes are coloured on a terminal without NO_COLOR, and plain in a pipe."""
    script = make_script(tmp_path, "node a : short")
    env = {"PATH": os.environ["PATH"], "AMENT_PREFIX_PATH": str(tmp_path / "prefix")}
    command = [sys.executable, "-IS", str(script)]
    assert b"\033[36m[a]\033[0m done" in _on_terminal(command, env)
    assert b"\r\n[a] done" in _on_terminal(command, {**env, "NO_COLOR": "1"})
    run = start("node a : short")
    run.end()
    assert "[a] done" in run.lines


def _on_terminal(command: list[str], env: dict[str, str]) -> bytes:
    pid, terminal = os.forkpty()
    if pid == 0:
        os.execvpe(command[0], command, env)
    text = b""
    try:
        while data := os.read(terminal, 4096):
            text += data
    except OSError:  # how Linux reports the end of a terminal
        pass
    os.waitpid(pid, 0)
    os.close(terminal)
    return text


def test_blocked_reader_does_not_prevent_the_stop(start: Start) -> None:
    """With a full pipe and no reader, SIGTERM still ends nodes and script."""
    run = start("node a : noisy", "--stop-timeout", "0.2")
    run.until("[a] x")
    (pid,) = run.started().values()
    run.signal(signal.SIGTERM)
    assert await_end(pid)
    assert await_end(run.process.pid)


def test_slow_reader_loses_no_line(start: Start, tmp_path: Path) -> None:
    """When the buffer of the script is full, the nodes wait until the reader continues."""
    mark = tmp_path / "mark"
    os.mkfifo(mark)
    run = start("node a : verbose", MARK=str(mark))
    mark.open().close()  # returns when the node has written more than a megabyte
    assert run.end() == 0
    numbers = [int(line[4:9]) for line in run.lines if line.startswith("[a] ")]
    assert numbers == list(range(40_000))


def test_closed_reader_ends_the_system(start: Start) -> None:
    """As in ``script | head``: nobody sees the output any more, so the nodes are stopped."""
    run = start("node a : noisy", "--stop-timeout", "0.2")
    run.until("[a] x")
    assert run.process.stdout is not None
    run.process.stdout.close()
    assert await_end(run.process.pid)
    assert await_end(run.started()["a"])


# Stopping ---------------------------------------------------------------------------------------


STOPPED = [(signal.SIGINT, INTERRUPTED), (signal.SIGTERM, 0), (signal.SIGHUP, 0)]


@pytest.mark.parametrize(("number", "code"), STOPPED)
def test_signal_stops_all_nodes_in_order(start: Start, number: signal.Signals, code: int) -> None:
    """Ctrl-C, SIGTERM and a closed terminal lead to an orderly stop, which is not a failure."""
    run = start("node a : steady node b : steady")
    run.until("[a] ready", "[b] ready")
    run.signal(number)
    assert run.end() == code
    assert f"[Robot] stopping: received {number.name}" in run.lines
    assert {"[a] got SIGINT", "[Robot] a stopped", "[b] got SIGINT", "[Robot] b stopped"} <= set(
        run.lines
    )


def test_node_that_ends_on_sigterm_has_not_failed(start: Start) -> None:
    """SIGTERM follows SIGINT, and ending on it is still orderly."""
    run = start("node a : slow", "--stop-timeout", "1")
    run.until("[a] ready")
    run.signal(signal.SIGINT)
    assert run.end() == INTERRUPTED
    assert run.lines[-3:] == [
        "[Robot] a is still running, sending SIGTERM",
        "[a] got SIGTERM",
        "[Robot] a stopped",
    ]


def test_node_that_ignores_signals_is_killed_with_code_1(start: Start) -> None:
    """The order is SIGINT, SIGTERM, SIGKILL; having to kill is a failure of that node only."""
    run = start("node a : stubborn node b : steady", "--stop-timeout", "1")
    run.until("[a] ready", "[b] ready")
    before = time.monotonic()
    run.signal(signal.SIGINT)
    assert run.end() == 1
    assert time.monotonic() - before > 1.9
    of_a = [line for line in run.lines if "[a]" in line or "] a " in line]
    assert of_a[2:] == [
        "[a] got SIGINT",
        "[Robot] a is still running, sending SIGTERM",
        "[a] got SIGTERM",
        "[Robot] a is still running, sending SIGKILL",
        "[Robot] a was killed by SIGKILL",
    ]
    assert "[Robot] b stopped" in run.lines


def test_node_interrupted_during_its_start_has_not_failed(start: Start) -> None:
    """In some imports Python turns a SIGINT into code 1, which is harmless."""
    run = start("node a : starting node b : steady")
    run.until("[a] ready", "[b] ready")
    run.signal(signal.SIGINT)
    assert run.end() == INTERRUPTED
    assert {"[a] got SIGINT in an import", "[Robot] a stopped"} <= set(run.lines)


def test_node_that_starts_is_told_to_stop_when_it_is_up(start: Start, tmp_path: Path) -> None:
    """While it imports, SIGINT would be an exception in the middle of that."""
    mark = tmp_path / "mark"
    os.mkfifo(mark)
    run = start("node a : importing", MARK=str(mark))
    run.until("[a] ready")
    run.signal(signal.SIGINT)
    run.until("[Robot] stopping: received SIGINT")
    mark.open("w").close()
    assert run.end() == INTERRUPTED
    assert run.lines[-3:] == ["[a] up", "[a] got SIGINT", "[Robot] a stopped"]


def test_second_interrupt_does_not_wait_for_a_start(start: Start, tmp_path: Path) -> None:
    """Who is in a hurry gets a traceback rather than a delay."""
    mark = tmp_path / "mark"
    os.mkfifo(mark)
    run = start("node a : importing", "--stop-timeout", "1000", MARK=str(mark))
    run.until("[a] ready")
    run.signal(signal.SIGINT)
    run.until("[Robot] stopping: received SIGINT")
    run.signal(signal.SIGINT)
    assert run.end() == INTERRUPTED
    assert "[a] KeyboardInterrupt" in run.lines


def test_running_node_that_fails_on_sigint_has_failed(start: Start) -> None:
    """Its own shutdown was not successful."""
    run = start("node a : untidy")
    run.until("[a] ready")
    run.signal(signal.SIGINT)
    assert run.end() == 1
    assert "[Robot] a exited with code 1" in run.lines


IN_SITE = """\
import os, signal, time
os.write(1, b"in site\\n")
time.sleep(60)
"""


def test_interrupt_during_the_start_of_python_is_not_a_failure(
    start: Start, tmp_path: Path
) -> None:
    """Before the program runs, SIGINT is a fatal error of the interpreter."""
    (tmp_path / "sitecustomize.py").write_text(IN_SITE)
    program = tmp_path / "prefix" / "lib" / "demo" / "short"
    program.write_text(f"#!{sys.executable}\nprint('done')\n")
    run = start("node a : short", PYTHONPATH=str(tmp_path))
    run.until("[a] in site")
    run.signal(signal.SIGINT)
    assert run.end() == INTERRUPTED
    assert "Fatal Python error: init_import_site" in "\n".join(run.lines)


INTERRUPTING = """\
import os, runpy, signal, sys
real = signal.{function}
def interrupted(*arguments, **options):
    signal.{function} = real
    if "{moment}" == "before":
        os.kill(os.getpid(), signal.SIGINT)
    result = real(*arguments, **options)
    if "{moment}" == "after":
        os.kill(os.getpid(), signal.SIGINT)
    return result
signal.{function} = interrupted
sys.argv = sys.argv[1:]
runpy.run_path(sys.argv[0], run_name="__main__")
"""


@pytest.mark.parametrize("function", ["signal", "set_wakeup_fd"])
@pytest.mark.parametrize("moment", ["before", "after"])
def test_early_signal_is_not_lost(tmp_path: Path, function: str, moment: str) -> None:
    """A signal before the first node prevents the start, or stops all nodes at once."""
    prefix = make_prefix(tmp_path / "prefix")
    (tmp_path / "models").mkdir()
    script = make_script(tmp_path / "models", "node a : steady")
    text = INTERRUPTING.format(function=function, moment=moment)
    env = {"PATH": os.environ["PATH"], "AMENT_PREFIX_PATH": str(prefix)}
    run = Run([sys.executable, "-IS", "-c", text, script], env)
    try:
        run.end()
        assert "[a] ready" not in run.lines or "[a] got SIGINT" in run.lines
    finally:
        run.close()


CHILD_SIGNALLED = """\
import os, runpy, signal, sys
real, script = os.write, os.getpid()
def write(*arguments):
    if os.getpid() != script:
        os.kill(os.getpid(), signal.SIGINT)
    return real(*arguments)
os.write = write
sys.argv = sys.argv[1:]
runpy.run_path(sys.argv[0], run_name="__main__")
"""


def test_signal_to_a_starting_child_is_not_handled_by_the_script(tmp_path: Path) -> None:
    """Ctrl-C in a terminal reaches both: counted twice, SIGTERM would follow at once."""
    prefix = make_prefix(tmp_path / "prefix")
    (tmp_path / "models").mkdir()
    script = make_script(tmp_path / "models", "node a : steady")
    env = {"PATH": os.environ["PATH"], "AMENT_PREFIX_PATH": str(prefix)}
    run = Run([sys.executable, "-IS", "-c", CHILD_SIGNALLED, script], env)
    try:
        assert run.end() == 1
        assert "[Robot] a was killed by SIGINT" in run.lines
        assert "[Robot] stopping: received SIGINT" not in run.lines
    finally:
        run.close()


def test_second_signal_shortens_the_stop(start: Start) -> None:
    """Each further Ctrl-C sends the next signal at once, whatever the timeout."""
    run = start("node a : stubborn", "--stop-timeout", "1000")
    run.until("[a] ready")
    run.signal(signal.SIGINT)
    run.until("[a] got SIGINT")
    run.signal(signal.SIGINT)
    run.until("[a] got SIGTERM")
    run.signal(signal.SIGINT)
    assert run.end() == 1


def test_failed_node_stops_the_others(start: Start) -> None:
    """A node that exits with 3 stops the system, which exits with 1."""
    run = start("node a : steady node b : failing")
    assert run.end() == 1
    assert "[Robot] b exited with code 3" in run.lines
    assert "[Robot] stopping: b has failed" in run.lines
    assert "[Robot] a stopped" in run.lines


def test_crash_is_named_by_its_signal(start: Start) -> None:
    """A node that dies of SIGSEGV has failed."""
    run = start("node a : crashing")
    assert run.end() == 1
    assert "[Robot] a was killed by SIGSEGV" in run.lines


def test_keep_going_continues_after_a_failure(start: Start) -> None:
    """The other nodes run until they are stopped; the exit code still shows the failure."""
    run = start("node a : steady node b : failing", "--keep-going")
    run.until("[a] ready", "[Robot] b exited with code 3")
    run.signal(signal.SIGINT)
    assert run.end() == 1
    assert "[Robot] stopping: received SIGINT" in run.lines


def test_system_ends_with_0_when_all_nodes_have_ended(start: Start) -> None:
    """A node that ends without failure stops no other."""
    run = start("node a : short node b : short")
    assert run.end() == 0
    assert {"[Robot] a ended", "[Robot] b ended"} <= set(run.lines)


def test_node_ends_with_its_whole_process_group(start: Start) -> None:
    """Children of a wrapper are awaited, get the next signal, and count as the node."""
    run = start("node a : family", "--stop-timeout", "1000")
    run.until("[a] child ")
    run.signal(signal.SIGINT)
    assert await_end(run.started()["a"])
    run.until("stopping")
    run.signal(signal.SIGINT)
    assert run.end() == INTERRUPTED
    assert run.lines[-2:] == ["[a] child got SIGTERM", "[Robot] a stopped"]


def test_children_of_an_ended_node_are_stopped(start: Start) -> None:
    """They end before the node counts as ended."""
    run = start("node a : leaving node b : steady", "--stop-timeout", "1000")
    run.until("[a] left behind", "[a] child got SIGINT", "[Robot] a ended", "[b] ready")
    run.signal(signal.SIGINT)
    assert run.end() == INTERRUPTED


def test_daemon_is_independent(start: Start) -> None:
    """A process outside the node's session is not awaited, and no output is lost."""
    run = start("node a : daemon", "--stop-timeout", "1000")
    assert run.process.wait(LIMIT) == 0
    run.until("[a] unfinished\n[Robot] a ended")
    os.kill(int(run.lines[1].removeprefix("[a] daemon ")), signal.SIGTERM)


def test_what_cannot_be_killed_is_left_behind(start: Start) -> None:
    """After the last signal nobody waits for it; the script says so, and fails."""
    run = start("node a : unburied node b : steady", "--stop-timeout", "0.1")
    run.until("[a] careless ", "[b] ready")
    assert run.end() == 1
    group = run.started()["a"]
    assert [line for line in run.lines if line.startswith("[Robot] a ")][1:] == [
        "[Robot] a is still running, sending SIGTERM",
        "[Robot] a is still running, sending SIGKILL",
        f"[Robot] a cannot be killed, process {group} is left behind",
    ]
    assert run.lines[-4:] == [
        f"[Robot] a cannot be killed, process {group} is left behind",
        "[Robot] stopping: a has failed",
        "[b] got SIGINT",
        "[Robot] b stopped",
    ]
    end_careless(run.lines)


@pytest.mark.parametrize("program", ["steady", "stubborn", "family"])
def test_nodes_end_when_the_script_is_killed(start: Start, program: str) -> None:
    """After SIGKILL of the script no node, stubborn node or grandchild remains."""
    run = start(f"node a : {program}", "--stop-timeout", "0.1")
    run.until("[a] child" if program == "family" else "[a] ready")
    pids = [run.started()["a"], *map(int, re.findall(r"child (\d+)", "\n".join(run.lines)))]
    guard = [int(pid) for pid in _children(run.process.pid) if int(pid) not in pids]
    run.signal(signal.SIGKILL)
    assert all(await_end(pid) for pid in pids)
    assert len(guard) == 1
    assert await_end(guard[0])


def test_other_nodes_stay_guarded_after_a_failed_start(start: Start, tmp_path: Path) -> None:
    """After a failed start and a restart, a kill still leaves no process behind."""
    (tmp_path / "prefix" / "lib" / "demo" / "short").write_text("#!/no/such/interpreter\n")
    arguments = ("--keep-going", "--stop-timeout", "0.1")
    run = start("node a : stubborn node b : short node c : stubborn respawn", *arguments)
    run.until("b cannot be started", "[a] ready", "[c] ready")
    os.kill(run.started()["c"], signal.SIGKILL)
    run.until("c was killed by SIGKILL; restart 1 in 0 s")
    run.until("[c] ready", times=2)
    run.signal(signal.SIGKILL)
    assert all(await_end(pid) for pid in run.started().values())


def test_nodes_are_signalled_if_guard_and_script_are_killed(start: Start) -> None:
    """The kernel signals the end of the script to the nodes."""
    run = start("node a : steady")
    run.until("[a] ready")
    guard = next(int(pid) for pid in _children(run.process.pid) if int(pid) != run.started()["a"])
    os.kill(guard, signal.SIGKILL)
    run.until("the guard is gone")
    run.signal(signal.SIGKILL)
    assert await_end(run.started()["a"])


def _children(pid: int) -> list[str]:
    return Path(f"/proc/{pid}/task/{pid}/children").read_text().split()


# Restarting -------------------------------------------------------------------------------------


def test_node_is_restarted_as_often_as_respawn_allows(start: Start) -> None:
    """With max 2 it runs three times; then its failure is that of the system."""
    run = start("node a : failing respawn max 2 node b : steady")
    assert run.end() == 1
    assert run.lines.count("[a] giving up") == 3
    assert "[Robot] a exited with code 3; restart 1 of 2 in 0 s" in run.lines
    assert "[Robot] a exited with code 3; restart 2 of 2 in 0 s" in run.lines
    assert "[Robot] stopping: a has failed" in run.lines


def test_node_that_ends_normally_is_restarted(start: Start) -> None:
    """Respawn applies to any end, and the last end is not a failure."""
    run = start("node a : short respawn max 1")
    assert run.end() == 0
    assert run.lines.count("[a] done") == 2


def test_restart_waits_for_the_delay(start: Start, tmp_path: Path) -> None:
    """The other nodes are not affected."""
    program = tmp_path / "prefix" / "lib" / "demo" / "short"
    program.write_text(f"#!{sys.executable} -IS\nimport time; print('at', time.monotonic())\n")
    run = start("node a : short respawn delay 300 ms max 1 node b : steady")
    run.until("restart 1 of 1 in 0.3 s", "[Robot] a ended\n")
    first, second = (float(line[7:]) for line in run.lines if line.startswith("[a] at "))
    assert second - first >= 0.3
    run.until("[b] ready")
    run.signal(signal.SIGINT)
    assert run.end() == INTERRUPTED
    assert run.lines.count("[b] ready") == 1


def test_no_restart_while_the_system_stops(start: Start) -> None:
    """Neither a node that waits for its restart nor one that stops is started again."""
    run = start("node a : short respawn delay 1000 sec node b : steady respawn")
    run.until("restart 1 in 1000 s", "[b] ready")
    run.signal(signal.SIGINT)
    assert run.end() == INTERRUPTED
    assert run.lines.count("[a] done") == run.lines.count("[b] ready") == 1


def test_restarted_nodes_leave_no_zombies(start: Start) -> None:
    """Every ended process is reaped while the system runs."""
    run = start("node a : failing respawn max 5 node b : steady", "--keep-going")
    run.until("restart 5 of 5", "[b] ready")
    run.until("[a] giving up\n[Robot] a exited with code 3\n")
    states = [
        Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0]
        for pid in _children(run.process.pid)
    ]
    assert len(states) == 2  # node b and the guard
    assert "Z" not in states
