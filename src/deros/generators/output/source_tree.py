"""Packages of generated and hand-written files, for generation at build time.

Such a package has its hand-written files in the source tree and the generated ones in the build
tree. The build needs both in one folder, so the hand-written files are linked, or copied, into the
generated package. Files for the user to edit are never created in the build tree, where the next
clean build would delete them.
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
"""Build files of the source tree, which call deros; those of the generated package are separate."""

_MODELS = (".rnd", ".system", ".deros")
NOT_SEARCHED = frozenset({"__pycache__", "build", "install", "log", "node_modules"})
_OTHERS_PLACE = ("CMakeCache.txt", "COLCON_IGNORE", "AMENT_IGNORE", MANIFEST)


class SourceTreeError(Exception):
    """The source tree does not match the generated files.

    Attributes:
        mended_by_scaffold: whether ``scaffold`` corrects it.
    """

    def __init__(self, message: str, *, mended_by_scaffold: bool) -> None:
        """Store the message and whether ``scaffold`` helps."""
        super().__init__(message)
        self.mended_by_scaffold = mended_by_scaffold


@dataclass(frozen=True, slots=True)
class Placed:
    """A hand-written file and its path in the generated package.

    Attributes:
        path: its path relative to the output folder.
        source: its path in the source tree.
        copied: whether it is copied instead of linked; CMake must not install links.
    """

    path: str
    source: Path
    copied: bool


@dataclass(frozen=True, slots=True)
class Merged:
    """A generated package merged with its source tree.

    Attributes:
        files: the generated files to write.
        placed: the hand-written files to link or copy.
        inputs: the folders and files of the source tree that the result depends on.
    """

    files: Files
    placed: tuple[Placed, ...]
    inputs: tuple[Path, ...]


def package_folder(files: Files) -> str:
    """Return the folder of the package that the files form, or '' if they are not a package."""
    tops = {path.partition("/")[0] for path in files}
    top = tops.pop() if len(tops) == 1 else ""
    return top if f"{top}/{MANIFEST}" in files else ""


def merge(files: Files, source: Path, output: Path) -> Merged:
    """Merge generated files with those in the source tree of their package.

    The source tree must contain the hand-written files. It must not contain files that the
    generator owns, unless they are identical to the generated ones.

    Args:
        files: the generated files.
        source: the source tree.
        output: the output folder; if it is inside the source tree, it is not part of it.

    Raises:
        SourceTreeError: if a hand-written file is missing, or one conflicts with a generated one.
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
        message = f"{source} lacks {lacking}, which deros generates once and you keep there"
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
    taken = {file.path for file in placed}
    written = {path: file for path, file in files.items() if path not in taken}
    copies = [file.source for file in placed if file.copied]
    return Merged(written, placed, (*folders, *([manifest] if top else []), *copies))


def scaffold(files: Files, source: Path, models: str) -> dict[str, File]:
    """Return the files for the source tree of a package generated at build time, by path.

    These are the files of the user, the manifest, and the node descriptions. The descriptions go to
    the folder of the models, which import them. Generated files that the source tree already
    contains are included, so that they are refreshed.

    Args:
        files: the generated files.
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
    """Link and copy hand-written files into the output; files that are up to date are not touched.

    Raises:
        WriteError: if a file cannot be linked or copied.
    """
    for file in placed:
        target = output / file.path
        try:
            target.parent.mkdir(parents=True, exist_ok=True)
            if file.copied:
                _copy(file.source, target)
            else:
                _link(file.source, target)
        except OSError as error:
            raise WriteError(f"cannot write {target}: {error.strerror or error}") from error


def remove_stale(stale: Iterable[str], output: Path, *, overwrite: bool) -> None:
    """Remove files that only an earlier run generated, and the folders that become empty.

    Files with manual edits are kept unless ``overwrite`` is set.
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
        with contextlib.suppress(OSError):  # folders that are not empty are kept
            for folder in PurePosixPath(path).parents:
                if folder.name:
                    (output / folder).rmdir()


def _hand_written(source: Path, output: Path, folders: list[Path]) -> Iterator[str]:
    """Yield the hand-written files of the package, and append searched folders to ``folders``."""
    build_tree = output.resolve()
    for directory, below, names in os.walk(source):
        here = Path(directory)
        folders.append(here)
        below[:] = sorted(
            folder
            for folder in below
            if _belongs(here / folder) and not build_tree.is_relative_to((here / folder).resolve())
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
    """Reject a file in the source tree that the generator owns and would write differently."""
    if file.owner is Owner.USER or name in BUILD_SCRIPTS or name == MANIFEST or not file.text:
        return
    if (source / name).read_bytes() != with_banner(name, file.text).encode():
        raise _in_the_way(source / name)


def _check_model(file: File | None, path: Path) -> None:
    """Reject a node description that was generated from an earlier version of the rules.

    A description without a banner was written by hand and is accepted.
    """
    if file is None or not _has_banner(path):
        return
    if path.read_bytes() != with_banner(path.name, file.text).encode():
        raise _in_the_way(path)


def _in_the_way(path: Path) -> SourceTreeError:
    message = f"{path} was not generated from the present version of the model: refresh it"
    return SourceTreeError(message, mended_by_scaffold=True)


def _has_banner(path: Path) -> bool:
    return is_untouched(path.read_bytes().decode(errors="replace"))


def _check_manifest(generated: str, path: Path) -> None:
    """Reject a manifest of another package, or one that lacks required dependencies."""
    try:
        present = ElementTree.parse(path).getroot()
    except (ElementTree.ParseError, ValueError) as error:
        message = f"{path} cannot be read: {error}"
        raise SourceTreeError(message, mended_by_scaffold=False) from error
    wanted = ElementTree.fromstring(generated)
    if (name := present.findtext("name", "").strip()) != (own := wanted.findtext("name", "")):
        message = (
            f"{path} is the manifest of package {name!r}, but the generated package is {own!r}"
        )
        raise SourceTreeError(message, mended_by_scaffold=False)
    if lacking := sorted(named(wanted) - named(present)):
        listed = ", ".join(lacking)
        message = f"{path} lacks <depend> tags for dependencies of the generated code: {listed}"
        raise SourceTreeError(message, mended_by_scaffold=True)


def _link(source: Path, target: Path) -> None:
    # Relative to the resolved folder, so that both trees can be moved together.
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
