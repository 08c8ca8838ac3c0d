"""Generated files and hand-written ones made one package, each where it belongs.

A package that is generated while it is built keeps its hand-written files in its source tree, and
the generated ones in the build tree. To build, both have to stand in one folder: what is written by
hand is linked, or copied, into the generated package. Nothing of the user's is ever made in the
build tree, where it would be lost with the next clean build.
"""

from __future__ import annotations

import contextlib
import os
import shutil
import tempfile
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

from deros.generators.api.protocol import File, Files, Owner
from deros.generators.output.banner import is_untouched, with_banner
from deros.generators.output.writer import WriteError
from deros.generators.user_files.manifest import named

MANIFEST = "package.xml"
BUILD_SCRIPTS = frozenset({"CMakeLists.txt", "setup.py", "setup.cfg"})
"""Files that the source tree has for itself: they are what calls deros."""

_MODELS = (".rnd", ".system", ".deros")
NOT_SEARCHED = frozenset({"__pycache__", "build", "install", "log", "node_modules"})
_OTHERS_PLACE = ("CMakeCache.txt", "COLCON_IGNORE", "AMENT_IGNORE", MANIFEST)


class SourceTreeError(Exception):
    """The source tree does not fit what is generated; the text says how to mend it.

    Attributes:
        mended_by_scaffold: whether making the package's files anew mends it.
    """

    def __init__(self, message: str, *, mended_by_scaffold: bool) -> None:
        """Keep what is wrong."""
        super().__init__(message)
        self.mended_by_scaffold = mended_by_scaffold


@dataclass(frozen=True, slots=True)
class Placed:
    """A hand-written file and its place in the generated package.

    Attributes:
        path: relative to the output folder.
        source: where it was written.
        copied: whether it is copied, not linked: what CMake installs must be no link.
    """

    path: str
    source: Path
    copied: bool


@dataclass(frozen=True, slots=True)
class Merged:
    """What is to be written, what is to be placed beside it, and what that rests on."""

    files: Files
    placed: tuple[Placed, ...]
    inputs: tuple[Path, ...]


def package_folder(files: Files) -> str:
    """Return the folder of the package that the files make up, or '' if they are none."""
    tops = {path.partition("/")[0] for path in files}
    top = tops.pop() if len(tops) == 1 else ""
    return top if f"{top}/{MANIFEST}" in files else ""


def merge(files: Files, source: Path, output: Path) -> Merged:
    """Join generated files with what stands in the source tree of their package.

    Hand-written files must be there; files that the generator owns must not, unless they are just
    what it would write. A build tree inside the source tree, which ``output`` tells, is no part of
    it.

    Raises:
        SourceTreeError: if a hand-written file is missing, or one is in the way.
    """
    top = package_folder(files)
    own = {str(PurePosixPath(path).relative_to(top)): path for path in files}
    manifest = source / MANIFEST
    if top and manifest.is_file():
        _check_manifest(files[f"{top}/{MANIFEST}"].text, manifest)
    missing = [
        name
        for name, path in own.items()
        if files[path].owner is Owner.USER and not (source / name).is_file()
    ]
    if top and not manifest.is_file() and MANIFEST not in missing:
        missing.append(MANIFEST)
    if missing:
        lacking = ", ".join(sorted(missing))
        message = f"{source} lacks {lacking}, which deros writes once for you to keep there"
        raise SourceTreeError(message, mended_by_scaffold=True)
    folders: list[Path] = []
    names = list(_hand_written(source, output, folders)) if top else []
    if not top:
        names = [name for name, path in own.items() if files[path].owner is Owner.USER]
    described = {PurePosixPath(name).name: files[path] for name, path in own.items()}
    for name in names:
        if name.endswith(_MODELS):
            _check_model(described.get(PurePosixPath(name).name), source / name)
        elif name in own:
            _check_not_generated(files[own[name]], name, source)
    linked_part = "src/" if f"{top}/CMakeLists.txt" in files else ""
    placed = tuple(
        Placed(f"{top}/{name}" if top else name, source / name, not name.startswith(linked_part))
        for name in names
        if name not in BUILD_SCRIPTS and not name.endswith(_MODELS)
    )
    taken = {each.path for each in placed}
    written = {path: file for path, file in files.items() if path not in taken}
    copies = [each.source for each in placed if each.copied]
    return Merged(written, placed, (*folders, *([manifest] if top else []), *copies))


def scaffold(files: Files, source: Path, models: str) -> dict[str, File]:
    """Return what a package generated at build time has in its source tree, by its path there.

    These are the hand-written files, the manifest, and the node descriptions, which models import
    and which therefore stand in their folder; besides, whatever of the generator's stands there
    already, to be refreshed.

    Args:
        files: what the generator makes.
        source: the source tree.
        models: the folder of the models in it.
    """
    top = package_folder(files)
    kept: dict[str, File] = {}
    for path, file in files.items():
        name = str(PurePosixPath(path).relative_to(top))
        if name.endswith(_MODELS):
            name = str(PurePosixPath(models) / PurePosixPath(name).name)
            wanted = not (source / name).is_file() or _has_banner(source / name)
        elif name in BUILD_SCRIPTS:
            wanted = False
        else:
            there = bool(file.text) and (source / name).is_file()
            wanted = there or file.owner is Owner.USER or name == MANIFEST
        if wanted:
            kept[name] = file
    return kept


