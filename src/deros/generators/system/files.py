"""The files that a system names, beside what is generated from it.

A generated file finds a parameter file at the path that the system has it at, relative to itself,
so a copy goes there. What lies outside the folder of the system comes into it: ``../nav.yaml`` is
copied to ``nav.yaml``. Files of packages, and absolute paths, stay where they are. With a file for
xacro come those that it includes by a relative path.
"""

from __future__ import annotations

import os
import posixpath
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from deros import codes
from deros.diagnostics import Related, report
from deros.generators.api.protocol import File, Files, GenerationError
from deros.models.launch_files import LaunchDocument, LaunchFile, XacroDocument, XacroFile
from deros.models.parameter_files import Document, ParameterFile
from deros.models.system import System
from deros.systems.arguments.symbolic import as_written
from deros.systems.arguments.variants import Variants
from deros.systems.flat import FlatSystem
from deros.systems.flatten import flatten

if TYPE_CHECKING:
    from deros.generators.system.computed import Text
    from deros.generators.system.view import SystemView

_OUTSIDE = re.compile(r"(?:\.\./)+")
_COMPUTED = re.compile("\ue000")


@dataclass(frozen=True, slots=True)
class FileView:
    """A parameter file of a node.

    Attributes:
        path: relative to the generated file, absolute, or in the share folder of ``package``.
        package: whose file it is, if it is one of a package.
        folder: goes before a relative ``path`` that begins with what is computed.
        original: the absolute path of the file itself, where that is known.
        below: the namespace that its keys are moved to, if they are.
        plain: the parameter that its parameters are below, if it has no names of nodes.
        given: the values for ``$(var NAME)`` in it, if something is substituted.
    """

    path: Text
    package: Text | None = None
    folder: str = ""
    original: str | None = None
    below: Text | None = None
    plain: str | None = None
    given: tuple[tuple[str, Text], ...] | None = None

    @property
    def is_made(self) -> bool:
        """Whether nodes read what is made of it."""
        return any(each is not None for each in (self.below, self.plain, self.given))


class _NamedFile(Protocol):
    """A statement that names a file."""

    @property
    def path(self) -> str: ...

    @property
    def folder(self) -> str: ...

    @property
    def in_package(self) -> tuple[str, str] | None: ...


def file_view(statement: _NamedFile, system: System, text: Callable[[str], Text]) -> FileView:
    """Return the view of a file; of a parameter file, as it is before its keys are moved.

    Args:
        statement: that names it.
        system: for which a file is generated.
        text: returns what a text with marks of computed parts is made of.
    """
    if statement.in_package is not None:
        package, path = statement.in_package
        return FileView(text(path), text(package))
    path = as_written(statement.path)
    folder = os.path.relpath(statement.folder or ".", os.path.dirname(system.source.path) or ".")  # noqa: PTH120
    if path != statement.path:
        folder = _inside(folder)
        return FileView(text(path), folder="" if folder == "." else folder)
    if posixpath.isabs(path):
        return FileView(text(path), original=path)
    whole = f"{folder}/{path}"
    if _COMPUTED.search(whole) is not None:
        return FileView(text(_inside(whole)))
    original = os.path.abspath(os.path.join(statement.folder, path))  # noqa: PTH100, PTH118
    return FileView(_inside(whole), original=original)


def parameter_file_view(
    statement: ParameterFile, system: System, text: Callable[[str], Text]
) -> FileView:
    """Return the view of a parameter file; the arguments are those of :func:`file_view`."""
    found = file_view(statement, system, text)
    if statement.given is not None:
        given = ((each.name, text(as_written(each.value))) for each in statement.given)
        found = replace(found, given=tuple(given))
    if statement.plain is not None:
        return replace(found, plain=statement.plain.parameter)
    if statement.below is None or not statement.below.namespace:
        return found
    return replace(found, below=text(as_written(statement.below.namespace)))


def _inside(path: str) -> str:
    """Return a path as one below the folder of the system, without what is not needed in it.

    Only the part before what is computed is put in order.
    """
    start, mark, rest = path.partition("\ue000")
    above, slash, name = start.rpartition("/")
    if not mark:
        return _OUTSIDE.sub("", posixpath.normpath(path), count=1)
    if slash:
        above = _OUTSIDE.sub("", f"{posixpath.normpath(above)}/", count=1).removeprefix("./")
    return f"{above}{name}{mark}{rest}"


def copies(system: System, view: SystemView) -> Files:
    """Return the files to be put beside what is generated: those known for any values.

    Args:
        system: for which a file is generated.
        view: of the system.

    Raises:
        GenerationError: two of them would have one place.
    """
    reads = view.reads_files or view.describes or any(view.launches) or view.made
    if not reads:
        return {}  # to look at all variants takes time
    flats = [flatten(system)]
    if system.is_computed:
        variants = Variants(system)
        flats = [variants.flat(number) for number in variants.numbers]
    statements = [each for flat in flats for each in _files_of(flat)]
    made: dict[str, tuple[_Named, _Read]] = {}
    for each in statements:
        found = each.original() if isinstance(each, ParameterFile) else each.load()
        if each.in_package or posixpath.isabs(each.path):
            continue
        if not isinstance(found, Document | LaunchDocument | XacroDocument):
            continue
        place = file_view(each, system, lambda text: text).path
        assert isinstance(place, str)
        for path, document in _with_parts(place, found):
            first, other = made.setdefault(path, (each, document))
            if other.path == document.path:
                continue
            raise GenerationError(
                [
                    report(
                        codes.UNSUPPORTED_BY_TARGET,
                        f"the copies of '{first.path}' and '{each.path}' would both be '{path}'",
                        each.path_span,
                        "rename one of the files, or move both into the folder of the system",
                        (Related(first.path_span, "the other file"),),
                    )
                ]
            )
    return {
        path: File(found.source.text, original=Path(found.path))
        for path, (_, found) in made.items()
    }


_Named = ParameterFile | LaunchFile | XacroFile
_Read = Document | LaunchDocument | XacroDocument


def _with_parts(place: str, found: _Read) -> Iterator[tuple[str, _Read]]:
    """Yield a file with its place, and those below its folder that xacro includes in it."""
    yield place, found
    folder = posixpath.dirname(found.path)
    for each in found.whole[1:] if isinstance(found, XacroDocument) else ():
        path = posixpath.normpath(
            posixpath.join(posixpath.dirname(place), posixpath.relpath(each.path, folder))
        )
        if not path.startswith("../"):  # else it is to be in no folder of ours
            yield path, each


def _files_of(flat: FlatSystem) -> Iterator[_Named]:
    """Yield the files that are read where a system is started, launch files after the others.

    What only a node reads that a launch file starts is a matter of the launch file.
    """
    described = [file for node in flat.nodes if node.launch is not None for file in node.files]
    read = [file for node in flat.nodes if node.launch is None for file in node.files]
    read += (file for launch in flat.launches for file in launch.files)
    only_described = {file.span for file in described} - {file.span for file in read}
    yield from (each for each in flat.files if each.span not in only_described)
    yield from (each.launch for each in flat.launches)
    yield from (each.xacro for each in flat.made)
    started = (node for node in flat.nodes if node.launch is None)
    settings = (each for node in started for each in node.instance.parameters)
    yield from (each.xacro for each in settings if each.xacro is not None)
