"""The writer of generated files: it writes either all files of a run or none.

All files are first written to a staging folder inside the output directory, with copies of the
files that will be replaced, so that a full disk is noticed before anything has changed. Only
renames remain; if one of them fails, the completed ones are undone.
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
"""The largest size in bytes of an existing file at the path of a generated one."""


class WriteError(Exception):
    """The output could not be written; the directory is unchanged."""


class Outcome(enum.Enum):
    """The outcome for one file."""

    WRITTEN = "written"  # created or refreshed
    UNCHANGED = "unchanged"  # identical to the file on disk
    HAND_EDITED = "hand-edited"  # a generated file with manual edits: kept
    USER = "user"  # an existing file of the user: kept


@dataclass(frozen=True, slots=True)
class WriteReport:
    """The outcomes of a run by relative POSIX path, sorted."""

    directory: Path
    outcomes: tuple[tuple[str, Outcome], ...]

    def of(self, outcome: Outcome) -> tuple[str, ...]:
        """Return the paths with the given outcome."""
        return tuple(path for path, became in self.outcomes if became is outcome)

    def apart(self, files: Files) -> tuple[WriteReport, WriteReport]:
        """Return the outcomes of the other files, and those of ``files``."""
        others = tuple(each for each in self.outcomes if each[0] not in files)
        those = tuple(each for each in self.outcomes if each[0] in files)
        return WriteReport(self.directory, others), WriteReport(self.directory, those)

    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """One warning for each file that was kept because of manual edits."""
        return tuple(_kept(self.directory / path) for path in self.of(Outcome.HAND_EDITED))


def write(files: Files, directory: Path, *, overwrite: bool = False) -> WriteReport:
    """Write ``files`` below ``directory``, creating the directory if necessary.

    Files of the generator get a banner with a digest and are refreshed. Those with manual edits are
    kept unless ``overwrite`` is set. Files of the user are written once and never again, shared
    ones are replaced as they are. Unchanged files are not touched.

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
        outputs: the name of each model, and the files generated from it.

    Raises:
        WriteError: if two models generate the same path with different texts.
    """
    joined: dict[str, File] = {}
    makers: dict[str, str] = {}
    for maker, files in outputs:
        for path, file in files.items():
            if joined.setdefault(path, file) != file:
                raise WriteError(
                    f"refused to write {path}: {makers[path]} and {maker} generate it with "
                    "different texts; give them separate packages or output folders"
                )
            makers.setdefault(path, maker)
    return joined


@dataclass(frozen=True, slots=True)
class _Change:
    """A file to put in place, and whether it replaces an existing one."""

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
            # The copies for undoing are in the staging folder, which must be removed after them.
            with _staging(directory) as staging, _undoing() as undo:
                _stage(changes, directory, staging)
                _put_in_place(changes, directory, staging, undo)
    return WriteReport(directory, tuple(outcomes))


def _outcome(target: Path, change: _Change, owner: Owner, overwrite: bool) -> Outcome:
    if target.is_dir():
        raise WriteError(f"cannot write {target}: it is a directory")
    # Other than regular files are never opened: a pipe would block, a device must not be replaced.
    present = read_regular(target, _LARGEST) if target.exists() else b""
    if owner is Owner.USER:
        return Outcome.USER
    if present == change.content and os.access(target, os.X_OK) >= change.executable:
        return Outcome.UNCHANGED
    # The __init__.py of a package was empty once: nobody's edit is lost with that.
    was_empty = target.name == "__init__.py" and not present
    is_ours = owner is Owner.SHARED or _untouched(present)
    if present == change.content or overwrite or was_empty or is_ours:
        return Outcome.WRITTEN
    return Outcome.HAND_EDITED


def _untouched(present: bytes) -> bool:
    # A checkout may have converted the line endings, which is not a manual edit.
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
            f"refused to write {path!r}: it is not a plain path below the output directory"
        )
    return pure


def _check_nesting(paths: list[PurePosixPath]) -> None:
    names = set(paths)
    for path in paths:
        for parent in path.parents:
            if parent in names:
                raise WriteError(f"refused to write {path}: {parent} is generated as a file")


def _check_case(paths: list[PurePosixPath], directory: Path) -> None:
    """Reject a file whose path differs only in case from that of another generated or present one.

    On a case-insensitive file system one would silently replace the other. All systems reject it,
    so that the output does not depend on the machine and can be checked out on any.
    """
    wanted = set(paths)
    there: dict[PurePosixPath, dict[str, str]] = {}
    for path in paths:
        names = there.get(path.parent)
        if names is None:
            folder = directory / path.parent
            listed = [path.name for path in folder.iterdir()] if folder.is_dir() else []
            names = there[path.parent] = {name.casefold(): name for name in listed}
            names |= {name.casefold(): name for name in listed if path.parent / name in wanted}
        other = names.setdefault(path.name.casefold(), path.name)
        if other != path.name:
            raise WriteError(
                f"refused to write {directory / path}: it differs from {other} only in case, and "
                "on a case-insensitive file system both are one file; rename one in the models"
            )


def _check_inside(target: Path, directory: Path) -> None:
    """Reject a target that a symbolic link leads out of the output directory."""
    root = directory.resolve()
    if not target.parent.resolve().is_relative_to(root):
        raise WriteError(f"refused to write {target}: a symbolic link leads out of {directory}")


# Staging, renaming and undoing --------------------------------------------------------------------


@contextlib.contextmanager
def _undoing() -> Iterator[contextlib.ExitStack]:
    """Yield a stack of callbacks that are called if the block raises."""
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
    """Create ``directory`` and its missing parents, each to be removed again on failure."""
    for folder in [*reversed(directory.parents), directory]:
        if not folder.exists():
            try:
                folder.mkdir()
            except FileExistsError:
                continue  # a concurrent run has created it
            undo.callback(_remove_folder, folder)


def _stage(changes: Iterable[_Change], directory: Path, staging: Path) -> None:
    for number, change in enumerate(changes):
        staged = staging / f"{number}.new"
        with staged.open("wb") as stream:
            stream.write(change.content)
            stream.flush()
            os.fsync(stream.fileno())  # some file systems report only here that they are full
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
    # Another program may have put a file there meanwhile, which must not be deleted.
    with contextlib.suppress(OSError):
        folder.rmdir()


def _kept(path: Path) -> Diagnostic:
    source = SourceFile(str(path), "")
    return report(
        codes.HAND_EDITED,
        "edited by hand since it was generated; not overwritten",
        Span(source, 0, 0),
        hint="move the change to one of your own files, or replace the file with --overwrite",
    )
