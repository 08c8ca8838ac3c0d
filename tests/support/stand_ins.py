"""Stand-ins for nodes: small programs in a temporary prefix, for what is between them and Linux."""

from __future__ import annotations

import os
import re
import select
import signal
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

from deros.generators.builtin import rossystem_script
from deros.metamodels.load import Repository
from deros.models.system import System
from tests.support.systems import CONTEXT

LIMIT = 30.0
"""Seconds after which an awaited event is taken not to come."""

_SAY = """\
import os, signal, sys

def say(text):
    os.write(1, text.encode() + b"\\n")

def wait_for(*numbers):
    return signal.sigwait(numbers)

ALL = {signal.SIGINT, signal.SIGTERM}
signal.alarm(120)  # whatever a failing test forgets ends by itself
signal.pthread_sigmask(signal.SIG_BLOCK, ALL)
"""

PROGRAMS = {
    "steady": 'say("ready"); say("got " + signal.Signals(wait_for(*ALL)).name)',
    "slow": 'say("ready"); wait_for(signal.SIGTERM); say("got SIGTERM")',
    "stubborn": 'say("ready")\nwhile True: say("got " + signal.Signals(wait_for(*ALL)).name)',
    "failing": 'say("giving up"); sys.exit(3)',
    "short": 'say("done")',
    "arguments": "import json; say(json.dumps(sys.argv[1:]))",
    "environment": "import json; say(json.dumps(dict(os.environ)))",
    "unfinished": 'os.write(1, b"one\\ntwo\\nthree")',
    "noisy": 'say("ready")\nwhile True: os.write(1, b"x" * 999 + b"\\n")',
    # Puts a child into a session of its own, which keeps the output open, and ends.
    "daemon": """\
read, write = os.pipe()
if os.fork():
    os.read(read, 1); os.write(1, b"unfinished"); os._exit(0)
os.setsid(); signal.alarm(120); say(f"daemon {os.getpid()}")
os.write(write, b"x"); wait_for(signal.SIGTERM)""",
    # Four megabytes in numbered lines; after the first one it opens the FIFO that MARK names.
    "verbose": """\
for number in range(40_000):
    os.write(1, b"%5d %s\\n" % (number, b"x" * 93))
    if number == 11_000:
        open(os.environ["MARK"], "w").close()""",
    # Stays in its group though it is dead: who should ask for its end has left, and does not.
    "unburied": """\
read, write = os.pipe()
if os.fork():
    os.read(read, 1); os._exit(0)
dead = os.fork()
if not dead:
    os._exit(0)
os.waitid(os.P_PID, dead, os.WEXITED | os.WNOWAIT)
os.setsid(); signal.alarm(120); say(f"careless {os.getpid()}")
os.write(write, b"x"); wait_for(signal.SIGTERM)""",
    "crashing": "signal.pthread_sigmask(signal.SIG_UNBLOCK, ALL); os.kill(os.getpid(), 11)",
    # Python that is still starting: SIGINT may come in the middle of any import.
    "starting": """\
def fail(*_):
    say("got SIGINT in an import"); os._exit(1)
signal.signal(signal.SIGINT, fail); signal.pthread_sigmask(signal.SIG_UNBLOCK, ALL)
say("ready"); signal.pause()""",
    # The same, until it is up: when the FIFO that MARK names is opened.
    "importing": """\
signal.signal(signal.SIGINT, signal.default_int_handler)
signal.pthread_sigmask(signal.SIG_UNBLOCK, ALL); say("ready")
open(os.environ["MARK"]).close()
signal.pthread_sigmask(signal.SIG_BLOCK, ALL)
signal.signal(signal.SIGTERM, signal.default_int_handler); say("up")
say("got " + signal.Signals(wait_for(*ALL)).name)""",
    # The same failure, of a node that is up: it handles SIGTERM, too.
    "untidy": """\
for number in ALL:
    signal.signal(number, lambda *_: os._exit(1))
signal.pthread_sigmask(signal.SIG_UNBLOCK, ALL); say("ready"); signal.pause()""",
    # A wrapper that ends at once on SIGINT, while what it started takes its time.
    "family": """\
if os.fork():
    wait_for(signal.SIGINT); os._exit(0)
signal.alarm(120)
say(f"child {os.getpid()}")
wait_for(signal.SIGTERM); say("child got SIGTERM")""",
    # The same, but the wrapper ends by itself.
    "leaving": """\
if os.fork():
    os._exit(0)
signal.alarm(120)
say("left behind"); wait_for(signal.SIGINT); say("child got SIGINT")""",
}
"""Name and code of each program; the code has ``say`` and ``wait_for``, and holds back signals."""


