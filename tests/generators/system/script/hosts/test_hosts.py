"""A system on two hosts, started over ssh with a real server: start, failure, end."""

from __future__ import annotations

import inspect
import json
import os
import re
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from deros.generators.system.script.standalone.hosts.far import run_script
from deros.generators.system.script.standalone.supervisor import INTERRUPTED
from tests.support.lint import assert_lint_clean
from tests.support.needs import needs
from tests.support.processes import freeze, thaw
from tests.support.ssh_server import SshServer
from tests.support.stand_ins import Run, await_end, load_system, make_prefix, make_script

pytestmark = needs("ssh", "sshd", "ssh-keygen", "bash")

Start = Callable[..., Run]

HOSTS = """
host robot "robot.test" setup "{setup}"
host pc $pc_at setup "{setup}"
argument pc_at : string = "pc.test"
argument word : string = "plain"
"""
BOTH = "node eye : steady on robot node desk : steady on pc"
HERE = "127.0.0.1"


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[SshServer]:
    """Return a server that all hosts of the tests are on."""
    found = SshServer(tmp_path_factory.mktemp("sshd"))
    yield found
    found.close()


@pytest.fixture
def models(tmp_path: Path) -> Path:
    """Return a folder for models; the setup file of the hosts finds stand-ins, beside it."""
    make_prefix(tmp_path / "prefix")
    (tmp_path / "tmp").mkdir()
    lines = [f"export AMENT_PREFIX_PATH='{tmp_path}/prefix' TMPDIR='{tmp_path}/tmp'"]
    (tmp_path / "setup.bash").write_text("\n".join([*lines, "read -r eaten || true", ""]))
    (tmp_path / "models").mkdir()
    return tmp_path / "models"


@pytest.fixture
def start(server: SshServer, models: Path) -> Iterator[Start]:
    """Return a function that starts the script of a system on its hosts."""
    runs: list[Run] = []

    def start_script(members: str, *words: str, ssh: str | None = None, **env: str) -> Run:
        hosts = HOSTS.format(setup=models.parent / "setup.bash")
        text = members if "host robot" in members else hosts + members
        script = make_script(models, text)
        given = {"PATH": os.environ["PATH"], "HOME": str(models), **env}
        options = ["--ssh", "--ssh-command", ssh or server.command()]
        runs.append(Run([sys.executable, "-IS", script, *options, *words], given))
        return runs[-1]

    yield start_script
    for run in runs:
        run.close()
    assert not list((models.parent / "tmp").iterdir()), "something is left behind"


def pid_of(run: Run, host: str, label: str) -> int:
    """Return the process of a node on a host."""
    said = "\n".join(run.lines)
    found = re.search(rf"^\[{host}\] \[Robot\] {label} started, process (\d+)$", said, re.M)
    assert found is not None, said
    return int(found[1])


def client_of(run: Run, host: str) -> int:
    """Return the process of the client that reaches a host."""
    found = re.search(rf"{host} is prepared over ssh .* process (\d+)", "\n".join(run.lines))
    assert found is not None
    return int(found[1])


def parent_of(pid: int) -> int:
    """Return the process that has started another one."""
    return int(Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[1])


def both_up(run: Run) -> list[int]:
    """Wait until the nodes of both hosts are up; return their processes."""
    run.until("[robot] [eye] ready", "[pc] [desk] ready")
    return [pid_of(run, "robot", "eye"), pid_of(run, "pc", "desk")]


# Start and end ----------------------------------------------------------------------------------


def test_interrupt_here_stops_all_hosts(start: Start) -> None:
    """Each node gets SIGINT alone, where it runs; the exit code is that of a Ctrl-C."""
    run = start(BOTH)
    pids = both_up(run)
    run.signal(signal.SIGINT)
    assert run.end() == INTERRUPTED
    for line in ("[robot] [eye] got SIGINT", "[pc] [desk] got SIGINT"):
        assert line in run.lines
    assert all(await_end(pid, 0) for pid in pids)


