"""The rows of the table of nodes and other processes."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
import contextlib
from dataclasses import dataclass, field, replace

Scalar = bool | int | float | str
Value = Scalar | Sequence[Scalar]


@dataclass(frozen=True)
class Inside:
    """A node that the program of a row makes in its own process, and names itself."""

    name: str
    namespace: str
    parameters: Mapping[str, Value] = field(default_factory=dict)
    remappings: Mapping[str, str] = field(default_factory=dict)

    @property
    def full_name(self) -> str:
        """Return the name in the ROS graph."""
        return f'{self.namespace.rstrip("/")}/{self.name}'


@dataclass(frozen=True)
class Ready:
    """What has to be in the ROS graph before the first start of a program."""

    kind: str  # node, active (a managed node), service or topic
    written: str  # its full name; '//' stands before a part that has turned out to be absolute
    timeout: float  # seconds; after that, the program is not started at all
    left_out: bool = False  # the node is not among those that are to be run

    @property
    def name(self) -> str:
        """Return the name in the ROS graph."""
        _, is_absolute, rest = self.written.rpartition('//')
        return f'/{rest}' if is_absolute else self.written

    def __str__(self) -> str:
        """Return what it is, in words."""
        return f'{self.name} to be active' if self.kind == 'active' else f'{self.kind} {self.name}'


@dataclass(frozen=True)
class Node:
    """One node of the system: which program to run, and under which names."""

    name: str
    namespace: str
    package: str
    executable: str
    arguments: Sequence[str] = ()  # of the program, before those of ROS 2
    subsystem: str = ''
    parameters: Mapping[str, Value] = field(default_factory=dict)
    remappings: Mapping[str, str] = field(default_factory=dict)
    log_level: str | None = None
    environment: Mapping[str, str] = field(default_factory=dict)
    prefix: str = ''  # words before the program, as a shell takes them apart
    respawn_delay: float | None = None  # seconds; None: it is not started again
    respawn_max: int | None = None  # None: without limit
    autostart: float | None = None  # seconds for each transition; None: it is not brought up
    optional: bool = False  # when it cannot be brought up, the others run on
    files: Sequence[str] = ()  # of parameters: beside this file, or share:PACKAGE/PATH
    container: str = ''  # the full name of what it is loaded into; else it is a process
    plugin: str = ''  # the class that is loaded
    intra_process: bool = False  # it passes messages on inside its container by pointers
    delay: float = 0.0  # seconds before its first start
    after: str = ''  # the program whose exit comes before its first start
    stops_all: bool = False  # when it has ended, all others are stopped
    tools: Sequence[str] = ()  # programs that are needed before it is started
    own_name: bool = False  # the program has that name for it: it is not renamed
    inside: Sequence[Inside] = ()  # other nodes of its process
    ready: Ready | None = None  # what has to be there before its first start

    def located(self, locate: Callable[[str], str]) -> Node:
        """Return it as it is run, given where a file is."""
        return replace(self, files=tuple(map(locate, self.files)))

    def complete(self, environment: dict[str, str]) -> Node:  # noqa: ARG002
        """Return it with all values that are made before the start, in an environment."""
        return self

    def by_hand(self) -> str:
        """Return what bash needs behind its command to make them."""
        return ''

    @property
    def sources(self) -> Sequence[str]:
        """Return the files that have to be there."""
        return self.files

    @property
    def key(self) -> str:
        """Return for whom its parameters are in a file: for it alone, or for its process."""
        return self.full_name if self.files or self.inside else '/**'

    @property
    def full_name(self) -> str:
        """Return the name in the ROS graph, such as /front/lidar."""
        return f'{self.namespace.rstrip("/")}/{self.name}'


@dataclass(frozen=True)
class Program:
    """One process that is not a node: a program, which is looked up in the PATH."""

    name: str
    program: str
    arguments: Sequence[str] = ()
    subsystem: str = ''
    environment: Mapping[str, str] = field(default_factory=dict)
    prefix: str = ''
    folder: str = ''  # in which it runs; without it, in ours
    respawn_delay: float | None = None
    respawn_max: int | None = None
    files: Sequence[str] = ()  # that have to be there
    needs: Sequence[str] = ()  # packages that have to be installed
    file_text: str = ''  # of a file that is written for it, and is its last argument
    time_to_stop: float = 0.0  # seconds that it has to stop what it started; SIGINT is its alone
    delay: float = 0.0
    after: str = ''
    stops_all: bool = False
    inside: Sequence[Inside] = ()  # nodes of its process
    ready: Ready | None = None

    def located(self, locate: Callable[[str], str]) -> Program:
        """Return it as it is run, given where a file is."""
        return replace(self, files=tuple(map(locate, self.files)))

    @property
    def sources(self) -> Sequence[str]:
        """Return the files that have to be there."""
        return self.files

    @property
    def full_name(self) -> str:
        """Return the name with those of its subsystems, such as Logging/bag."""
        return f'{self.subsystem}/{self.name}' if self.subsystem else self.name


Row = Node | Program


class Preparation:
    """What is made before anything is started; of most systems, nothing."""

    def sources(
        self,
        files: Sequence[str],
        locate: Callable[[str], str],  # noqa: ARG002
    ) -> Sequence[str]:
        """Return the files that have to be there for others to be, given where a file is."""
        return files

    def by_hand(self) -> Sequence[str]:
        """Return the commands for bash that make it."""
        return ()

    def make(self, environment: dict[str, str]) -> None:
        """Make it, in memory; raise ValueError if that cannot be done."""

    def in_place(self) -> contextlib.AbstractContextManager[None]:
        """Have it where programs look for it, and take it away in the end."""
        return contextlib.nullcontext()


def awaited_by(row: Row, rows: Sequence[Row]) -> Row | None:
    """
    Return the row whose exit comes before the first start of another one, if it is among the rows.

    It is in the same subsystem, or else in the innermost one around it that has the name.
    """
    known = {'/'.join([each.subsystem, each.name]).strip('/'): each for each in rows}
    parts = row.subsystem.split('/') if row.subsystem else []
    for depth in range(len(parts), -1, -1) if row.after else ():
        found = known.get('/'.join([*parts[:depth], row.after]))
        if found is not None:
            return found
    return None


def starts_later(row: Row) -> bool:
    """Tell whether the others do not wait for the first start of a row."""
    return bool(row.delay or row.after or row.ready)


def nodes_of(row: Row) -> Sequence[str]:
    """Return the full names of the nodes that a row starts; of a launch file, none is known."""
    own = [row.full_name] if isinstance(row, Node) else []
    return [*own, *(each.full_name for each in row.inside)]


def without_left_out(row: Row, left_out: Sequence[Row]) -> Row:
    """Return a row that does not wait for a node of those that are left out."""
    ready = row.ready
    if ready is None or ready.kind not in ('node', 'active'):
        return row
    absent = any(ready.name in nodes_of(each) for each in left_out)
    return replace(row, ready=replace(ready, left_out=True)) if absent else row


def is_loaded(row: Row) -> bool:
    """Tell whether a row is a node that is loaded into a container, and no process."""
    return isinstance(row, Node) and bool(row.container)
