"""Parameter files that a launch file makes while it is executed, as Nav2 does."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

from deros.importers.launch.python_files.visit.constructors import given, kind
from deros.importers.launch.python_files.visit.texts import is_known, is_text

_PARAMETERS = "ros__parameters"


def is_computed_file(value: Any) -> bool:
    """Return whether one of a node's parameters is a file that another program's class makes."""
    if isinstance(value, Mapping) or kind(value) == "Parameter":
        return False
    path = given(value)["param_file"] if kind(value) == "ParameterFile" else value
    return is_text(path) and not is_known(path)


def maker_of(value: Any) -> str:
    """Return the name of the class that makes a file."""
    path = given(value)["param_file"] if kind(value) == "ParameterFile" else value
    within = path if isinstance(path, (list, tuple)) else [path]
    return next(kind(each) for each in within if not is_known(each))


def parameters_in(file: Any, node: Any, context: Any) -> dict[str, Any]:
    """Return what a file has for a node, which is made for that.

    Args:
        file: its description, as it is given to the node.
        node: its description.
        context: of launch.
    """
    import yaml
    from launch_ros.parameter_descriptions import ParameterFile

    described = file if kind(file) == "ParameterFile" else ParameterFile(file)
    document = yaml.safe_load(Path(described.evaluate(context)).read_text(encoding="utf-8"))
    found: dict[str, Any] = {}
    for pattern, values in _sections(document, ()):
        if _matches(pattern, _names(node, context)):
            found.update(_flat(values, ""))
    return found


def _sections(tree: Any, path: tuple[str, ...]) -> Iterator[tuple[tuple[str, ...], Any]]:
    """Yield the parameters in a file, and the parts of the name that they are for."""
    for key, inner in tree.items() if isinstance(tree, dict) else ():
        if key == _PARAMETERS:
            yield path, inner
        else:
            yield from _sections(inner, (*path, *filter(None, str(key).split("/"))))


def _names(node: Any, context: Any) -> tuple[str, ...]:
    """Return the parts of a full name; the last one is empty where the program chooses it."""
    from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

    def performed(value: Any) -> str:
        listed = normalize_to_list_of_substitutions(value)
        return str(perform_substitutions(context, listed))

    said = given(node)
    space = performed(said.get("namespace") or "")
    around = context.launch_configurations.get("ros_namespace", "")
    full = space if space.startswith("/") else f"{around}/{space}"
    name = performed(said["name"]) if said.get("name") is not None else ""
    return (*filter(None, full.split("/")), name)


def _matches(pattern: Iterable[str], names: tuple[str, ...]) -> bool:
    """Return whether parameters are for a node: ``*`` is one part of a name, ``**`` any number."""
    first, *others = *pattern, ""
    if not others:
        return not names
    rest = others[:-1]
    if first == "**":
        return any(_matches(rest, names[at:]) for at in range(len(names) + 1))
    return bool(names) and first in ("*", names[0]) and _matches(rest, names[1:])


def _flat(values: Any, prefix: str) -> Iterator[tuple[str, Any]]:
    for name, value in values.items() if isinstance(values, dict) else ():
        if isinstance(value, dict):
            yield from _flat(value, f"{prefix}{name}.")
        else:
            yield f"{prefix}{name}", value
