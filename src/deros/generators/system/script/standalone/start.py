"""Where the system is started: what its descriptions look up there."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
import os
from pathlib import Path
import sys

from .command import PACKAGE_PATH
from .programs import programs_of


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
        folder = self._folder(package)
        if folder is None:
            raise ValueError(
                f'package {package!r} is not installed: source its setup file, or name its '
                'install space with --install'
            )
        return folder.as_posix()

    def installed(self, package: str) -> bool:
        """Tell whether a package is installed."""
        return self._folder(package) is not None

    def _folder(self, package: str) -> Path | None:
        parser = argparse.ArgumentParser(add_help=False)
        parser.add_argument(*PACKAGE_PATH, dest='folders', type=Path, action='append', default=[])
        options, _ = parser.parse_known_args(self._words)
        return programs_of(options.folders, os.environ).share(package)
