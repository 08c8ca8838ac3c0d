"""Files that are made before anything is started, and removed when all has ended."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
import contextlib
from dataclasses import dataclass, field, replace
import os
from pathlib import Path
import secrets
import shlex
import shutil
import tempfile

from ..node import Preparation
from .below import moved
from .substituting import substituted
from .under import put_under
from .xacro import Xacro


@dataclass(frozen=True)
class FileOfXacro:
    """What xacro makes of a file."""

    xacro: Xacro

    @property
    def file(self) -> str:
        """Return the file that it is made of."""
        return self.xacro.file

    @property
    def name(self) -> str:
        """Return its name: programs look at what it ends with."""
        return Path(self.file).name.removesuffix('.xacro')

    def located(self, locate: Callable[[str], str]) -> FileOfXacro:
        """Return it as it is found, given where a file is."""
        return FileOfXacro(replace(self.xacro, file=locate(self.file)))

    def text(self, environment: dict[str, str]) -> str:
        """Return what it says; raise ValueError, with the words of xacro, if it cannot be made."""
        return self.xacro.text(environment)

    def by_hand(self, path: str) -> str:
        """Return the command that makes it in bash."""
        folder = shlex.quote(str(Path(path).parent))
        return f'mkdir -p {folder} && {shlex.join(self.xacro.command)} > {shlex.quote(path)}'


_OTHER_LINE_ENDS = '\r\x85\u2028\u2029'


@dataclass(frozen=True)
class TextFile:
    """
    A parameter file, beside this file or share:PACKAGE/PATH, with its text under keys.

    Before that, the given values are put into it, if there are any.
    """

    file: str
    keys: tuple[str, ...] = ()
    given: Mapping[str, str] | None = None
    locate: Callable[[str], str] = field(default=str, compare=False)

    @property
    def name(self) -> str:
        """Return the name of what is made of it."""
        return Path(self.file).name

    def located(self, locate: Callable[[str], str]) -> TextFile:
        """Return it as it is found, given where a file is."""
        return replace(self, file=locate(self.file), locate=locate)

    def text(self, environment: dict[str, str]) -> str:
        """Return what is made of it; raise ValueError if it cannot be read."""
        try:
            text = Path(self.file).read_bytes().decode()
            if self.given is not None:
                text = substituted(text, self.given, environment, self._share)
            return put_under(text, self.keys) if self.keys else text
        except (OSError, ValueError) as fault:
            raise ValueError(f'{self.file}: {fault}') from None

    def _share(self, package: str) -> str:
        found = self.locate(f'share:{package}/')
        if found.startswith('share:'):
            raise ValueError(f'package {package!r} is not installed')
        return found

    def by_hand(self, path: str) -> str:
        """Return the command that makes it in bash, or a comment that says why there is none."""
        above = [f'{"  " * depth}{key}:' for depth, key in enumerate(self.keys)]
        quoted = ' '.join(shlex.quote(line) for line in above)
        indented = f"sed 's/^/{'  ' * len(above)}/' {shlex.quote(self.file)}"
        command = f"(printf '%s\\n' {quoted}; {indented})"
        try:
            text = self.text(dict(os.environ))
        except ValueError as fault:
            if self.given is not None or Path(self.file).is_file():
                return f'# {fault}'
        else:
            if self.given is not None or not _is_indented(text, above):
                command = f"printf '%s' {shlex.quote(text)}"
        folder = shlex.quote(str(Path(path).parent))
        return f'mkdir -p {folder} && {command} > {shlex.quote(path)}'


MadeFile = TextFile | FileOfXacro


def _is_indented(text: str, above: Sequence[str]) -> bool:
    """Tell whether lines with keys, and all others behind blanks, say what a text says."""
    lines = [line for line in text.split('\n') if line.strip()]
    while lines and lines[0].startswith('#'):
        del lines[0]
    size = len(above)
    indent = '  ' * size
    is_plain = lines[:size] == [*above] and all(line.startswith(indent) for line in lines[size:])
    return is_plain and not any(end in text for end in _OTHER_LINE_ENDS)


class MadeFiles(Preparation):
    """The files that are made for a system, each at a path that is known before."""

    def __init__(self) -> None:
        """Start without files."""
        self._folder = Path(tempfile.gettempdir(), f'deros-{secrets.token_hex(8)}')
        self._files: dict[str, MadeFile] = {}
        self._wanted: dict[str, MadeFile] = {}
        self._texts: dict[str, str] = {}

    def substituted(self, file: str, given: Mapping[str, str]) -> str:
        """Return the path of a parameter file with these values for $(var NAME) in it."""
        return self._path(TextFile(file, given=given))

    def below(self, file: str, namespace: str) -> str:
        """
        Return the path of a parameter file with its keys below a namespace.

        Below an empty one, it is the file itself; raise ValueError if that is not a namespace.
        """
        if not namespace:
            return file
        moved('', namespace)
        return self._path(replace(self._source(file), keys=(namespace,)))

    def plain(self, file: str, parameter: str = '') -> str:
        """Return the path of a parameter file for all, made of one that has no names of nodes."""
        keys = ('/**', 'ros__parameters', *filter(None, parameter.split('.')))
        return self._path(replace(self._source(file), keys=keys))

    def _source(self, file: str) -> TextFile:
        """Return what a file is made of, or else the file itself."""
        known = self._files.get(file)
        return known if isinstance(known, TextFile) else TextFile(file)

    def xacro(self, file: str, arguments: Mapping[str, str]) -> str:
        """Return the path of what xacro makes of a file."""
        return self._path(FileOfXacro(Xacro(file, arguments)))

    def _path(self, file: MadeFile) -> str:
        for path, known in self._files.items():
            if known == file:
                return path
        path = str(self._folder / str(len(self._files)) / file.name)
        self._files[path] = file
        return path

    def sources(self, files: Sequence[str], locate: Callable[[str], str]) -> Sequence[str]:
        """Return the files that have to be there for others to be, given where a file is."""
        self._wanted = {
            path: file.located(locate)
            for path, file in self._files.items()
            if path in files or isinstance(file, FileOfXacro)
        }
        others = [file for file in files if file not in self._wanted]
        return [*others, *(file.file for file in self._wanted.values())]

    def by_hand(self) -> Sequence[str]:
        """Return the commands for bash that make the files."""
        return [file.by_hand(path) for path, file in self._wanted.items()]

    def make(self, environment: dict[str, str]) -> None:
        """Make the texts of the files; raise ValueError if one cannot be made."""
        self._texts = {path: file.text(environment) for path, file in self._wanted.items()}

    @contextlib.contextmanager
    def in_place(self) -> Iterator[None]:
        """Have the files in their places."""
        if not self._texts:
            yield
            return
        self._folder.mkdir(mode=0o700)
        try:
            for path, text in self._texts.items():
                Path(path).parent.mkdir()
                Path(path).write_bytes(text.encode())
            yield
        finally:
            shutil.rmtree(self._folder, ignore_errors=True)
