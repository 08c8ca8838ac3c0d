"""Sources of definitions: folders of a workspace, and prefixes with an ament index.

The third place, the definitions embedded in deros, is :mod:`deros.interfaces.embedded`.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Protocol

from deros.interfaces.definitions import SECTIONS, DefinitionError, parse_definition
from deros.interfaces.files import entries, is_file, read_regular, real_path, walk
from deros.interfaces.types import InterfaceKind, InterfaceType, MessageDefinition

INDEX = Path("share", "ament_index", "resource_index", "rosidl_interfaces")
"""Where, in a prefix, the ament index lists the packages that have interfaces."""

PACKAGES = Path("share", "ament_index", "resource_index", "packages")
"""Where it lists all packages."""

_LONGEST_FILE = 4 << 20
_NOT_SEARCHED = frozenset({"__pycache__", "build", "node_modules"})
_PACKAGE_XML_NAME = re.compile(r"<name>\s*([^<\s]+)\s*</name>")


@dataclass(frozen=True, slots=True)
class DefinitionProblem:
    """A definition that cannot be read: its file, the line (from 1), and the reason."""

    path: str
    line: int
    message: str

    def about(self, kind: InterfaceType) -> str:
        """Return a sentence that says why the definition of ``kind`` cannot be used."""
        where = "" if self.path == str(kind) else f" ({self.path}:{self.line})"
        return f"the definition of {kind.short} cannot be used: {self.message}{where}"


Definition = tuple[MessageDefinition, ...] | DefinitionProblem | None
"""The parts of a definition, why it cannot be read, or that there is none."""


class Source(Protocol):
    """One source of definitions."""

    def has_package(self, package: str) -> bool:
        """Return whether the place has interfaces of ``package``."""
        ...

    def packages(self) -> frozenset[str]:
        """Return the packages it has interfaces of."""
        ...

    def names(self, package: str, kind: InterfaceKind) -> frozenset[str]:
        """Return the names of the package's interfaces of one kind."""
        ...

    def definition(self, kind: InterfaceType) -> Definition:
        """Return the parts of the definition of ``kind``."""
        ...

    def inputs(self) -> Iterable[Path]:
        """Return the files and folders of the user that the results so far depend on."""
        ...


class FolderSource:
    """Definitions in the source tree of a workspace, of one package, or an install space.

    A package has the name that its ``package.xml`` gives it, else that of its folder.
    """

    def __init__(self, root: Path) -> None:
        """Store the folder; it is searched at the first query."""
        self._root = root
        self._inputs: list[Path] = []

    @cached_property
    def _folders(self) -> dict[tuple[str, str], Path]:
        """The folder of each package and kind; the first one found, in sorted order, counts."""
        found: dict[tuple[str, str], Path] = {}
        for directory, below, names in walk(self._root):
            below[:] = [b for b in below if not b.startswith(".") and b not in _NOT_SEARCHED]
            here = Path(directory)
            self._inputs.append(here)
            if here.name in SECTIONS and any(name.endswith(f".{here.name}") for name in names):
                found.setdefault((_package_name(Path(real_path(here)).parent), here.name), here)
        return found

    def has_package(self, package: str) -> bool:
        """Return whether the tree has interfaces of ``package``."""
        return any((package, kind) in self._folders for kind in SECTIONS)

    def packages(self) -> frozenset[str]:
        """Return the packages of the tree that have interfaces."""
        return frozenset(package for package, _ in self._folders)

    def names(self, package: str, kind: InterfaceKind) -> frozenset[str]:
        """Return the names of the package's interfaces of one kind."""
        folder = self._folders.get((package, kind))
        return _stems(folder, kind) if folder else frozenset()

    def definition(self, kind: InterfaceType) -> Definition:
        """Read the definition of ``kind`` from its file."""
        folder = self._folders.get((kind.package, kind.kind))
        if folder is None:
            return None
        path = folder / f"{kind.name}.{kind.kind}"
        self._inputs.append(path)
        return read_definition(path, kind)

    def inputs(self) -> Iterable[Path]:
        """Return the folders searched, where another package may appear, and the files read."""
        return tuple(self._inputs)


class AmentSource:
    """Definitions of the packages installed in one prefix.

    Source: ament index, resource type ``rosidl_interfaces``.
    """

    def __init__(self, prefix: Path) -> None:
        """Store the prefix."""
        self._prefix = prefix
        self._inputs: list[Path] = []

    def has_package(self, package: str) -> bool:
        """Return whether the index of the prefix lists interfaces of ``package``."""
        return bool(package) and is_file(self._prefix / INDEX / package)

    def packages(self) -> frozenset[str]:
        """Return the packages that the index lists."""
        return frozenset(each.name for each in entries(self._prefix / INDEX))

    def names(self, package: str, kind: InterfaceKind) -> frozenset[str]:
        """Return the names of the package's interfaces of one kind."""
        return _stems(self._prefix / "share" / package / kind, kind)

    def definition(self, kind: InterfaceType) -> Definition:
        """Read the definition of ``kind`` from the package's share folder."""
        path = self._prefix / "share" / kind.package / kind.kind / f"{kind.name}.{kind.kind}"
        self._inputs.append(path)
        return read_definition(path, kind)

    def inputs(self) -> Iterable[Path]:
        """Return the files read."""
        return tuple(self._inputs)


def read_definition(path: Path, kind: InterfaceType) -> Definition:
    """Read and parse one file; ``None`` if there is no such file."""
    try:
        text = read_regular(path, _LONGEST_FILE).decode()
    except FileNotFoundError:
        return None
    except UnicodeDecodeError as error:
        return DefinitionProblem(
            path.as_posix(), 1, f"cannot be read: byte {error.start} is not UTF-8"
        )
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        return DefinitionProblem(path.as_posix(), 1, f"cannot be read: {reason}")
    found = parse_definition(kind, text)
    if isinstance(found, DefinitionError):
        return DefinitionProblem(path.as_posix(), found.line, found.message)
    return found


def _stems(folder: Path, kind: str) -> frozenset[str]:
    paths = (Path(each.name) for each in entries(folder))
    return frozenset(path.stem for path in paths if path.suffix == f".{kind}")


def _package_name(folder: Path) -> str:
    try:
        text = read_regular(folder / "package.xml", _LONGEST_FILE).decode(errors="replace")
    except OSError:
        return folder.name
    match = _PACKAGE_XML_NAME.search(text)
    return match[1] if match else folder.name
