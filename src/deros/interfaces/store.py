"""Lookup of message, service and action definitions.

An :class:`InterfaceStore` asks, in this order, the folders it was given, the ament index of the
environment, and the definitions embedded in deros (:mod:`deros.interfaces.embedded`). As in a ROS 2
overlay, the first of them that has a package defines it wholly. Nothing is read before it is asked
for, and each definition is read once.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from functools import cached_property
from pathlib import Path

from deros.interfaces.files import is_file, is_folder
from deros.interfaces.nesting import Extents
from deros.interfaces.sources import (
    INDEX,
    PACKAGES,
    AmentSource,
    Definition,
    DefinitionProblem,
    FolderSource,
    Source,
)
from deros.interfaces.types import InterfaceKind, InterfaceType, MessageDefinition


class InterfaceStore:
    """Finds interface definitions. It is cheap to construct, and missing ones are not errors.

    Args:
        paths: folders that hold ``<package>/msg/*.msg`` (or ``srv``, ``action``) at any depth; the
            earlier ones win.
        prefixes: the install prefixes whose ament index is asked; by default those of
            ``AMENT_PREFIX_PATH``, and the Python environment if ROS 2 is installed there.
    """

    def __init__(self, paths: Sequence[Path] = (), prefixes: Sequence[Path] | None = None) -> None:
        """Store the sources; nothing is read yet."""
        self._paths = tuple(paths)
        self._prefixes = _environment_prefixes() if prefixes is None else tuple(prefixes)
        self._owners: dict[str, Source | None] = {}
        self._read: dict[InterfaceType, Definition] = {}
        self._definitions: dict[InterfaceType, Definition] = {}
        self._extents = Extents(self._nested)

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
        """Return whether there is a definition of that name, be it readable or not."""
        return self._definition(kind) is not None

    def problem(self, kind: InterfaceType) -> DefinitionProblem | None:
        """Return why an existing definition cannot be read, or ``None``."""
        found = self._definition(kind)
        return found if isinstance(found, DefinitionProblem) else None

    def unknown_part(self, kind: InterfaceType) -> InterfaceType | None:
        """Return a type nested in a message that has no definition, or ``None``."""
        definition = self.message(kind)
        return None if definition is None else self._extents.of(definition).unknown

    def has_package(self, package: str) -> bool:
        """Return whether any interface of ``package`` is known."""
        return self._owner(package) is not None

    def packages(self) -> frozenset[str]:
        """Return every package with a known interface, for near matches."""
        return frozenset().union(*(source.packages() for source in self._sources))

    def names(self, package: str, kind: InterfaceKind) -> frozenset[str]:
        """Return the names of a package's interfaces of one kind, for near matches."""
        owner = self._owner(package)
        return owner.names(package, kind) if owner else frozenset()

    def share(self, package: str) -> Path | None:
        """Return the share folder of an installed package, or ``None`` if none is known."""
        for prefix in self._prefixes:
            folder = prefix / "share" / package
            if is_file(prefix / PACKAGES / package) and is_folder(folder):
                return folder
        return None

    def inputs(self) -> tuple[Path, ...]:
        """Return the files and folders on disk that the results so far depend on.

        What is embedded in deros is not among them, nor what was looked for in vain.
        """
        return tuple(path for source in self._sources for path in source.inputs())

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
            found = self._as_read(kind)
            self._definitions[kind] = found
            for part in found if isinstance(found, tuple) else ():
                problem = self._extents.of(part).problem
                if problem:
                    self._definitions[kind] = DefinitionProblem(str(kind), 1, problem)
        return self._definitions[kind]

    def _as_read(self, kind: InterfaceType) -> Definition:
        if kind not in self._read:
            owner = self._owner(kind.package)
            self._read[kind] = owner.definition(kind) if owner else None
        return self._read[kind]

    def _nested(self, kind: InterfaceType) -> MessageDefinition | None:
        found = self._as_read(kind)
        return found[0] if isinstance(found, tuple) else None

    def _parts(
        self, kind: InterfaceType, wanted: InterfaceKind
    ) -> tuple[MessageDefinition, ...] | None:
        found = self._definition(kind) if kind.kind == wanted else None
        return found if isinstance(found, tuple) else None


def _environment_prefixes() -> tuple[Path, ...]:
    named = [part for part in os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep) if part]
    if is_folder(Path(sys.prefix) / INDEX):
        named.append(sys.prefix)
    return tuple(Path(prefix) for prefix in dict.fromkeys(named))
