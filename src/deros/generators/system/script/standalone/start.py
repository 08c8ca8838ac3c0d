"""Where the system is started: what its descriptions look up there."""

from __future__ import annotations

from collections.abc import Sequence
import itertools
import os
from pathlib import Path
import sys


class Start:
    """Variables of the environment, the share folders of packages, and a folder of our own."""

    def __init__(self, file: str, words: Sequence[str] | None = None) -> None:
        """Look up for a file that starts the system, with these words of its command line."""
        self.this_dir = Path(file).resolve().parent.as_posix()
        self._words = list(sys.argv[1:] if words is None else words)

    def env(self, name: str, default: str | None = None) -> str:
        """Return a variable of the environment; raise ValueError if it is not set."""
        value = os.environ.get(name, default)
        if value is None:
            raise ValueError(f'the environment variable {name!r} is not set')
        return value

    def share(self, package: str) -> str:
        """Return the share folder of a package; raise ValueError if it is not installed."""
        for prefix in self._prefixes():
            for folder in (prefix, prefix / package):
                if (folder / 'share' / package).is_dir():
                    return (folder / 'share' / package).as_posix()
        raise ValueError(
            f'package {package!r} is not installed: source its setup file, or name its install '
            'space with --install'
        )

    def _prefixes(self) -> list[Path]:
        given = []
        for word, behind in itertools.zip_longest(self._words, self._words[1:], fillvalue=''):
            option, is_joined, value = word.partition('=')
            if option in ('--package-path', '--install'):
                given.append(value if is_joined else behind)
        for variable in ('DEROS_PACKAGE_PATH', 'AMENT_PREFIX_PATH'):
            given += os.environ.get(variable, '').split(os.pathsep)
        return [Path(folder).absolute() for folder in given if folder]
