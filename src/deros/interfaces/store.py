"""Where message, service and action definitions come from.

An :class:`InterfaceStore` asks, in this order, the folders it was given, the ament index of the
environment, and the definitions embedded in deros (:mod:`deros.interfaces.embedded`). As in a ROS 2
overlay, the first of them that has a package defines it wholly. Nothing is read before it is asked
for, and each definition is read once.
"""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Protocol

from deros.interfaces.definitions import SECTIONS, DefinitionError, parse_definition
from deros.interfaces.types import InterfaceKind, InterfaceType, MessageDefinition

_INDEX = Path("share", "ament_index", "resource_index", "rosidl_interfaces")
_NOT_SEARCHED = frozenset({"__pycache__", "build", "node_modules"})
_PACKAGE_XML_NAME = re.compile(r"<name>\s*([^<\s]+)\s*</name>")


@dataclass(frozen=True, slots=True)
class DefinitionProblem:
    """A definition that is there but cannot be read: its file, the line (from 1), and why."""

    path: str
    line: int
    message: str


Definition = tuple[MessageDefinition, ...] | DefinitionProblem | None
"""The parts of a definition, why it cannot be read, or that there is none."""


class Source(Protocol):
    """One place that definitions come from."""

    def has_package(self, package: str) -> bool:
        """Tell whether the place has interfaces of ``package``."""
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


class InterfaceStore:
    """Finds interface definitions; cheap to construct, and quiet about what is not there.

    Args:
        paths: folders that hold ``<package>/msg/*.msg`` (or ``srv``, ``action``) at any depth; the
            earlier ones win.
        prefixes: the install prefixes whose ament index is asked; by default those of
            ``AMENT_PREFIX_PATH``, and the Python environment if ROS 2 is installed there.
    """

    def __init__(self, paths: Sequence[Path] = (), prefixes: Sequence[Path] | None = None) -> None:
        """Remember where to look; nothing is read yet."""
        self._paths = tuple(paths)
        self._prefixes = _environment_prefixes() if prefixes is None else tuple(prefixes)
        self._owners: dict[str, Source | None] = {}
        self._definitions: dict[InterfaceType, Definition] = {}

    def message(self, kind: InterfaceType) -> MessageDefinition | None:
        """Return the definition of a message type, or ``None``."""
        parts = self._parts(kind, "msg")
        return parts[0] if parts else None

    def service(self, kind: InterfaceType) -> tuple[MessageDefinition, MessageDefinition] | None:
        """Return request and response of a service type, or ``None``."""
        parts = self._parts(kind, "srv")
        return (parts[0], parts[1]) if parts else None

    def action(
        self, kind: InterfaceType
    ) -> tuple[MessageDefinition, MessageDefinition, MessageDefinition] | None:
        """Return goal, result and feedback of an action type, or ``None``."""
        parts = self._parts(kind, "action")
        return (parts[0], parts[1], parts[2]) if parts else None

    def exists(self, kind: InterfaceType) -> bool:
        """Tell whether there is a definition of that name, be it readable or not."""
        return self._definition(kind) is not None

    def problem(self, kind: InterfaceType) -> DefinitionProblem | None:
        """Say why a definition that is there cannot be read, or return ``None``."""
        found = self._definition(kind)
        return found if isinstance(found, DefinitionProblem) else None

    def has_package(self, package: str) -> bool:
        """Tell whether any interface of ``package`` is known."""
        return self._owner(package) is not None

    def packages(self) -> frozenset[str]:
        """Return every package with a known interface, for near matches."""
        return frozenset().union(*(source.packages() for source in self._sources))

    def names(self, package: str, kind: InterfaceKind) -> frozenset[str]:
        """Return the names of a package's interfaces of one kind, for near matches."""
        owner = self._owner(package)
        return owner.names(package, kind) if owner else frozenset()

    @cached_property
    def _sources(self) -> list[Source]:
        from deros.interfaces.embedded import EmbeddedSource

        folders: list[Source] = [FolderSource(path) for path in self._paths]
        return [*folders, *map(AmentSource, self._prefixes), EmbeddedSource()]

    def _owner(self, package: str) -> Source | None:
        if package not in self._owners:
            owners = (source for source in self._sources if source.has_package(package))
            self._owners[package] = next(owners, None)
        return self._owners[package]

    def _definition(self, kind: InterfaceType) -> Definition:
        if kind not in self._definitions:
            owner = self._owner(kind.package)
            self._definitions[kind] = owner.definition(kind) if owner else None
        return self._definitions[kind]

    def _parts(
        self, kind: InterfaceType, wanted: InterfaceKind
    ) -> tuple[MessageDefinition, ...] | None:
        found = self._definition(kind) if kind.kind == wanted else None
        return found if isinstance(found, tuple) else None


