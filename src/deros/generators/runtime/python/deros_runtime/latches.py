"""Keeps latched actions active across restarts, in a state file."""

from __future__ import annotations

from collections.abc import Callable, Collection, Set
import contextlib
import hashlib
import os
from pathlib import Path
import stat
from typing import IO

from .regular_file import check_replaceable, is_same, open_regular

HEAD = 'deros latches 1'
LONGEST = 1 << 20  # bytes; a longer file is not a state file
UNIQUE = 8  # random bytes in the name of a new file


def default_path(stem: str) -> Path:
    """Return the default path of a node's state file."""
    home = os.environ.get('ROS_HOME') or Path.home() / '.ros'
    return Path(home) / 'deros' / f'{stem}.latches'


class LatchFile:
    """
    A file with the names of the active actions, and a digest over them.

    The file is replaced as a whole, so it is never partially written. A file that cannot be read
    counts as 'all active': an action starts inactive only if the file says so, or if there is no
    file. Anything that is not a regular file (a link, a device, a pipe) counts as a file that
    cannot be read, and is not touched.
    """

    def __init__(self, path: Path, owner: str) -> None:
        """Set the path; owner is the node, in case others are given the same file by mistake."""
        self.path = path
        self.owner = owner
        self.saved: frozenset[str] | None = None  # the content of the file, if that is known
        self._opened: IO[bytes] | None = None

    def load(self, known: Collection[str]) -> tuple[frozenset[str], str]:
        """Return the active ones of the known actions, and why all of them count as active."""
        try:
            text = self._read().decode()
        except FileNotFoundError:
            return frozenset(), ''
        except (OSError, UnicodeDecodeError) as error:
            return frozenset(known), f'{self.path} cannot be read: {error}'
        names = text.split('\n')[2:-2]
        if text != self._text(names):
            return frozenset(known), f'{self.path} is damaged, or not of {self.owner}'
        strangers = sorted(set(names) - set(known))
        if strangers:
            return frozenset(known), f'{self.path} names {", ".join(strangers)}, unknown by now'
        return frozenset(names), ''

    def save(self, active: Set[str]) -> None:
        """
        Write which actions are active; they are on the disk when this returns.

        Raises OSError; the content of the file is unknown then.
        """
        if self.saved == active:
            return
        self.saved = None
        folder = self.path.parent
        folder.parent.mkdir(parents=True, exist_ok=True)
        folder.mkdir(mode=0o700, exist_ok=True)
        check_replaceable(self.path)
        self._write(self._text(sorted(active)).encode())
        entry = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
        try:
            os.fsync(entry)
        finally:
            os.close(entry)
        self.saved = frozenset(active)

    @property
    def is_in_place(self) -> bool:
        """Whether the path still refers to the file that was saved."""
        return self._opened is not None and is_same(self.path, self._opened.fileno())

    def remove_leftovers(self) -> None:
        """Remove temporary files of processes that were killed while saving."""
        first, last = f'{self.path.name}.', '.new'
        length = len(self._new_name())
        with contextlib.suppress(OSError):
            for path in list(self.path.parent.iterdir()):
                name = path.name
                is_new = name.startswith(first) and name.endswith(last) and len(name) == length
                if is_new and stat.S_ISREG(path.lstat().st_mode):
                    path.unlink()

    def mark_dirty(self) -> None:
        """
        Make the file count as 'all active' until it is saved again.

        This takes microseconds, because it does not wait for the disk. It survives any end of the
        process, but not a loss of power.
        """
        self.saved = None
        if self._opened is not None:
            with contextlib.suppress(OSError):
                os.pwrite(self._opened.fileno(), b'?', 0)

    def truncate(self) -> None:
        """
        Truncate the file, which needs no disk space, so that it counts as 'all active'.

        Raises OSError.
        """
        descriptor = open_regular(self.path, os.O_WRONLY | os.O_CREAT)
        try:
            os.ftruncate(descriptor, 0)
            os.fsync(descriptor)
        finally:
            os.close(descriptor)

    def _read(self) -> bytes:
        with os.fdopen(open_regular(self.path, os.O_RDONLY), 'rb') as file:
            data = file.read(LONGEST + 1)
        if len(data) > LONGEST:
            raise OSError(f'it is longer than {LONGEST} bytes')
        return data

    def _new_name(self) -> str:
        return f'{self.path.name}.{os.urandom(UNIQUE).hex()}.new'

    def _write(self, data: bytes) -> None:
        """Replace the file by a new one, whose name cannot be predicted."""
        new = self.path.with_name(self._new_name())
        file = new.open('xb')
        try:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
            check_replaceable(self.path)
            new.replace(self.path)
        except OSError:
            with contextlib.suppress(OSError):
                file.close()
            with contextlib.suppress(OSError):
                new.unlink()
            raise
        self._opened = file

    def _text(self, names: Collection[str]) -> str:
        body = ''.join(f'{line}\n' for line in (HEAD, self.owner, *names))
        return f'{body}{hashlib.sha256(body.encode()).hexdigest()}\n'


class Latches:
    """The active latched actions, in memory and in the state file."""

    def __init__(
        self, file: LatchFile, known: Collection[str], report: Callable[[str, str], None]
    ) -> None:
        """
        Load the file; if it cannot be read or written, all known actions are active.

        report takes a subject and what is wrong with it; an empty text takes that back.
        """
        self._file = file
        self._report = report
        file.remove_leftovers()
        active, problem = file.load(known)
        self.active: frozenset[str] = active
        self._known = frozenset(known)
        try:
            file.save(self.active)
        except OSError as error:
            self.active = frozenset(known)
            problem = f'{file.path} cannot be written: {error}'
        if problem:
            report('latches', f'{problem}; all latched actions are active')

    def mark_pending(self, action: str) -> None:
        """Mark the file before an action is executed, so that no crash loses the action."""
        if action in self._known and action not in self.active:
            self._file.mark_dirty()

    def record(self, action: str, active: bool) -> None:
        """Note that the monitor has made an action active, or reset it."""
        if action in self._known:
            self.active = self.active | {action} if active else self.active - {action}

    def persist(self) -> str:
        """Save the active actions; return why that failed, or an empty text."""
        if self._file.saved == self.active:
            if self._file.is_in_place:
                return ''
            self._file.saved = None  # it was removed or replaced by somebody else
        try:
            self._file.save(self.active)
        except OSError as error:
            text = f'{self._file.path} cannot be written: {error}'
            try:
                self._file.truncate()
                text += '; after a restart all latched actions are active'
            except OSError as second:
                text += f'; nor emptied: {second}'
            self._report('latches', text)
            return text
        self._report('latches', '')
        return ''

    def allow_reset(self, remaining: Set[str]) -> str:
        """Save in advance what a reset will leave active; return why that failed, or empty."""
        try:
            self._file.save(remaining)
        except OSError as error:
            self.persist()
            return f'nothing is reset, because {self._file.path} cannot be written: {error}'
        self._report('latches', '')
        return ''