def make_prefix(
    prefix: Path, package: str = "demo", names: Sequence[str] = tuple(PROGRAMS)
) -> Path:
    """Install the programs as ``<prefix>/lib/<package>/<name>`` and return ``prefix``."""
    folder = prefix / "lib" / package
    folder.mkdir(parents=True)
    for name in names:
        program = folder / name
        program.write_text(f"#!{sys.executable} -IS\n{_SAY}{PROGRAMS[name]}\n")
        program.chmod(0o755)
    return prefix


def load_system(folder: Path, members: str, nodes: str = "") -> System:
    """Load a system of ``members``, whose node types are the programs and those of ``nodes``."""
    for name in PROGRAMS:
        (folder / f"{name}.rnd").write_text(f"node {name} : demo")
    for text in filter(None, nodes.split("---")):
        found = re.search(r"node (\w+)", text)
        assert found is not None
        (folder / f"{found[1]}.rnd").write_text(text)
    path = folder / "robot.system"
    path.write_text(f'system Robot\nimports\n  import "*.rnd"\n{members}\n')
    repository = Repository()
    loaded = repository.load(path)
    assert not repository.diagnostics, repository.diagnostics
    assert isinstance(loaded.model, System)
    return loaded.model


def make_script(folder: Path, members: str, nodes: str = "") -> Path:
    """Generate the script of such a system."""
    files = rossystem_script(load_system(folder, members, nodes), CONTEXT)
    name, file = next(iter(files.items()))  # what it names is in the folder already
    script = folder / name
    script.write_text(file.text)
    return script


class Run:
    """A command under test: its output line by line as it comes, its signals, its end."""

    def __init__(self, command: Sequence[str | Path], env: dict[str, str] | None = None) -> None:
        """Start the command; end it with :meth:`close`."""
        self.process = subprocess.Popen(
            command, env=env, stdout=subprocess.PIPE, stderr=subprocess.STDOUT
        )
        assert self.process.stdout is not None
        self._pipe = self.process.stdout.fileno()
        self._text = ""

    @property
    def lines(self) -> list[str]:
        """What has been read so far."""
        return self._text.splitlines()

    def until(self, *texts: str, times: int = 1) -> None:
        """Read until each of the texts is there, so many times."""
        while not all(self._text.count(text) >= times for text in texts):
            assert self._read(), f"ended without {texts}:\n{self._text}"

    def signal(self, number: signal.Signals) -> None:
        """Send a signal to the process alone."""
        self.process.send_signal(number)

    def end(self) -> int:
        """Read to the end and return the exit code."""
        while self._read():
            pass
        return self.process.wait(LIMIT)

    def close(self) -> None:
        """Make sure that nothing of it is left."""
        if self.process.poll() is None:
            self.signal(signal.SIGTERM)
            try:
                self.end()
            except AssertionError:
                self.process.kill()
        assert self.process.stdout is not None
        self.process.stdout.close()
        self.process.wait(LIMIT)

    def started(self) -> dict[str, int]:
        """Return the process of each node that was started, by label."""
        return {
            label: int(pid)
            for label, pid in re.findall(r"\] (\S+) started, process (\d+)", self._text)
        }

    def _read(self) -> bool:
        assert select.select([self._pipe], [], [], LIMIT)[0], f"nothing more came:\n{self._text}"
        data = os.read(self._pipe, 1 << 16)
        self._text += data.decode()
        return bool(data)


def await_end(pid: int, limit: float = LIMIT) -> bool:
    """Wait until a process that need not be ours has ended; ``False`` when it has not in time."""
    try:
        handle = os.pidfd_open(pid)
    except ProcessLookupError:
        return True
    try:
        return bool(select.select([handle], [], [], limit)[0])
    finally:
        os.close(handle)


def end_careless(lines: Sequence[str]) -> None:
    """End the process that ``unburied`` has left, which its output names."""
    (found,) = {each for line in lines for each in re.findall(r"careless (\d+)$", line)}
    os.kill(int(found), signal.SIGTERM)