def place(placed: Iterable[Placed], output: Path) -> None:
    """Link and copy hand-written files into the output; what is right already is not touched.

    Raises:
        WriteError: if one cannot be placed.
    """
    for each in placed:
        target = output / each.path
        try:
            target.parent.mkdir(parents=True, exist_ok=True)
            if each.copied:
                _copy(each.source, target)
            else:
                _link(each.source, target)
        except OSError as error:
            raise WriteError(f"cannot write {target}: {error.strerror or error}") from error


def remove_stale(stale: Iterable[str], output: Path, *, overwrite: bool) -> None:
    """Remove what an earlier run made and this one does not, and the folders left empty.

    A file that a hand has edited stays, unless ``overwrite``.
    """
    for path in stale:
        if ".." in PurePosixPath(path).parts or PurePosixPath(path).is_absolute():
            continue
        target = output / path
        if not target.is_symlink():
            if not target.is_file():
                continue
            text = target.read_bytes().decode(errors="replace")
            if text and not overwrite and not is_untouched(text):
                continue
        target.unlink(missing_ok=True)
        with contextlib.suppress(OSError):  # a folder that still holds something stays
            for folder in PurePosixPath(path).parents:
                if folder.name:
                    (output / folder).rmdir()


def _hand_written(source: Path, output: Path, folders: list[Path]) -> Iterator[str]:
    """Find the package's files, noting the folders that were searched."""
    build_tree = output.resolve()
    for directory, below, names in os.walk(source):
        here = Path(directory)
        folders.append(here)
        below[:] = sorted(
            each
            for each in below
            if _belongs(here / each) and not build_tree.is_relative_to((here / each).resolve())
        )
        for name in sorted(names):
            if not name.startswith(".") and (here / name).is_file():
                yield (here / name).relative_to(source).as_posix()


def _belongs(folder: Path) -> bool:
    if folder.name.startswith(".") or folder.name.endswith(".egg-info"):
        return False
    if folder.name in NOT_SEARCHED:
        return False
    return not any((folder / name).exists() for name in _OTHERS_PLACE)


def _check_not_generated(file: File, name: str, source: Path) -> None:
    """Refuse a file in the source tree that the generator owns, unless it is what it writes."""
    if file.owner is Owner.USER or name in BUILD_SCRIPTS or name == MANIFEST or not file.text:
        return
    if (source / name).read_bytes() != with_banner(name, file.text).encode():
        raise _in_the_way(source / name)


def _check_model(file: File | None, path: Path) -> None:
    """Refuse a node description that deros has made of an earlier state of the rules.

    One without a banner was written by hand, and is nobody else's.
    """
    if file is None or not _has_banner(path):
        return
    if path.read_bytes() != with_banner(path.name, file.text).encode():
        raise _in_the_way(path)


def _in_the_way(path: Path) -> SourceTreeError:
    message = f"{path} was generated from something else than the model as it is: refresh it"
    return SourceTreeError(message, mended_by_scaffold=True)


def _has_banner(path: Path) -> bool:
    return is_untouched(path.read_bytes().decode(errors="replace"))


def _check_manifest(generated: str, path: Path) -> None:
    """Refuse a manifest of another package, or one that leaves out what generated code needs."""
    try:
        present = ElementTree.parse(path).getroot()
    except (ElementTree.ParseError, ValueError) as error:
        message = f"{path} cannot be read: {error}"
        raise SourceTreeError(message, mended_by_scaffold=False) from error
    wanted = ElementTree.fromstring(generated)
    if (name := present.findtext("name", "").strip()) != (own := wanted.findtext("name", "")):
        message = f"{path} is of a package {name!r}, generated is {own!r}"
        raise SourceTreeError(message, mended_by_scaffold=False)
    if lacking := sorted(named(wanted) - named(present)):
        message = f"{path} lacks <depend> for what the generated code needs: {', '.join(lacking)}"
        raise SourceTreeError(message, mended_by_scaffold=True)


def _link(source: Path, target: Path) -> None:
    # Relative to where the folder really is, so that both trees can be moved together.
    wanted = os.path.relpath(source.resolve(), target.parent.resolve())
    if target.is_symlink() and os.readlink(target) == wanted:  # noqa: PTH115 - compares texts
        return
    with tempfile.TemporaryDirectory(prefix=".deros-", dir=target.parent) as staging:
        staged = Path(staging) / "link"
        staged.symlink_to(wanted)
        staged.replace(target)


def _copy(source: Path, target: Path) -> None:
    if target.is_file() and not target.is_symlink() and _same(source, target):
        return
    with tempfile.TemporaryDirectory(prefix=".deros-", dir=target.parent) as staging:
        staged = Path(staging) / "copy"
        shutil.copyfile(source, staged)
        shutil.copymode(source, staged)
        staged.replace(target)


def _same(source: Path, target: Path) -> bool:
    executable = source.stat().st_mode & 0o111 == target.stat().st_mode & 0o111
    return executable and source.read_bytes() == target.read_bytes()
