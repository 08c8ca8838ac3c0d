"""Files for build systems: the dependencies of a run, and its outputs."""

from __future__ import annotations

import importlib.util
import os
import re
from collections.abc import Iterable, Iterator
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path
from typing import TYPE_CHECKING

from deros.generators.output.writer import WriteError
from deros.interfaces.files import read_regular

if TYPE_CHECKING:
    from deros.generators.api.protocol import Context
    from deros.generators.api.registry import Generator

_SPECIAL = re.compile(r"[ \t#]")
_ESCAPED = re.compile(r"\\([ \t#])|\$(\$)")
_END = re.compile(r" \\$")
_LARGEST = 64 << 20
_STAMP = "# The last run of deros made these files:\n"


def inputs(
    context: Context, generators: Iterable[Generator], more: Iterable[Path] = ()
) -> list[str]:
    """Return the absolute paths of the dependencies of a run.

    These are the models, and the parameter files and launch files that they name; the folders that
    globs have searched, whose change says that a file came or went; the definitions of messages;
    ``more``; and deros and the generators themselves.
    """
    models = [loaded.path for loaded in context.repository.files if loaded.source is not None]
    models += map(str, context.repository.parameter_files.paths)
    models += map(str, context.repository.launch_files.paths)
    named: list[str | Path] = [*models, *context.repository.folders, *context.store.inputs(), *more]
    named += _program("deros", "deros")
    for generator in generators:
        module = generator.function.__module__.partition(".")[0]
        if module != "deros":
            named += _program(module, generator.project_name)
    return sorted({os.path.abspath(each) for each in named})  # noqa: PTH100 - links stay links


def _program(module: str, project: str | None) -> Iterator[Path]:
    """Yield the files of a program: its package, and its version record.

    An installer may give files the time of their making, so that an upgrade would not show. But
    the record lies in a folder that is named after the version, and is gone with it.
    """
    found = importlib.util.find_spec(module)
    if found is not None:
        for root in found.submodule_search_locations or ():
            for directory, below, names in os.walk(root):
                below[:] = [each for each in below if not each.startswith((".", "__pycache__"))]
                yield from (Path(directory, name) for name in names)
        if found.origin is not None:
            yield Path(found.origin)
    try:
        files = distribution(project).files if project else None
    except PackageNotFoundError:
        files = None
    yield from (Path(str(each.locate())) for each in files or () if each.name == "METADATA")


def depfile(targets: Iterable[str], prerequisites: Iterable[str]) -> str:
    """Return a Makefile rule for ``targets``, with a line for each prerequisite."""
    head = " ".join(map(_escaped, targets))
    return " \\\n  ".join([f"{head}:", *map(_escaped, prerequisites)]) + "\n"


def _escaped(path: str) -> str:
    return _SPECIAL.sub(r"\\\g<0>", path.replace("$", "$$"))


def prerequisites(text: str) -> list[str]:
    """Read the prerequisites out of what :func:`depfile` returned."""
    lines = [line[2:] for line in text.splitlines() if line.startswith("  ")]
    return [_ESCAPED.sub(r"\1\2", _END.sub("", line)) for line in lines]


def is_current(stamp: Path, depfile: Path) -> bool:
    """Return whether nothing has changed since the run that wrote both files."""
    try:
        written_ns = stamp.stat().st_mtime_ns
        found = prerequisites(read_regular(depfile, _LARGEST).decode())
        return all(Path(each).stat().st_mtime_ns <= written_ns for each in found)
    except (OSError, UnicodeDecodeError):
        return False


def write_if_changed(path: Path, text: str) -> None:
    """Write a file, unless it has this content already.

    Raises:
        WriteError: if it cannot be written.
    """
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        if not path.exists() or read_regular(path, _LARGEST) != text.encode():
            path.write_bytes(text.encode())
    except OSError as error:
        raise WriteError(f"cannot write {path}: {error.strerror or error}") from error


def write_stamp(path: Path, outputs: Iterable[str], started_ns: int) -> None:
    """Write the stamp of a run: its outputs, and as the file's time the start of the run.

    A model that is saved while deros runs is then newer than the stamp, and not overlooked.

    Raises:
        WriteError: if it cannot be written, or another file is in its place.
    """
    try:
        if path.exists() and read_regular(path, _LARGEST)[: len(_STAMP)] not in (
            _STAMP.encode(),
            b"",
        ):
            raise WriteError(f"refused to write {path}: it is not a stamp of deros")
        write_if_changed(path, _STAMP + "".join(f"{each}\n" for each in outputs))
        os.utime(path, ns=(started_ns, started_ns))
    except OSError as error:
        raise WriteError(f"cannot write {path}: {error.strerror or error}") from error


def read_stamp(path: Path) -> list[str]:
    """Return the outputs of the previous run by its stamp; none if there is no stamp."""
    try:
        text = read_regular(path, _LARGEST).decode()
    except (OSError, UnicodeDecodeError):
        return []
    return text.removeprefix(_STAMP).splitlines() if text.startswith(_STAMP) else []