def test_part_of_this_host_is_started_here(start: Start, models: Path) -> None:
    """No connection is made for it, and its environment is the one of whoever starts it."""
    prefix = str(models.parent / "prefix")
    run = start(BOTH, "host:=pc", AMENT_PREFIX_PATH=prefix, TMPDIR=str(models.parent / "tmp"))
    both_up(run)
    assert "[Robot] pc is prepared here" in "\n".join(run.lines)
    run.signal(signal.SIGTERM)
    assert run.end() == 0
    assert "[pc] [desk] got SIGINT" in run.lines


def test_second_interrupt_does_not_wait(start: Start) -> None:
    """It reaches a node on another host that ignores the first one, as SIGTERM."""
    run = start("node eye : stubborn on robot node desk : short on pc", "--stop-timeout", "60")
    run.until("[robot] [eye] ready", "[Robot] pc ended")
    pid = pid_of(run, "robot", "eye")
    for expected in ("[eye] got SIGINT", "[eye] got SIGTERM"):
        run.signal(signal.SIGINT)
        run.until(expected)
    os.kill(pid, signal.SIGKILL)
    assert run.end() == 1


def test_stubborn_node_is_killed_where_it_runs(start: Start) -> None:
    """The times of one signal after another count there, and the starter waits for them."""
    run = start("node eye : stubborn on robot", "--stop-timeout", "0.2")
    run.until("[robot] [eye] ready")
    pid = pid_of(run, "robot", "eye")
    run.signal(signal.SIGINT)
    assert run.end() == 1
    assert "[robot] [Robot] eye is still running, sending SIGKILL" in run.lines
    assert await_end(pid, 0)


def test_exit_that_stops_all_stops_all_hosts(start: Start) -> None:
    """`on exit stop all` on one host ends the others, well."""
    run = start("node eye : steady on robot node desk : short on pc on exit stop all delay 1 sec")
    run.until("[pc] [desk] done")
    assert run.end() == 0
    assert "[robot] [Robot] eye stopped" in run.lines


def test_arguments_reach_each_host_as_they_are(start: Start) -> None:
    """Whatever a shell would make of them."""
    word = ' \'"$HOME" `x` \\ ! ~ * \n;& é'
    members = "node a : arguments on robot arguments [$word] node b : arguments on pc"
    run = start(members, f"word:={word}")
    assert run.end() == 0
    line = next(line for line in run.lines if line.startswith("[robot] [a] "))
    assert json.loads(line.removeprefix("[robot] [a] "))[0] == word


def test_address_is_looked_up_here_and_all_else_there(start: Start, models: Path) -> None:
    """What a package of the host has is no matter of the computer that starts it."""
    (models.parent / "prefix" / "share" / "demo").mkdir(parents=True)
    hosts = """
        host robot $at setup "SETUP"
        argument at : string = env("ROBOT_AT")
        argument map : string = "${share(demo)}/depot.yaml"
    """
    members = hosts.replace("SETUP", str(models.parent / "setup.bash"))
    members += "node eye : arguments on robot arguments [$map]"
    run = start(members, ROBOT_AT="robot.test")
    assert run.end() == 0, run.lines
    assert "over ssh to robot.test" in run.lines[0]
    (line,) = (line for line in run.lines if line.startswith("[robot] [eye] "))
    assert f'"{models.parent}/prefix/share/demo/depot.yaml"' in line
    refused(start(members), "a host needs the argument 'at', which is not known here")


def test_parameter_files_go_along(start: Start, models: Path) -> None:
    """They are in a folder of the host while the system runs, and nowhere afterwards."""
    (models / "rates.yaml").write_text("/**:\n  ros__parameters: {rate: 7}\n")
    (models / "reader.rnd").write_text(
        'node reader : demo executable "arguments" parameters name rate : int = 1'
    )
    process = 'process shown : "cat" arguments ["/proc/self/cmdline"] on robot'
    run = start(f'node eye : reader on robot parameters from "rates.yaml" {process}')
    assert run.end() == 0
    line = next(line for line in run.lines if line.startswith("[robot] [eye] "))
    words = json.loads(line.removeprefix("[robot] [eye] "))
    file = Path(words[words.index("--params-file") + 1])
    assert file.name == "rates.yaml"
    assert file.is_relative_to(models.parent / "tmp")
    assert not file.exists()


