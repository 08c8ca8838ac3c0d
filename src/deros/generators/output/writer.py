"""The one place where generated files reach the disk: all of them, or none.

Everything is first written to a staging folder inside the output directory, copies of what will be
replaced included, so that a full disk shows before anything has changed. Then only renames are
left; if one of them fails, those done are taken back.
"""

from __future__ import annotations

import contextlib
import enum
import os
import shutil
import tempfile
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

from deros import codes
from deros.diagnostics import Diagnostic, SourceFile, Span, report
from deros.generators.api.protocol import File, Files, Owner
from deros.generators.output.banner import is_untouched, with_banner
from deros.interfaces.files import read_regular

_LARGEST = 256 << 20
"""How many bytes a file may have that stands where one is to be written."""


class WriteError(Exception):
    """The output could not be written; the directory is as it was before."""


class Outcome(enum.Enum):
    """What became of one file."""

    WRITTEN = "written"  # created or refreshed
    UNCHANGED = "unchanged"  # on disk already, to the byte
    HAND_EDITED = "hand-edited"  # generator's, but changed by hand: kept
    USER = "user"  # the user's, there already: kept


@dataclass(frozen=True, slots=True)
class WriteReport:
    """What a run did, by relative POSIX path, in sorted order."""

    directory: Path
    outcomes: tuple[tuple[str, Outcome], ...]

    def of(self, outcome: Outcome) -> tuple[str, ...]:
        """Return the paths with one outcome."""
        return tuple(path for path, became in self.outcomes if became is outcome)

    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """One warning for each hand-edited file that was kept."""
        return tuple(_kept(self.directory / path) for path in self.of(Outcome.HAND_EDITED))


def write(files: Files, directory: Path, *, overwrite: bool = False) -> WriteReport:
    """Write ``files`` below ``directory``, which is made if it is not there.

    Files of the generator get a banner with a digest and are refreshed; one that a hand has edited
    is kept unless ``overwrite``. Files of the user are written once and never again. A file that
    has not changed is not touched.

    Raises:
        WriteError: if a path leaves the directory, or a file cannot be written.
    """
    paths = [_checked(path) for path in sorted(files)]
    _check_nesting(paths)
    try:
        _check_case(paths, directory)
        return _write(files, paths, directory, overwrite)
    except OSError as error:
        where = error.filename if error.filename is not None else directory
        raise WriteError(f"cannot write {where}: {error.strerror or error}") from error
    except UnicodeEncodeError as error:
        raise WriteError(f"cannot write half a character, {error.object[error.start]!r}") from error


def join(outputs: Sequence[tuple[str, Files]]) -> Files:
    """Return the files of several models as those of one run.

    Args:
        outputs: each model's name, and what was made from it.

    Raises:
        WriteError: if two of them make one path, and not the same text of it.
    """
    joined: dict[str, File] = {}
    makers: dict[str, str] = {}
    for maker, files in outputs:
        for path, file in files.items():
            if joined.setdefault(path, file) != file:
                raise WriteError(
                    f"refused to write {path}: {makers[path]} and {maker} make it, and not the "
                    "same; give them packages or output folders of their own"
                )
            makers.setdefault(path, maker)
    return joined


@dataclass(frozen=True, slots=True)
class _Change:
    """A file to put in place, and whether something stands there now."""

    path: PurePosixPath
    content: bytes
    executable: bool
    replaces: bool


def _write(
    files: Files, paths: list[PurePosixPath], directory: Path, overwrite: bool
) -> WriteReport:
    outcomes: list[tuple[str, Outcome]] = []
    changes: list[_Change] = []
    for path in paths:
        file = files[str(path)]
        target = directory / path
        _check_inside(target, directory)
        text = file.text
        if file.owner is Owner.GENERATOR:
            text = with_banner(str(path), text)
        change = _Change(path, text.encode(), file.executable, os.path.lexists(target))
        outcome = Outcome.WRITTEN
        if change.replaces:
            outcome = _outcome(target, change, file.owner, overwrite)
        outcomes.append((str(path), outcome))
        if outcome is Outcome.WRITTEN:
            changes.append(change)
    if changes:
        with _undoing() as undo_folders:
            _make_directory(directory, undo_folders)
            # The copies to go back to lie in the staging folder: it must outlive the way back.
            with _staging(directory) as staging, _undoing() as undo:
                _stage(changes, directory, staging)
                _put_in_place(changes, directory, staging, undo)
    return WriteReport(directory, tuple(outcomes))


def _outcome(target: Path, change: _Change, owner: Owner, overwrite: bool) -> Outcome:
    if target.is_dir():
        raise WriteError(f"cannot write {target}: it is a directory")
    # What is neither is never opened: a pipe would block, and a device is not to be replaced.
    present = read_regular(target, _LARGEST) if target.exists() else b""
    if owner is Owner.USER:
        return Outcome.USER
    if present == change.content and os.access(target, os.X_OK) >= change.executable:
        return Outcome.UNCHANGED
    if present == change.content or overwrite or _untouched(present):
        return Outcome.WRITTEN
    return Outcome.HAND_EDITED


