"""The types of the nodes of a launch file: described ones are used, others are written anew."""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from deros.generators.node.description import quoted_text
from deros.importers.file_names import FileNames, numbered
from deros.importers.launch.values.substitutions import InexpressibleError
from deros.importers.results import Parts
from deros.metamodels.load import Repository
from deros.models.node import NodeType
from deros.names.keywords import NO_ARGUMENT
from deros.names.names import check_identifier, check_package_name, check_program_name

_NO_ARGUMENT = NO_ARGUMENT | {"nan", "inf", "then", "host"}
"""Words of conditions and expressions that may be names elsewhere are none here."""

_OPEN = "parameters open  // a launch file does not say which it has\n"


class Used(NamedTuple):
    """The type of a node: its name, and its description if there was one before."""

    name: str
    model: NodeType | None


class Types:
    """The node types of one folder."""

    def __init__(self, output: Path) -> None:
        """Read the descriptions in a folder of models; those with faults are not used."""
        self._known: list[NodeType] = []
        repository = Repository()
        for path in sorted((output / "nodes").glob("*.rnd")):
            loaded = repository.load(path)
            if isinstance(loaded.model, NodeType) and not loaded.diagnostics:
                self._known.append(loaded.model)
        stems = (path.stem for path in (output / "nodes").glob("*.rnd"))
        self._names = FileNames((*stems, *(each.name for each in self._known)))
        self._new: dict[tuple[str, str, str], tuple[str, Parts]] = {}

    @property
    def are_there(self) -> bool:
        """Whether there are any, so that they can be imported."""
        return bool(self._known or self._new)

    def files(self) -> Iterator[tuple[str, Parts]]:
        """Yield the new descriptions."""
        yield from ((f"nodes/{name}.rnd", parts) for name, parts in self._new.values())

    def program(self, package: str, program: str, is_managed: bool = False) -> Used:
        """Return the type of the nodes that a program is.

        Raises:
            InexpressibleError: there can be no such program.
        """
        for each in self._known:
            if each.package == package and each.executable_name == program:
                return Used(each.name, each)
        if why := check_program_name(program):
            raise InexpressibleError(f"has a program '{program}', whose name {why}")
        said = f"executable {quoted_text(program, always=True)}\n"
        managed = "lifecycle\n" if is_managed else ""
        stem = re.sub(r"\.(?:py|sh)$", "", program)
        return Used(self._added("program", package, program, stem, said + managed), None)

    def component(self, package: str, plugin: str) -> Used:
        """Return the type of the nodes that a class makes; as :meth:`program`."""
        for each in self._known:
            if each.package == package and each.plugin and each.plugin.text == plugin:
                return Used(each.name, each)
        if not re.fullmatch(r"\w+(?:::\w+)*", plugin):
            raise InexpressibleError(f"has a class '{plugin}', which is not the name of one")
        said = f"plugin {quoted_text(plugin, always=True)}\n"
        return Used(self._added("plugin", package, plugin, plugin.split("::")[-1], said), None)

    def _added(self, kind: str, package: str, program: str, stem: str, said: str) -> str:
        key = (kind, package, program)
        if key not in self._new:
            if why := check_package_name(package):
                raise InexpressibleError(f"has a package '{package}', whose name {why}")
            name = self._name(identifier(stem), package)
            parts = Parts(f"node {name} : {package}\n{said}", _OPEN)
            self._new[key] = (name, parts)
        return self._new[key][0]

    def _name(self, stem: str, package: str) -> str:
        """Return a name that differs from others in more than case: it is that of a file."""
        return self._names.first(itertools.chain((stem,), numbered(f"{package}_{stem}", 3)))


def argument_name(text: str) -> str:
    """Return a name like a text that an argument of a system may have."""
    name = identifier(text)
    return f"{name}_" if name in _NO_ARGUMENT else name


def identifier(text: str) -> str:
    """Return a name that is like a text."""
    name = re.sub(r"[^A-Za-z0-9_]", "_", text)[:200] or "unnamed"
    name = f"_{name}" if name[0].isdigit() else name
    assert check_identifier(name) is None
    return name
