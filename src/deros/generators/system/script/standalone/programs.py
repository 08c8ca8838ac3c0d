"""Finds the programs of packages."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
import contextlib
import itertools
import os
from pathlib import Path
import re
import shlex
import shutil
import sys

from .node import Node, Program, Row

# Python handles SIGINT from its first moment on, by an exception in whatever it imports. So a
# program that runs from its sources is started with SIGINT blocked, and lets it end the process
# until all is imported. From then on SIGINT is a KeyboardInterrupt, until the program handles it:
# one without arguments, unlike what code raises for a reason of its own.
QUIET_START = (
    'import signal, sys; '
    'signal.signal(signal.SIGINT, signal.SIG_DFL); '
    'signal.pthread_sigmask(signal.SIG_UNBLOCK, [signal.SIGINT]); '
    'sys.excepthook = lambda kind, error, trace: kind is KeyboardInterrupt '
    'and not error.args or sys.__excepthook__(kind, error, trace); '
)
IMPORTED = (
    'signal.getsignal(signal.SIGINT) is signal.SIG_DFL '
    'and signal.signal(signal.SIGINT, signal.default_int_handler)'
)


def starts_quietly(command: Sequence[str]) -> bool:
    """Tell whether a program lets SIGINT through by itself, and may be started with it blocked."""
    return len(command) > 2 and command[2].startswith(QUIET_START)


class Programs:
    """
    Finds the programs of packages, as ros2 run does, and the environment that they need.

    A given folder may be an install space of colcon, merged or with a folder for each package, or
    hold the sources of Python packages, which are run as they stand; then comes AMENT_PREFIX_PATH.
    """

    def __init__(self, folders: Sequence[Path], environment: Mapping[str, str]) -> None:
        """Search the folders first, then those of the environment."""
        self._environment = environment
        given = [folder.absolute() for folder in folders]
        below = [entry for folder in given for entry in _folders(folder)]
        self._given = [*given, *below]
        self._prefixes = [folder for folder in self._given if (folder / 'lib').is_dir()]
        self._sources = [folder for folder in self._given if (folder / 'setup.py').is_file()]
        named = environment.get('AMENT_PREFIX_PATH', '').split(os.pathsep)
        self._ambient = [Path(entry) for entry in named if entry]

    def find(self, package: str, executable: str) -> list[str] | None:
        """
        Return the start of the command line, or None when there is no such program.

        A program is a file of the package: a path or a pattern finds none.
        """
        if '/' in executable:
            return None
        for prefix in [*self._prefixes, *self._ambient]:
            folder = prefix / 'lib' / package
            for path in itertools.chain([folder / executable], _nested(folder, executable)):
                if path.is_file() and os.access(path, os.X_OK):
                    return [str(path)]
        for source in self._sources:
            entry = _entry_point(source, package, executable)
            if entry is not None:
                module, function = entry
                named = f'from {module} import {function}; {IMPORTED}'
                return [sys.executable, '-c', f'{QUIET_START}{named}; sys.exit({function}())']
        return None

    def start_of(self, row: Row) -> list[str] | None:
        """Return the start of the command line of a row, or None when there is no such program."""
        if isinstance(row, Program):
            return [row.program] if self._in_path(row.program, row) else None
        return self.find(row.package, row.executable)

    def faults(
        self, row: Row, start: Sequence[str] | None, rows: Sequence[Row] = ()
    ) -> Iterator[str]:
        """
        Yield why a row cannot be started, given the start of its command line, and all rows.

        What a container has that others have started is not known.
        """
        for tool in row.tools if isinstance(row, Node) else ():
            if shutil.which(tool, path=self.environment().get('PATH')) is None:
                yield (
                    f'it needs the program {tool!r}, which is not in the PATH: install '
                    f'ros-$ROS_DISTRO-{tool}'
                )
        if isinstance(row, Node) and row.container:
            ours = any(each.full_name == row.container for each in rows)
            if ours and row.plugin not in self._components(row.package):
                yield f'package {row.package!r} registers no component {row.plugin!r}'
            return
        if start is None:
            yield (
                f'no program {row.program!r} in the PATH'
                if isinstance(row, Program)
                else f'package {row.package!r} has no program {row.executable!r}'
            )
        for package in row.needs if isinstance(row, Program) else ():
            if self.share(package) is None:
                yield f'it needs the package {package!r}, which is not installed'
        for word in shlex.split(row.prefix)[:1]:
            if not self._in_path(word, row):
                yield f'its prefix needs the program {word!r}, which is not in the PATH'
        if isinstance(row, Program) and row.folder and not Path(row.folder).is_dir():
            yield f'there is no folder {row.folder!r}'

    def _in_path(self, program: str, row: Row) -> bool:
        """Tell whether there is a program; a path is relative to the folder that it runs in."""
        folder = row.folder if isinstance(row, Program) else ''
        path = {**self.environment(), **row.environment}.get('PATH')
        where = str(Path(folder, program)) if '/' in program else program
        return shutil.which(where, path=path) is not None

    def _components(self, package: str) -> Iterator[str]:
        """Yield the classes that a package registers with rclcpp_components."""
        for prefix in [*self._given, *self._ambient]:
            index = prefix / 'share' / 'ament_index' / 'resource_index' / 'rclcpp_components'
            with contextlib.suppress(OSError):
                lines = (index / package).read_text(encoding='utf-8').splitlines()
                yield from (line.partition(';')[0] for line in lines)
                return

    def share(self, package: str) -> Path | None:
        """Return the share folder of a package, or None when it is not installed."""
        # A package may install nothing else: no lib, as in a package of descriptions.
        folders = (prefix / 'share' / package for prefix in [*self._given, *self._ambient])
        return next((folder for folder in folders if folder.is_dir()), None)

    def environment(self) -> dict[str, str]:
        """Return the environment of the nodes: ours, with the given folders in front."""
        made = {**self._environment, **self.additions()}
        # Through a pipe Python would hold back its output until a block of it is full.
        made.setdefault('PYTHONUNBUFFERED', '1')
        return made

    def additions(self) -> dict[str, str]:
        """Return the variables that the given folders add to, with their new values."""
        python = [path for prefix in self._prefixes for path in _python_folders(prefix)]
        in_front = {
            'AMENT_PREFIX_PATH': self._prefixes,
            'PATH': [prefix / 'bin' for prefix in self._prefixes],
            'LD_LIBRARY_PATH': [prefix / 'lib' for prefix in self._prefixes],
            'PYTHONPATH': [*self._sources, *python],
        }
        made = {}
        for name, paths in in_front.items():
            entries = [str(path) for path in paths if path.is_dir()]
            if entries:
                before = filter(None, [self._environment.get(name)])
                made[name] = os.pathsep.join([*entries, *before])
        return made


def programs_of(given: Sequence[Path], environment: Mapping[str, str]) -> Programs:
    """Return the programs of given folders, of DEROS_PACKAGE_PATH, and of AMENT_PREFIX_PATH."""
    named = filter(None, environment.get('DEROS_PACKAGE_PATH', '').split(os.pathsep))
    return Programs([*given, *map(Path, named)], environment)


def _folders(folder: Path) -> list[Path]:
    return sorted(entry for entry in folder.iterdir() if entry.is_dir()) if folder.is_dir() else []


def _nested(folder: Path, executable: str) -> Iterator[Path]:
    holders = (Path(path) for path, _, files in os.walk(folder) if executable in files)
    yield from sorted(holder / executable for holder in holders)


def _python_folders(prefix: Path) -> list[Path]:
    version = f'python{sys.version_info.major}.{sys.version_info.minor}'
    site = prefix / 'lib' / version / 'site-packages'
    return [site, prefix / 'local' / 'lib' / version / 'dist-packages']


def _entry_point(source: Path, package: str, executable: str) -> tuple[str, str] | None:
    """Return the function of a program from the setup.py or setup.cfg of a source package."""
    if source.name != package and not (source / package).is_dir():
        return None
    pattern = re.compile(rf'(?<![\w.-]){re.escape(executable)}\s*=\s*([\w.]+)\s*:\s*(\w+)')
    for name in ('setup.py', 'setup.cfg'):
        with contextlib.suppress(OSError):
            found = pattern.search((source / name).read_text(encoding='utf-8'))
            if found is not None:
                return found[1], found[2]
    return None