class FolderSource:
    """Definitions in the source tree of a workspace, of one package, or an install space.

    A package has the name that its ``package.xml`` gives it, else that of its folder.
    """

    def __init__(self, root: Path) -> None:
        """Remember the folder; it is searched at the first question."""
        self._root = root

    @cached_property
    def _folders(self) -> dict[tuple[str, str], Path]:
        """The folder of each package and kind; the first one found, in sorted order, counts."""
        found: dict[tuple[str, str], Path] = {}
        for directory, below, names in os.walk(self._root):
            below[:] = sorted(b for b in below if not b.startswith(".") and b not in _NOT_SEARCHED)
            here = Path(directory)
            if here.name in SECTIONS and any(name.endswith(f".{here.name}") for name in names):
                found.setdefault((_package_name(here.resolve().parent), here.name), here)
        return found

    def has_package(self, package: str) -> bool:
        """Tell whether the tree has interfaces of ``package``."""
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
        return read_definition(folder / f"{kind.name}.{kind.kind}", kind) if folder else None


class AmentSource:
    """Definitions of the packages installed in one prefix.

    Source: ament index, resource type ``rosidl_interfaces``.
    """

    def __init__(self, prefix: Path) -> None:
        """Remember the prefix."""
        self._prefix = prefix

    def has_package(self, package: str) -> bool:
        """Tell whether the index of the prefix lists interfaces of ``package``."""
        return bool(package) and (self._prefix / _INDEX / package).is_file()

    def packages(self) -> frozenset[str]:
        """Return the packages that the index lists."""
        try:
            return frozenset(entry.name for entry in (self._prefix / _INDEX).iterdir())
        except OSError:
            return frozenset()

    def names(self, package: str, kind: InterfaceKind) -> frozenset[str]:
        """Return the names of the package's interfaces of one kind."""
        return _stems(self._prefix / "share" / package / kind, kind)

    def definition(self, kind: InterfaceType) -> Definition:
        """Read the definition of ``kind`` from the package's share folder."""
        folder = self._prefix / "share" / kind.package / kind.kind
        return read_definition(folder / f"{kind.name}.{kind.kind}", kind)


def read_definition(path: Path, kind: InterfaceType) -> Definition:
    """Read and parse one file; ``None`` if there is no such file."""
    try:
        text = path.read_text(encoding="utf-8")
    except FileNotFoundError:
        return None
    except (OSError, ValueError) as error:
        return DefinitionProblem(path.as_posix(), 1, f"cannot be read: {error}")
    found = parse_definition(kind, text)
    if isinstance(found, DefinitionError):
        return DefinitionProblem(path.as_posix(), found.line, found.message)
    return found


def _stems(folder: Path, kind: str) -> frozenset[str]:
    try:
        return frozenset(path.stem for path in folder.iterdir() if path.suffix == f".{kind}")
    except OSError:
        return frozenset()


def _package_name(folder: Path) -> str:
    try:
        text = (folder / "package.xml").read_text(encoding="utf-8", errors="replace")
    except OSError:
        return folder.name
    match = _PACKAGE_XML_NAME.search(text)
    return match[1] if match else folder.name


def _environment_prefixes() -> tuple[Path, ...]:
    named = [part for part in os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep) if part]
    if (Path(sys.prefix) / _INDEX).is_dir():
        named.append(sys.prefix)
    return tuple(Path(prefix) for prefix in dict.fromkeys(named))