def test_choice_of_nodes_is_among_all_hosts(start: Start) -> None:
    """A host without any of them has nothing to do; a name that is nowhere starts nothing."""
    run = start(BOTH, "--only", "desk")
    run.until("[pc] [desk] ready")
    run.signal(signal.SIGINT)
    assert run.end() == INTERRUPTED
    assert not any("eye" in line for line in run.lines)
    unknown = start(BOTH, "--only", "nose")
    assert unknown.end() == 2
    assert "[Robot] no node is called 'nose' on any of the hosts" in unknown.lines


def test_dry_run_prints_the_commands_of_each_host(start: Start) -> None:
    """And starts nothing."""
    run = start(BOTH, "--dry-run")
    assert run.end() == 0
    commands = [line for line in run.lines if "/lib/demo/steady" in line]
    assert {line.partition("]")[0] for line in commands} == {"[robot", "[pc"}
    assert not any("ready" in line for line in run.lines)


def test_log_files_are_written_here(start: Start, tmp_path: Path) -> None:
    """One for each host, and one of all."""
    run = start("node a : short on robot node b : short on pc", "--log-dir", str(tmp_path / "log"))
    assert run.end() == 0
    assert "[a] done" in (tmp_path / "log" / "robot.log").read_text()
    assert "[robot] [a] done" in (tmp_path / "log" / "Robot-all.log").read_text()


# What is lost -----------------------------------------------------------------------------------


def test_nodes_end_when_the_starter_is_killed(start: Start) -> None:
    """The end of the connection tells them."""
    run = start(BOTH)
    pids = both_up(run)
    parts = list(map(parent_of, pids))
    run.signal(signal.SIGKILL)
    assert all(map(await_end, [*pids, *parts]))


@pytest.mark.parametrize("which", ["client", "server"])
def test_lost_connection_stops_nodes_at_both_ends(start: Start, which: str) -> None:
    """The host that is cut off stops its own nodes in order; the others are stopped from here."""
    run = start(BOTH)
    eye, desk = both_up(run)
    session = parent_of(parent_of(eye))
    assert Path(f"/proc/{session}/comm").read_text().strip().startswith("sshd")
    os.kill(client_of(run, "robot") if which == "client" else session, signal.SIGKILL)
    assert run.end() == 1
    assert any(line.startswith("[Robot] robot ") for line in run.lines)
    assert "[pc] [desk] got SIGINT" in run.lines
    assert await_end(eye)
    assert await_end(desk)


def test_silent_connection_counts_as_lost(start: Start) -> None:
    """A network that swallows everything closes nothing: the nodes there end all the same."""
    run = start(BOTH, "--ssh-timeout", "1")
    eye, desk = both_up(run)
    client = client_of(run, "robot")
    freeze(client)
    assert await_end(eye)
    assert not await_end(desk, 0)
    thaw(client)
    assert run.end() == 1


def test_live_connection_outlasts_the_timeout(start: Start) -> None:
    """Something goes through it again and again, though nobody says anything."""
    slow = "node eye : steady on robot node desk : short on pc delay 3 sec"
    run = start(slow, "--ssh-timeout", "1")
    run.until("[Robot] pc ended")
    run.signal(signal.SIGINT)
    assert run.end() == INTERRUPTED
    assert "[robot] [eye] got SIGINT" in run.lines


def test_failure_on_one_host_stops_the_others(start: Start) -> None:
    """With the exit code of a failed node; with --keep-going they run on."""
    members = "node eye : steady on robot node desk : failing on pc delay 1 sec"
    run = start(members)
    assert run.end() == 1
    assert "[robot] [eye] got SIGINT" in run.lines
    going = start(members, "--keep-going")
    going.until("[Robot] pc exited with code 1", "[robot] [eye] ready")
    going.signal(signal.SIGINT)
    assert going.end() == 1
    assert "[robot] [eye] got SIGINT" in going.lines


# What is refused before anything starts ---------------------------------------------------------


def refused(run: Run, *said: str) -> None:
    """Expect that nothing was started on any host, and why."""
    assert run.end() == 2
    text = "\n".join(run.lines)
    for each in said:
        assert each in text
    assert not any("ready" in line for line in run.lines)
    assert "Traceback" not in text


