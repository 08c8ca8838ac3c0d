"""
The processor load of the program of a node, out of /proc.

100 % is one processor that is busy all the time, so the threads of a program may use more of it.
What other programs use that it has started is not counted.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
import contextlib
from dataclasses import dataclass
import os
from pathlib import Path
import time

_PROC = Path('/proc')
_ENDED = (b'Z', b'X')
"""The states, in proc(5), of a process that has ended and that nobody has waited for."""

_DOMAIN = b'ROS_DOMAIN_ID='


class NoProcess(Exception):  # noqa: N818 - the node may start later
    """Not exactly one process is that of the node; the text says which there are."""


@dataclass(frozen=True)
class Sample:
    """
    A process at one time.

    ``began`` tells it from a later one of the same number: the time of its start, in clock ticks
    after that of the computer. ``used`` is the processor time of all of its threads, ended ones
    included, in clock ticks. ``taken`` is when this was read, in s of the monotonic clock.
    """

    pid: int
    parent: int
    began: int
    used: int
    taken: float

    def is_later_than(self, other: Sample) -> bool:
        """Return whether both are of one process."""
        return (self.pid, self.began) == (other.pid, other.began) and self.taken > other.taken


def read_sample(pid: int) -> Sample | None:
    """Return the state of a process; None if it has ended."""
    try:
        text = (_PROC / str(pid) / 'stat').read_bytes()
    except OSError:
        return None
    taken = time.monotonic()
    # The name of the program, in parentheses, may have blanks and parentheses in it.
    fields = text.rpartition(b')')[2].split()
    if not fields or fields[0] in _ENDED:
        return None
    return Sample(pid, int(fields[1]), int(fields[19]), int(fields[11]) + int(fields[12]), taken)


@dataclass(frozen=True)
class Found:
    """A process of a node; ``beside``: the same program has started it as this one."""

    pid: int
    beside: bool


class LoadMeter:
    """
    The processor load of the process of one node, whichever process that is just now.

    Once it was one that the same program has started, no other one takes its place.
    """

    def __init__(self, node: str) -> None:
        """Measure the node of this full name."""
        self._node = node
        self._last: Sample | None = None
        self._beside = False

    @property
    def process(self) -> int | None:
        """Return the number of the process, None while there is none."""
        return None if self._last is None else self._last.pid

    def measure(self) -> float | None:
        """
        Return the load, in percent of one processor, since the call before.

        None at the first call for a process. Raises NoProcess while there is not exactly one.
        """
        before, self._last = self._last, None
        now = None if before is None else read_sample(before.pid)
        if before is not None and now is not None and now.is_later_than(before):
            self._last = now
            seconds = (now.used - before.used) / os.sysconf('SC_CLK_TCK')
            return 100.0 * seconds / (now.taken - before.taken)
        found = find_process(self._node, only_beside=self._beside)
        self._beside = found.beside
        self._last = read_sample(found.pid)
        return None


def find_process(node: str, *, only_beside: bool = False) -> Found:
    """
    Find the process whose command line gives the node its name, as launch and deros up do.

    Nodes in other domains of ROS 2 are left out. What the same program has started as this one
    counts first, so that two robots of one name may be on a computer; with ``only_beside``,
    nothing else counts. Raises NoProcess.
    """
    ours = _domain(_PROC / 'self')
    lines = {pid: line for pid, line in _command_lines() if node_of(line) == node}
    lines = {pid: line for pid, line in lines.items() if _domain(_PROC / str(pid)) == ours}
    samples = {pid: sample for pid in lines if (sample := read_sample(pid)) is not None}
    parents = {pid: sample.parent for pid, sample in samples.items()}
    found = _programs(lines, parents)
    beside = [pid for pid in found if _starter(pid, parents) == os.getppid()]
    chosen = beside if only_beside else beside or found
    if len(chosen) == 1:
        return Found(chosen[0], bool(beside))
    if not chosen:
        where = 'beside this one' if only_beside else 'on this computer'
        raise NoProcess(f'no process {where} has been started as node {node}')
    listed = ', '.join(map(str, chosen))
    raise NoProcess(f'{len(chosen)} processes have been started as node {node}: {listed}')


def node_of(line: Sequence[str]) -> str | None:
    """Return the full name that a command line gives to the nodes of its program, if it does."""
    rules: dict[str, str] = {}
    for_ros = False
    for word, following in zip(line, [*line[1:], ''], strict=True):
        if word == '--ros-args':
            for_ros = True
        elif word == '--':
            for_ros = False
        elif for_ros and word in ('-r', '--remap'):
            left, _, right = following.partition(':=')
            rules.setdefault(left, right)  # of several rules, the first one counts
    name, namespace = rules.get('__node'), rules.get('__ns', '').strip('/')
    if name is None:
        return None
    return f'/{namespace}/{name}' if namespace else f'/{name}'


def _command_lines() -> Iterator[tuple[int, list[str]]]:
    """Yield the command lines of all processes that may be read."""
    for entry in _PROC.iterdir():
        if entry.name.isdigit():
            with contextlib.suppress(OSError):  # it has ended, or nothing may be known of it
                line = (entry / 'cmdline').read_bytes()
                yield int(entry.name), os.fsdecode(line).rstrip('\0').split('\0')


def _programs(lines: Mapping[int, list[str]], parents: Mapping[int, int]) -> list[int]:
    """
    Return the processes that are programs of nodes themselves.

    A debugger in front of a program has the words of its command line among its own. A process
    that a program has made of itself has the same words.
    """
    prefixes = {parents[pid] for pid in parents if lines[pid] != lines.get(parents[pid])}
    copies = {pid for pid in parents if lines[pid] == lines.get(parents[pid])}
    return sorted(parents.keys() - prefixes - copies)


def _starter(pid: int, parents: Mapping[int, int]) -> int:
    """Return which process has started a program, with what stands in front of it."""
    while pid in parents:
        pid = parents[pid]
    return pid


def _domain(process: Path) -> bytes:
    """Return the domain of ROS 2 in the environment of a process; ours if it may not be read."""
    try:
        variables = (process / 'environ').read_bytes().split(b'\0')
    except OSError:
        return os.environb.get(_DOMAIN.rstrip(b'='), b'') or b'0'
    found = (each.removeprefix(_DOMAIN) for each in variables if each.startswith(_DOMAIN))
    return next(found, b'') or b'0'
