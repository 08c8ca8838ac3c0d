"""``docs/howto/existing-robot.md`` is played word for word, on nodes that deros does not know."""

from __future__ import annotations

import contextlib
import functools
import re
import shlex
import signal
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import pytest

from tests.support import pages
from tests.support.pages import Block
from tests.support.ros import LIMIT, Peer

PAGE = "docs/howto/existing-robot.md"
_LASTING = ("python3 robot.py", "deros run")
"""What goes on in a terminal of its own."""


@dataclass
class Terminal:
    """A program that goes on, what it prints, and how much of that has been read."""

    process: subprocess.Popen[bytes]
    log: Path
    read: int = 0

    def has(self, pattern: re.Pattern[str]) -> bool:
        """Tell whether it has printed such a line since the last command; later ones follow it."""
        text = self.log.read_text(encoding="utf-8")
        found = pattern.search(text, self.read)
        if found is not None:
            self.read = found.end()
        return found is not None

    def interrupt(self) -> None:
        """Press Ctrl-C, and wait for the end."""
        self.process.send_signal(signal.SIGINT)
        self.process.wait(LIMIT)


@dataclass
class Reader:
    """Somebody who reads the page and does what it says.

    Attributes:
        peer: looks at the graph, so that a command waits for what the last one has started.
        commands: how many have been typed.
    """

    folder: Path
    env: dict[str, str]
    peer: Peer
    terminals: dict[str, Terminal] = field(default_factory=dict)
    commands: int = 0

    def console(self, text: str) -> None:
        """Type the commands of a block, and compare what they print."""
        parts = re.split(r"^\$ ", text, flags=re.MULTILINE)
        assert parts[0] == ""
        for part in parts[1:]:
            command, _, shown = part.partition("\n")
            if shown == "^C\n":
                self._end(command)
            elif command.startswith(_LASTING):
                self.commands += 1
                self._start(command)
            else:
                self.commands += 1
                printed = self._run(command)
                assert _matches(shown, printed), f"{command}\n{printed}"

    def _run(self, command: str) -> str:
        run = subprocess.run(
            self._words(command),
            cwd=self.folder,
            env=self.env,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            timeout=2 * LIMIT,
            check=False,
        )
        assert run.returncode == (1 if command == "deros state" else 0), run.stdout
        return run.stdout

    def _words(self, command: str) -> list[str]:
        program, *words = shlex.split(command)
        found = {"python3": sys.executable, "deros": Path(sys.executable).with_name("deros")}
        return [str(found[program]), *words]

    def _start(self, command: str) -> None:
        log = self.folder.parent / f"terminal{self.commands}.log"
        with log.open("wb") as output:
            process = subprocess.Popen(
                self._words(command),
                cwd=self.folder,
                env={**self.env, "PYTHONUNBUFFERED": "1"},
                stdout=output,
                stderr=subprocess.STDOUT,
            )
        self.terminals[command] = Terminal(process, log)
        if command.startswith(_LASTING[0]):
            name = command.split()[2]
            self.peer.until(lambda: name in self.peer.node.get_node_names())

    def _end(self, command: str) -> None:
        for each in self.terminals.values():
            each.read = each.log.stat().st_size
        self.terminals.pop(command).interrupt()
        if command.startswith(_LASTING[0]):
            name = command.split()[2]
            self.peer.until(lambda: name not in self.peer.node.get_node_names())

    def text(self, text: str) -> None:
        """Wait until the terminals show the lines of a block."""
        for line in text.splitlines():
            shown = functools.partial(self._show, re.compile(_pattern(line)))
            self.peer.until(shown)

    def _show(self, pattern: re.Pattern[str]) -> bool:
        return any(each.has(pattern) for each in self.terminals.values())

    def close(self) -> None:
        """End what goes on."""
        for each in self.terminals.values():
            each.process.send_signal(signal.SIGINT)
        for command, each in self.terminals.items():
            try:
                each.process.wait(LIMIT)
            except subprocess.TimeoutExpired:
                each.process.kill()
                each.process.wait()
            print(f"--- {command}\n{each.log.read_text(encoding='utf-8')}")


def _pattern(text: str) -> str:
    return re.escape(text).replace("…", ".*")


def _matches(shown: str, printed: str) -> bool:
    """Compare line by line, without spaces at the ends of lines; ``…`` stands for anything."""
    lines = [line.rstrip() for line in printed.splitlines()]
    expected = [re.sub(r" +", " ", line) for line in shown.splitlines()]
    found = [re.sub(r" +", " ", line) for line in lines]
    return len(found) == len(expected) and all(
        re.fullmatch(_pattern(one), other) for one, other in zip(expected, found, strict=True)
    )


@pytest.fixture
def reader(tmp_path: Path, ros_env: dict[str, str]) -> Iterator[Reader]:
    """Return somebody in an empty folder, in a domain of their own."""
    folder = tmp_path / "robot"
    folder.mkdir()
    with contextlib.closing(Peer(int(ros_env["ROS_DOMAIN_ID"]), "_reader")) as peer:
        found = Reader(folder, {**ros_env, "XDG_CACHE_HOME": str(tmp_path / "cache")}, peer)
        try:
            yield found
        finally:
            found.close()


@pytest.mark.ros
def test_page_is_true_word_for_word(reader: Reader) -> None:
    """From the first look at the graph to a robot that stands because its lidar is silent."""
    for block in _blocks():
        if block.language == "python":
            (reader.folder / "robot.py").write_text(block.text, encoding="utf-8")
        elif block.language == "rossystem":
            _write_upper_part(reader.folder / "safety/robot.system", block.text)
        else:
            {"console": reader.console, "text": reader.text}[block.language](block.text)
    typed = sum(block.text.count("\nsafety ") for block in _blocks())
    assert (reader.commands, typed) == (16, 1)  # five of them start the robot's own programs


def _blocks() -> list[Block]:
    return [block for block in pages.blocks() if block.page == PAGE]


def _write_upper_part(path: Path, text: str) -> None:
    """Replace what is above the line that the import has written."""
    _, mark, lower = path.read_text(encoding="utf-8").partition("// Imported: ")
    assert mark
    path.write_text(f"{text}\n{mark}{lower}", encoding="utf-8")