def test_host_that_is_off_starts_nothing(start: Start, server: SshServer) -> None:
    """Its name and what to look at stand in one line; the other host has not begun."""
    one = '\nhost robot "r" setup ""\nhost pc $pc_at setup ""\nargument pc_at : string = "p"\n'
    refused(start(one + BOTH, ssh=server.command(port=1)), "robot (r) cannot be reached", "refused")


def test_stranger_is_refused_without_a_question(start: Start, server: SshServer) -> None:
    """A key that the host does not know, and a host whose key is not known."""
    refused(
        start(BOTH, ssh=server.command("stranger")), "Permission denied", "ssh-copy-id robot.test"
    )
    refused(
        start(BOTH, ssh=server.command(is_known=False)),
        "pc (pc.test) cannot be reached: Host key verification failed; connect once by hand",
    )


def test_host_without_packages_says_so(start: Start) -> None:
    """And that nothing has set up ROS there."""
    bare = '\nhost robot "robot.test"\nhost pc "pc.test"\n'
    refused(
        start(bare + BOTH),
        "[robot]   /eye: package 'demo' has no program 'steady'",
        "[pc] No setup file of ROS 2 has been sourced here",
        "nothing can be started on robot, for the reason above",
    )


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (None, "there is no setup file"),
        ("false", "the setup file"),
        ("export PATH=/nowhere", "does not find python3: install it there"),
        ("exit 0", "is prepared"),
    ],
)
def test_setup_file_that_does_not_set_up(
    start: Start, models: Path, text: str | None, said: str
) -> None:
    """It is missing, fails, hides Python, or ends the shell."""
    file = models.parent / "odd.bash"
    if text is not None:
        file.write_text(text + "\n")
    hosts = HOSTS.format(setup=file)
    refused(start(hosts + BOTH), said)


def test_wrong_arguments_reach_no_host(start: Start) -> None:
    """Values, names, hosts and addresses are read here first."""
    for words, said in (
        (["words:=x"], "no argument 'words'"),
        (["host:=mars"], "host"),
        (["host:=all"], "starts everything here"),
        (["pc_at:=-oProxyCommand=touch x"], "is none for ssh"),
        (["pc_at:=a b"], "is none for ssh"),
        (["--table"], "--table"),
        (["--ssh-timeout=0"], "positive"),
    ):
        run = start(BOTH, *words)
        refused(run, said)
        assert len(run.lines) == 1, run.lines
    run = start(BOTH, ssh="no-such-ssh -F x")
    refused(run, "no program 'no-such-ssh'")


# The script, and deros up -----------------------------------------------------------------------


def test_deros_up_starts_the_hosts_too(server: SshServer, models: Path) -> None:
    """What runs there needs nothing of deros."""
    hosts = HOSTS.format(setup=models.parent / "setup.bash")
    load_system(models, hosts + BOTH)
    deros = Path(sys.executable).with_name("deros")
    options = ["--ssh", "--ssh-command", server.command(), "--stop-timeout", "3"]
    run = Run([deros, "up", models / "robot.system", *options])
    try:
        both_up(run)
        run.signal(signal.SIGINT)
        assert run.end() == INTERRUPTED
        assert "[robot] [eye] got SIGINT" in run.lines
    finally:
        run.close()


def test_deros_up_without_hosts_refuses(models: Path) -> None:
    """There is nothing to reach."""
    load_system(models, "node eye : steady")
    deros = Path(sys.executable).with_name("deros")
    command = [str(deros), "up", str(models / "robot.system"), "--ssh"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert "declares none" in done.stderr


def test_script_of_hosts_passes_the_ament_linters(models: Path, tmp_path: Path) -> None:
    """As any other; no line of what goes to other hosts is longer either."""
    script = make_script(models, HOSTS.format(setup="/x y") + BOTH)
    (tmp_path / "linted").mkdir()
    (tmp_path / "linted" / "robot.py").write_text(script.read_text())
    assert_lint_clean(tmp_path / "linted")


def test_old_python_is_named(tmp_path: Path) -> None:
    """The function that goes over the connection is text, which asks for the version first."""
    text = inspect.getsource(run_script)
    code = f"import sys\nsys.version_info = (3, 8, 0)\n{text}\nrun_script(1)"
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=False, cwd=tmp_path
    )
    assert done.returncode == 1
    assert "is Python 3.8, and 3.10 is needed" in done.stderr