def _untouched(present: bytes) -> bool:
    # A checkout may have turned the line ends; nobody's work is lost with them.
    return is_untouched(present.decode(errors="replace").replace("\r\n", "\n"))


# Paths ------------------------------------------------------------------------------------------


def _checked(path: str) -> PurePosixPath:
    pure = PurePosixPath(path)
    if (
        not pure.name
        or pure.is_absolute()
        or ".." in pure.parts
        or "\0" in path
        or str(pure) != path
    ):
        raise WriteError(
            f"refused to write {path!r}: it is no plain path below the output directory"
        )
    return pure


def _check_nesting(paths: list[PurePosixPath]) -> None:
    names = set(paths)
    for path in paths:
        for parent in path.parents:
            if parent in names:
                raise WriteError(f"refused to write {path}: {parent} is to be a file")


def _check_case(paths: list[PurePosixPath], directory: Path) -> None:
    """Refuse a file that another one, there or to be written, differs from in case alone.

    Where case does not count, one would silently take the other's place. It is refused everywhere,
    so that what is generated does not depend on the machine, and can be checked out on any.
    """
    wanted = set(paths)
    there: dict[PurePosixPath, dict[str, str]] = {}
    for path in paths:
        names = there.get(path.parent)
        if names is None:
            folder = directory / path.parent
            listed = [each.name for each in folder.iterdir()] if folder.is_dir() else []
            names = there[path.parent] = {name.casefold(): name for name in listed}
            names |= {name.casefold(): name for name in listed if path.parent / name in wanted}
        other = names.setdefault(path.name.casefold(), path.name)
        if other != path.name:
            raise WriteError(
                f"refused to write {directory / path}: it differs from {other} in case alone, and "
                "where case does not count both are one file; rename one of the two in the models"
            )


def _check_inside(target: Path, directory: Path) -> None:
    """Refuse a target that a symbolic link in the output directory would carry out of it."""
    root = directory.resolve()
    if not target.parent.resolve().is_relative_to(root):
        raise WriteError(f"refused to write {target}: a symbolic link leads out of {directory}")


# Staging, putting in place, and taking back -------------------------------------------------------


@contextlib.contextmanager
def _undoing() -> Iterator[contextlib.ExitStack]:
    """Give a stack of steps back, which are taken if the block fails for whatever reason."""
    with contextlib.ExitStack() as undo:
        yield undo
        undo.pop_all()


@contextlib.contextmanager
def _staging(directory: Path) -> Iterator[Path]:
    staging = Path(tempfile.mkdtemp(prefix=".deros-", dir=directory))
    try:
        yield staging
    finally:
        shutil.rmtree(staging, ignore_errors=True)


def _make_directory(directory: Path, undo: contextlib.ExitStack) -> None:
    """Make ``directory`` and its missing parents, each to be removed again on failure."""
    for folder in [*reversed(directory.parents), directory]:
        if not folder.exists():
            try:
                folder.mkdir()
            except FileExistsError:
                continue  # a run beside this one was first
            undo.callback(_remove_folder, folder)


def _stage(changes: Iterable[_Change], directory: Path, staging: Path) -> None:
    for number, change in enumerate(changes):
        staged = staging / f"{number}.new"
        with staged.open("wb") as stream:
            stream.write(change.content)
            stream.flush()
            os.fsync(stream.fileno())  # some file systems find out only here that they are full
        if change.executable:
            mode = staged.stat().st_mode
            staged.chmod(mode | (mode & 0o444) >> 2)
        if change.replaces:
            shutil.copy2(directory / change.path, staging / f"{number}.old", follow_symlinks=False)


def _put_in_place(
    changes: Iterable[_Change], directory: Path, staging: Path, undo: contextlib.ExitStack
) -> None:
    for number, change in enumerate(changes):
        target = directory / change.path
        _make_directory(target.parent, undo)
        if change.replaces:
            undo.callback(os.replace, staging / f"{number}.old", target)
        else:
            undo.callback(target.unlink, missing_ok=True)
        (staging / f"{number}.new").replace(target)


def _remove_folder(folder: Path) -> None:
    # Somebody else may have put a file there meanwhile; it is not ours to delete.
    with contextlib.suppress(OSError):
        folder.rmdir()


def _kept(path: Path) -> Diagnostic:
    source = SourceFile(str(path), "")
    return report(
        codes.HAND_EDITED,
        "edited by hand since it was generated: kept as it is",
        Span(source, 0, 0),
        hint="move the change to a file of yours, or replace it with --overwrite",
    )
