"""Somebody who reads a page of the documentation and does what it says, word for word.

A page that is played writes its files as fenced blocks with a title, ``title="robot.system"``,
changes them by blocks of the language ``diff`` with the same title, and types commands in blocks
``console``. In what a command prints, ``…`` stands for anything in a line, and a line ``…`` for any
lines.
"""

from __future__ import annotations

import functools
import re
import shlex
import signal
import subprocess
import sys
from dataclasses import dataclass, field
from pathlib import Path

from tests.support import pages
from tests.support.cli import deros
from tests.support.pages import Block
from tests.support.ros import LIMIT, Peer

_FAILED = re.compile(
    r"^\d+ errors?\b|^\d+ timelines? played, \d+ differs?$|\bstays active, |^not reset, "
    r"|^NODE [^\0]*\b(?:warning|error|stale)\b",
    re.MULTILINE,
)
"""What a command of deros has printed that ends with exit code 1."""


_RESETS = 5
"""So often a refused reset is typed again."""


def blocks_of(page: str) -> list[Block]:
    """Return the fenced blocks of one page, in order."""
    return [block for block in pages.blocks() if block.page == page]


@dataclass
class Reader:
    """Somebody in a folder, with a program ``deros``.

    Attributes:
        folder: where files are written, and where commands run.
        commands: how many have been typed.
    """

    folder: Path
    commands: int = 0

    def play(self, block: Block) -> None:
        """Do what a block says; one in another language than those above only shows something.

        Raises:
            AssertionError: if a command prints something else than the page says.
        """
        if block.title and block.language == "diff":
            self._change(block)
        elif block.title:
            path = self.folder / block.title
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(block.text, encoding="utf-8")
        elif block.language == "console":
            self.console(block.text)

    def console(self, text: str) -> None:
        """Type the commands of a block, and compare what they print."""
        parts = re.split(r"^\$ ", text, flags=re.MULTILINE)
        assert parts[0] == ""
        for part in parts[1:]:
            command, _, shown = part.partition("\n")
            self.type(command, shown)

    def type(self, command: str, shown: str) -> None:
        """Run a command, and compare what it prints, and whether it says that it has failed."""
        self.commands += 1
        words = shlex.split(command, comments=True)
        code, printed = self.run(words)
        assert _matches(shown, printed), f"{command}\n{printed}"
        expected = 1 if words[0] == "deros" and _FAILED.search(printed) else 0
        assert code == expected, f"{command}: {code}\n{printed}"

    def run(self, words: list[str]) -> tuple[int, str]:
        """Run a command in this process, and return its exit code and what it prints."""
        assert words[0] == "deros", words
        outcome = deros(*words[1:])
        return outcome.code, outcome.out + outcome.err

    def _change(self, block: Block) -> None:
        path = self.folder / block.title
        lines = block.text.splitlines(keepends=True)
        old = "".join(line[1:] for line in lines if line[0] in "- ")
        new = "".join(line[1:] for line in lines if line[0] in "+ ")
        text = path.read_text(encoding="utf-8")
        assert text.count(old) == 1, f"{block} changes what is {text.count(old)} times there"
        path.write_text(text.replace(old, new), encoding="utf-8")


@dataclass
class Terminal:
    """A program that goes on, what it prints, and how much of that has been read.

    Attributes:
        read: where the lines begin that no block has shown yet.
        shown: where the last line ends that the present block shows.
    """

    process: subprocess.Popen[bytes]
    log: Path
    read: int = 0
    shown: int = 0

    def has(self, pattern: re.Pattern[str]) -> bool:
        """Tell whether it has printed such a line behind those of the blocks before."""
        found = pattern.search(self.log.read_text(encoding="utf-8"), self.read)
        if found is not None:
            self.shown = max(self.shown, found.end())
        return found is not None

    def interrupt(self) -> None:
        """Press Ctrl-C, and wait for the end."""
        self.process.send_signal(signal.SIGINT)
        self.process.wait(LIMIT)


