"""Log files beside the output: one for each program, and one of all in their order."""

from __future__ import annotations

from collections.abc import Sequence
import contextlib
import logging
from logging.handlers import RotatingFileHandler
from pathlib import Path
import sys
import time


class LogFile(RotatingFileHandler):
    """
    A file that is kept short.

    When it is full, it becomes NAME.log.1, what was that becomes NAME.log.2, and the oldest goes.
    """

    SIZE = 10 << 20  # bytes of each file
    OLDER = 5  # files that are kept beside the one that is written

    def __init__(self, file: Path) -> None:
        """Open the file, to add to what is in it."""
        super().__init__(file, maxBytes=self.SIZE, backupCount=self.OLDER, encoding='utf-8')
        self.fault: BaseException | None = None

    def write(self, stamp: str, text: str) -> None:
        """Add a line; after a failure, nothing more."""
        if self.fault is None:
            self.emit(logging.LogRecord('', 0, '', 0, f'{stamp} {text}', None, None))

    def handleError(self, record: logging.LogRecord) -> None:  # noqa: ARG002, N802
        """Keep the error: a full disk must not end a robot."""
        self.fault = sys.exc_info()[1]
        with contextlib.suppress(OSError):
            self.close()


class OpenError(Exception):
    """A log file cannot be opened."""


class Logs:
    """The log files of a system."""

    def __init__(self, folder: Path, system: str, labels: Sequence[str]) -> None:
        """
        Open the files, in a folder that is made if need be.

        Raises OpenError when one cannot be opened.
        """
        try:
            folder.mkdir(parents=True, exist_ok=True)
            # No name of a node or a system has a hyphen or a point in it.
            self._all = LogFile(folder / f'{system}-all.log')
            self._of = {label: LogFile(folder / _name(label)) for label in labels}
        except OSError as error:
            raise OpenError(error) from None
        self._told: set[LogFile] = set()

    def write(self, label: str, lines: Sequence[bytes], program: bool = True) -> list[str]:
        """Add the lines of a program, or of the script itself; return what has failed by that."""
        now = time.time()
        clock = time.strftime('%Y-%m-%dT%H:%M:%S', time.localtime(now))
        stamp = f'{clock}.{int(now % 1 * 1000):03}{time.strftime("%z", time.localtime(now))}'
        own = [self._of[label]] if program else []
        for line in lines:
            text = line.decode(errors='backslashreplace')
            self._all.write(stamp, f'[{label}] {text}')
            for file in own:
                file.write(stamp, text)
        return [self._tell(file) for file in (self._all, *own) if self._has_just_failed(file)]

    def close(self) -> None:
        """Close the files."""
        for file in (self._all, *self._of.values()):
            file.close()

    def _has_just_failed(self, file: LogFile) -> bool:
        return file.fault is not None and file not in self._told

    def _tell(self, file: LogFile) -> str:
        self._told.add(file)
        return f'{file.baseFilename} cannot be written any more: {file.fault}'


def _name(label: str) -> str:
    return f'{label.strip("/").replace("/", ".")}.log'
