"""What a reader of files is asked for, and what it says where it cannot read them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from deros.diagnostics import SourceFile
from deros.importers.results import Imported
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import InterfaceType
from deros.metamodels.reading import Unreadable, read


class UnreadableError(Exception):
    """A file cannot be read, or is not what it should be; the text says where and why."""


def source_of(path: Path) -> SourceFile:
    """Return the text of a file.

    Raises:
        UnreadableError: if there is no text at the path.
    """
    try:
        return read(path, str(path), streams=False)
    except Unreadable as unreadable:
        raise UnreadableError(unreadable.diagnostic.message) from unreadable


@dataclass(frozen=True, slots=True)
class Request:
    """What to read.

    Attributes:
        files: all of one kind, as the user named them.
        name: of the system; ``None`` if the user named none.
        output: the folder of the models. What is there already may be of use to a reader.
        is_known: whether there is a definition of an interface.
        store: the definitions of interfaces.
        values: of arguments, for files that are run.
    """

    files: tuple[Path, ...]
    name: str | None
    output: Path
    is_known: Callable[[InterfaceType], bool]
    store: InterfaceStore = field(default_factory=InterfaceStore)
    values: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Kind:
    """A kind of files.

    Attributes:
        word: its name, as ``--as`` takes it.
        what: what such a file is, for people.
        is_one: whether a file is of this kind; it looks at the name first, into the file only
            where that says too little, and never raises.
        read: makes models of files; raises :class:`UnreadableError`.
        runs: whether reading a file runs it, for which the user has to name the kind.
    """

    word: str
    what: str
    is_one: Callable[[Path], bool]
    read: Callable[[Request], Imported]
    runs: bool = False