@dataclass(kw_only=True)
class RobotReader(Reader):
    """Somebody with several terminals and a robot.

    Blocks ``text`` show lines that the programs print which go on; they are awaited. Several
    processes share a terminal, so those of one block may come in any order.

    Attributes:
        env: the environment of all programs.
        peer: looks at the graph, so that a command waits for what the last one has started.
        lasting: how the commands begin that go on, each in a terminal of its own, until the page
            ends them by ``^C``.
        programs: the folder of the programs that are typed.
    """

    env: dict[str, str]
    peer: Peer
    lasting: tuple[str, ...]
    programs: Path = Path(sys.executable).parent
    terminals: dict[str, Terminal] = field(default_factory=dict)

    def play(self, block: Block) -> None:
        """Do what a block says, and wait for the lines that it shows."""
        if block.language == "text":
            for line in block.text.splitlines():
                shown = functools.partial(self._show, re.compile(_pattern(line)))
                self.peer.until(shown)
            for each in self.terminals.values():
                each.read = max(each.read, each.shown)
        else:
            super().play(block)

    def type(self, command: str, shown: str) -> None:
        """Run a command to its end, or start it in a terminal; or end it there."""
        if shown == "^C\n":
            self._end(command)
        elif command.startswith(self.lasting):
            self.commands += 1
            self._start(command)
        else:
            super().type(command, shown)

    def run(self, words: list[str]) -> tuple[int, str]:
        """Run a program to its end.

        A reset that is refused is typed again: on a busy machine an input of a gate may be late
        for a moment, and that is not what the pages are about.
        """
        code, printed = self._run_once(words)
        for _ in range(_RESETS if words[:2] == ["deros", "reset"] else 0):
            if not printed.startswith("not reset, because this applies: "):
                break
            code, printed = self._run_once(words)
        return code, printed

    def _run_once(self, words: list[str]) -> tuple[int, str]:
        run = subprocess.run(
            self._found(words),
            cwd=self.folder,
            env=self.env,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            timeout=2 * LIMIT,
            check=False,
        )
        return run.returncode, run.stdout

    def _found(self, words: list[str]) -> list[str]:
        program = self.programs / words[0]
        return [str(program) if program.exists() else words[0], *words[1:]]

    def _start(self, command: str) -> None:
        log = self.folder.parent / f"terminal{self.commands}.log"
        with log.open("wb") as output:
            process = subprocess.Popen(
                self._found(shlex.split(command)),
                cwd=self.folder,
                env={**self.env, "PYTHONUNBUFFERED": "1"},
                stdout=output,
                stderr=subprocess.STDOUT,
            )
        self.terminals[command] = Terminal(process, log)
        if name := _node(command):
            self.peer.until(lambda: name in self.peer.node.get_node_names())

    def _end(self, command: str) -> None:
        for each in self.terminals.values():
            each.read = each.log.stat().st_size
        self.terminals.pop(command).interrupt()
        if name := _node(command):
            self.peer.until(lambda: name not in self.peer.node.get_node_names())

    def _show(self, pattern: re.Pattern[str]) -> bool:
        return any(each.has(pattern) for each in self.terminals.values())

    def close(self) -> None:
        """End what goes on, and print what it said."""
        for each in self.terminals.values():
            each.process.send_signal(signal.SIGINT)
        for command, each in self.terminals.items():
            try:
                each.process.wait(LIMIT)
            except subprocess.TimeoutExpired:
                each.process.kill()
                each.process.wait()
            print(f"--- {command}\n{each.log.read_text(encoding='utf-8')}")


def _node(command: str) -> str:
    """Return the name of the node that a program of the page's robot makes, empty for others."""
    found = re.match(r"python3 robot\.py (\w+)", command)
    return found[1] if found else ""


def _pattern(line: str) -> str:
    return re.escape(line).replace("…", ".*")


def _matches(shown: str, printed: str) -> bool:
    """Compare line by line, without spaces at the ends of lines, and with any number within."""
    expected = [re.sub(r" +", " ", line) for line in shown.splitlines()]
    found = [re.sub(r" +", " ", line.rstrip()) for line in printed.splitlines()]
    pattern = "".join(r"(?:.*\n)*" if line == "…" else _pattern(line) + r"\n" for line in expected)
    return re.fullmatch(pattern, "".join(f"{line}\n" for line in found)) is not None
