"""Launch files as models: one system for each file."""

from __future__ import annotations

import os
import re
from collections.abc import Callable
from pathlib import Path

from deros.importers.launch.actions import walk
from deros.importers.launch.blocks import Refuse, written
from deros.importers.launch.described import Types, argument_name, identifier
from deros.importers.launch.elements import element_of
from deros.importers.launch.ports import topics
from deros.importers.launch.python_files.reading import Unsaid, elements_of
from deros.importers.launch.scopes import File
from deros.importers.launch.values.argument_types import types_of
from deros.importers.launch.values.writing import Writer
from deros.importers.readers import Request, UnreadableError
from deros.importers.results import Imported, Parts
from deros.metamodels.launch_files.elements import Element

_ENDING = re.compile(r"(?:[._]launch)?\.(?:xml|ya?ml|launch|py)$")


def read_xml(request: Request) -> Imported:
    """Return the models of launch files in XML."""
    return read_by(request, lambda path: (element_of(path, is_yaml=False), ()))


def read_yaml(request: Request) -> Imported:
    """Return the models of launch files in YAML."""
    return read_by(request, lambda path: (element_of(path, is_yaml=True), ()))


def read_python(request: Request) -> Imported:
    """Return the models of launch files in Python, which are run for that."""
    return read_by(request, lambda path: elements_of(path, request.values))


def read_by(request: Request, of: Callable[[Path], tuple[Element, tuple[Unsaid, ...]]]) -> Imported:
    """Return the models of launch files.

    Args:
        request: the files.
        of: returns the root of a file, and what is not in it.

    Raises:
        UnreadableError: as ``of``, or two files would become one system.
    """
    if request.name is not None and len(request.files) > 1:
        raise UnreadableError("--name is for one launch file: each becomes a system")
    types = Types(request.output)
    systems: dict[str, Parts] = {}
    missing: list[str] = []
    for path in request.files:
        root, unsaid = of(path)
        name = request.name or identifier(_ENDING.sub("", path.name))
        if f"{name}.system" in systems:
            raise UnreadableError(f"{path} would become '{name}.system', as another file does")
        file = File(path.name, str(path), _folder(path, request.output), request.output, types)
        for each in unsaid:
            file.refuse(*each)
        parts = _system(file, root, name)
        systems[f"{name}.system"] = parts
        found = sorted(file.missing, key=lambda each: each.line)
        missing += dict.fromkeys(map(str, found))
    return Imported({**systems, **dict(types.files())}, tuple(missing))


def _folder(path: Path, output: Path) -> str:
    """Return the folder of a launch file, from that of the models; empty if it is the same."""
    found = os.path.relpath(path.parent.absolute(), output.absolute())
    return "" if found == "." else found.replace(os.sep, "/")


def _system(file: File, root: Element, name: str) -> Parts:
    declared = (each.attributes.get("name", "") for each in root.below() if each.tag == "arg")
    file.names.update({each: each for each in declared if argument_name(each) == each})
    walk(file, root)
    topics(file)
    # What arguments are used as is known when all has been written: their types follow from that.
    _written(file, {}, lambda *_: None)
    body = _written(file, types_of(file.declared), file.refuse)
    imports = '\nimports\n  import "nodes/*.rnd"\n' if file.types.are_there else ""
    return Parts(f"system {name}\n{imports}", body)


def _written(file: File, types: dict[str, str], refuse: Refuse) -> str:
    writer = Writer(file.declared, types, is_draft=not types)
    for argument in file.declared.values():
        writer.declare(argument)
    lines = list(written(file.root, writer, refuse))
    text = "\n".join([*writer.lines, *lines]).strip("\n")
    return f"{text}\n" if text else "// The launch file starts nothing.\n"
