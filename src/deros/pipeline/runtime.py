"""The packages of the runtime that generated packages depend on, and where they are.

Such a package is put beside the generated one, unless the workspace or an installed one has it in
this version. A workspace is searched as colcon does it.
"""

from __future__ import annotations

import os
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from deros.generators.output.writer import WriteError
from deros.interfaces.files import read_regular

if TYPE_CHECKING:
    from collections.abc import Mapping

    from deros.generators.api.protocol import File, Files
    from deros.generators.output.writer import WriteReport

_MANIFEST = "package.xml"
_IGNORED = ("COLCON_IGNORE", "AMENT_IGNORE")
_PACKAGES = (_MANIFEST, "setup.py", "CMakeLists.txt")
"""Files of which each makes a folder a package for colcon, which searches no package."""

_LAYOUT = "install/.colcon_install_layout"
_LARGEST = 16 << 20
_DEPTH = 6
"""Levels of folders that are searched below the source folder of a workspace."""


@dataclass(frozen=True, slots=True)
class Placement:
    """The runtime packages to write, and where the others are.

    Attributes:
        files: the files to write, relative to the output folder.
        found: a line for each runtime package that is not written, with its place.
        versions: the version of each runtime package before it is written; empty if it is new.
        shadowed: a remark for each one that is installed in another version.
    """

    files: Files = field(default_factory=dict)
    found: tuple[str, ...] = ()
    versions: Mapping[str, str] = field(default_factory=dict)
    shadowed: Mapping[str, str] = field(default_factory=dict)

    def notes(self, written: WriteReport) -> tuple[str, ...]:
        """Return a line for each runtime package, after they were written."""
        from deros.generators.output.writer import Outcome

        changed = {path.partition("/")[0] for path in written.of(Outcome.WRITTEN)}
        lines = [
            self._note(name, written.directory / name, name in changed) for name in self.versions
        ]
        return (*self.found, *lines)

    def _note(self, name: str, folder: Path, changed: bool) -> str:
        from deros.generators.runtime.interface import RUNTIME_VERSION

        before = self.versions[name]
        if not changed:
            return _found(name, folder)
        if not before:
            remark = self.shadowed.get(name, "")
            return f"wrote {folder}, version {RUNTIME_VERSION} of the runtime{remark}"
        if before == RUNTIME_VERSION:
            return f"refreshed {folder}, version {RUNTIME_VERSION} of the runtime"
        return (
            f"refreshed {folder} from version {before} of the runtime to {RUNTIME_VERSION}: "
            "generate the other packages that depend on it again"
        )


class RuntimeVersionError(WriteError):
    """The workspace has the runtime in another version, at a place that is not written to."""


def place_runtime(files: Files, output: Path, *, overwrite: bool = False) -> Placement:
    """Return the runtime packages that generated packages need beside them.

    Args:
        files: the generated files.
        output: the folder that they are written to.
        overwrite: whether generated files that were edited by hand are replaced.

    Raises:
        RuntimeVersionError: if the workspace has one in another version elsewhere, since two
            packages of one name cannot be in one workspace; or if the one in the output folder has
            another version and was edited by hand, since versions must not be mixed.
    """
    from deros.generators.runtime.interface import RUNTIME_VERSION, runtime_names, runtime_package

    names = runtime_names(files)
    if not names:
        return Placement()
    here = output.resolve()
    workspace = workspace_of(here)
    made: dict[str, File] = {}
    found: list[str] = []
    versions: dict[str, str] = {}
    shadowed: dict[str, str] = {}
    for name in names:
        own = _version(here / name, name)
        if own not in ("", RUNTIME_VERSION) and not overwrite:
            _check_untouched(name, output, own)
        if not own and workspace is not None:
            elsewhere = _in_workspace(workspace, name)
            if elsewhere is not None:
                _check_version(name, elsewhere, output)
                found.append(_found(name, elsewhere))
                continue
        installed = _installed(name, workspace)
        if not own and installed is not None:
            prefix, version = installed
            if version == RUNTIME_VERSION:
                found.append(_found(name, prefix))
                continue
            shadowed[name] = f"; once it is built, it hides version {version} in {prefix}"
        versions[name] = own
        made |= runtime_package(name)
    return Placement(made, tuple(found), versions, shadowed)


