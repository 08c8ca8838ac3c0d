"""The kinds of files that models can be imported from: a row each."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path

from deros.importers.recognized import is_launch_xml, is_launch_yaml, is_parameter_file
from deros.importers.results import Imported
from deros.interfaces.types import InterfaceType


class UnreadableError(Exception):
    """A file cannot be read, or is not what it should be; the text says where and why."""


@dataclass(frozen=True, slots=True)
class Request:
    """What to read.

    Attributes:
        files: all of one kind, as the user named them.
        name: of the system; ``None`` if the user named none.
        output: the folder of the models. What is there already may be of use to a reader.
        is_known: whether there is a definition of an interface.
    """

    files: tuple[Path, ...]
    name: str | None
    output: Path
    is_known: Callable[[InterfaceType], bool]


@dataclass(frozen=True, slots=True)
class Kind:
    """A kind of files.

    Attributes:
        word: its name, as ``--as`` takes it.
        what: what such a file is, for people.
        is_one: whether a file is of this kind; it looks at the name first, into the file only
            where that says too little, and never raises.
        read: makes models of files; raises :class:`UnreadableError`.
    """

    word: str
    what: str
    is_one: Callable[[Path], bool]
    read: Callable[[Request], Imported]


def _later(module: str, function: str) -> Callable[[Request], Imported]:
    """Return a reader whose module is imported when it is used."""

    def read(request: Request) -> Imported:
        found: Callable[[Request], Imported] = getattr(import_module(module), function)
        return found(request)

    return read


_PARAMETERS, _READ = "deros.importers.parameter_files", "read_parameter_files"
_LAUNCH = "deros.importers.launch.reading"
KINDS: tuple[Kind, ...] = (
    Kind("launch-xml", "launch file in XML", is_launch_xml, _later(_LAUNCH, "read_xml")),
    Kind("launch-yaml", "launch file in YAML", is_launch_yaml, _later(_LAUNCH, "read_yaml")),
    Kind("parameters", "parameter file of ROS 2", is_parameter_file, _later(_PARAMETERS, _READ)),
)


def kinds_of(files: Sequence[Path]) -> Iterator[Kind | None]:
    """Yield the kind of each file, ``None`` for one that is of none."""
    for file in files:
        yield next((kind for kind in KINDS if kind.is_one(file)), None)
