"""Launch files as they are imported: the models, and what these start."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from deros.generators.output.writer import write
from deros.generators.system.script.generate import table
from deros.generators.system.script.standalone.node import Program
from deros.generators.system.view import system_view
from deros.importers.kept.files import renewed
from deros.importers.kinds import KINDS
from deros.importers.readers import Request
from deros.importers.results import Imported
from deros.models.common import Scalar
from deros.models.node import ParameterType
from deros.models.system import System
from deros.names.graph_names import resolve_name
from deros.systems.arguments.resolve import resolve
from tests.support.systems import load

_TYPED: Mapping[ParameterType, Callable[[str], Scalar]] = {
    ParameterType.BOOL: lambda text: text.lower() == "true",
    ParameterType.INTEGER: int,
    ParameterType.DOUBLE: float,
}


def imported(file: Path, output: Path | None = None) -> Imported:
    """Import a launch file, and write the models."""
    folder = file.parent if output is None else output
    (kind,) = (kind for kind in KINDS if kind.is_one(file))
    found = kind.read(Request((file,), None, folder, lambda _: True))
    write(renewed(found.files, folder).files, folder)
    return found


def model_of(file: Path, output: Path | None = None) -> System:
    """Return the system that a launch file becomes."""
    found = imported(file, output)
    return load((file.parent if output is None else output) / next(iter(found.files)))


def typed(system: System, words: Mapping[str, str]) -> dict[str, Scalar]:
    """Return the values of arguments, given as texts as for launch."""
    kinds = {each.name: each.type for each in system.arguments}
    return {
        name: _TYPED.get(kinds[name], str)(word) for name, word in words.items() if name in kinds
    }


def rows(system: System, values: Mapping[str, Scalar]) -> list[str]:
    """Return what a system starts for values of its arguments, as texts in some order.

    Left out are its groups, the names of what is no node, names that are remapped to what they are
    anyway, and its folder. What stops all when it ends is not started again.
    """
    folder = str(Path(system.source.path).parent.absolute())
    found = (repr(_row(row)) for row in table(system_view(resolve(system, values))))
    return sorted(each.replace(folder, "") for each in found)


def _row(row: Any) -> Any:
    row = replace(row, subsystem="")
    if row.stops_all:
        row = replace(row, respawn_delay=None, respawn_max=None)
    if isinstance(row, Program):
        row = replace(row, name="")
    if not hasattr(row, "remappings"):
        return row
    remapped: dict[str, str] = {}
    for source, target in dict(row.remappings).items():
        scheme, mark, bare = source.rpartition("://")
        full = resolve_name(bare, row.namespace or "/", row.name)
        end = resolve_name(target, row.namespace or "/", row.name)
        if full != end:
            remapped.setdefault(f"{scheme}{mark}{full}", end)
    return replace(row, remappings=dict(sorted(remapped.items())))