def workspace_of(folder: Path) -> Path | None:
    """Return the folder that colcon searches for the packages of the workspace around a folder.

    It is a folder ``src`` that is not a part of a package, or one that colcon has built in.
    ``None`` if the folder does not belong to a workspace, or colcon would not search it.
    """
    for each in (folder, *folder.parents):
        if any((each / name).exists() for name in (*_IGNORED, _MANIFEST)):
            return None
        if (each / _LAYOUT).is_file():
            return each
        if each.name == "src" and not (each.parent / _MANIFEST).exists():
            return each
        if each.name.startswith("."):
            return None
    return None


def _check_untouched(name: str, output: Path, version: str) -> None:
    from deros.generators.output.banner import is_untouched
    from deros.generators.runtime.interface import RUNTIME_VERSION, runtime_package

    edited = sorted(
        path
        for path, file in runtime_package(name).items()
        if file.text and (output / path).is_file() and not is_untouched(_text(output / path))
    )
    if edited:
        raise RuntimeVersionError(
            f"nothing was written to {output}: {output / name} has version {version} of the "
            f"runtime, this deros needs {RUNTIME_VERSION}, and {', '.join(edited)} was edited by "
            "hand\n  to fix it: take the changes out, or replace the files with --overwrite; or "
            "generate with --runtime copy"
        )


def _text(path: Path) -> str:
    # A checkout may have converted the line endings, which is not a manual edit.
    return read_regular(path, _LARGEST).decode(errors="replace").replace("\r\n", "\n")


def _check_version(name: str, folder: Path, output: Path) -> None:
    from deros.generators.runtime.interface import RUNTIME_VERSION

    version = _version(folder, name)
    if version != RUNTIME_VERSION:
        where = _shown(folder)
        raise RuntimeVersionError(
            f"nothing was written to {output}: the workspace has {name} {version} in {where}, and "
            f"this deros generates packages for version {RUNTIME_VERSION}\n  to fix it: remove "
            f"{where}, or run 'deros runtime {_shown(folder.parent)}', and then generate all "
            "packages that depend on it again; or generate with --runtime copy"
        )


def _in_workspace(source: Path, name: str) -> Path | None:
    """Return the folder of a package below the source folder of a workspace."""
    found = (folder for folder in _packages(source) if _version(folder, name))
    return next(found, None)


def _packages(source: Path) -> Iterator[Path]:
    seen: set[Path] = set()
    for directory, below, names in os.walk(source, followlinks=True):
        here = Path(directory)
        real = here.resolve()
        if real in seen or any(name in names for name in _IGNORED):
            below.clear()
            continue
        seen.add(real)
        if any(name in names for name in _PACKAGES):
            below.clear()
            if _MANIFEST in names:
                yield here
        elif len(here.relative_to(source).parts) >= _DEPTH:
            below.clear()
        else:
            below[:] = sorted(each for each in below if not each.startswith("."))


def _installed(name: str, workspace: Path | None) -> tuple[Path, str] | None:
    """Return the first prefix of the ament index with a package, and its version.

    What the workspace itself has built counts as little as the build that comes next.
    """
    built = workspace
    if workspace is not None and workspace.name == "src":
        built = workspace.parent
    for entry in filter(None, os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep)):
        prefix = Path(entry)
        if built is not None and prefix.resolve().is_relative_to(built):
            continue
        if (prefix / "share/ament_index/resource_index/packages" / name).is_file():
            return prefix, _version(prefix / "share" / name, name)
    return None


def _version(folder: Path, name: str) -> str:
    """Return the version in the manifest of a package; empty if it is not there."""
    try:
        manifest = ElementTree.parse(folder / _MANIFEST)
    except (OSError, ElementTree.ParseError, ValueError):
        return ""
    if manifest.findtext("name", "").strip() != name:
        return ""
    return manifest.findtext("version", "").strip() or "unknown"


def _found(name: str, folder: Path) -> str:
    from deros.generators.runtime.interface import RUNTIME_VERSION

    return f"found {name} {RUNTIME_VERSION} in {_shown(folder)}"


def _shown(folder: Path) -> Path:
    """Return a path relative to the working folder, if it lies there."""
    here = Path.cwd()
    return folder.relative_to(here) if folder.is_relative_to(here) else folder
