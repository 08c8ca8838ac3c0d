"""The C++ runtime of a generated package: its own copy, or the package ``deros_runtime_cpp``.

The sources of that package are in this folder; its headers and its namespace have its name.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from deros.generators.api.protocol import File, OptionError, Options
from deros.generators.runtime.interface import (
    CPP_RUNTIME,
    RuntimeSource,
    runtime_source,
)
from deros.generators.text.cpp import mark_long_lines
from deros.generators.text.notice import licensed_cpp

_NOTICE = licensed_cpp("", "")
"""The text above each of its sources."""


@dataclass(frozen=True, slots=True)
class CppRuntime:
    """The runtime as one generated package uses it.

    A part of the runtime is a header and, for most parts, a source of the same name.

    Attributes:
        package: the generated package.
        linked: whether it links ``deros_runtime_cpp``, and carries no copy.
    """

    package: str
    linked: bool = False

    def header(self, part: str) -> str:
        """Return the path by which a part is included."""
        return f"{CPP_RUNTIME if self.linked else f'{self.package}/runtime'}/{part}.hpp"

    def sources(self, parts: Iterable[str]) -> tuple[str, ...]:
        """Return the sources that the package compiles of some parts, relative to the package."""
        if self.linked:
            return ()
        return tuple(f"src/runtime/{part}.cpp" for part in parts if _has_source(part))

    def files(self, parts: Iterable[str], notice: str = "") -> dict[str, File]:
        """Return the files that the package carries of some parts.

        Args:
            parts: the names of the parts.
            notice: the text above each file.
        """
        if self.linked:
            return {}
        files: dict[str, File] = {}
        for part in parts:
            header = f"{self.package}/include/{self.package}/runtime/{part}.hpp"
            files[header] = self._file(f"{part}.hpp", notice)
            if _has_source(part):
                source = f"{self.package}/src/runtime/{part}.cpp"
                files[source] = self._file(f"{part}.cpp", notice)
        return files

    @property
    def alias(self) -> str:
        """The declaration that names the runtime in the package's namespace; none for a copy."""
        return f"namespace runtime = {CPP_RUNTIME};" if self.linked else ""

    def _file(self, name: str, notice: str) -> File:
        return File(mark_long_lines(licensed_cpp(copied_text(name, self.package), notice)))


def cpp_runtime(package: str, options: Options) -> CppRuntime:
    """Return the runtime as the option ``runtime`` asks for it.

    Raises:
        OptionError: if the option cannot be read, or the package has the runtime's name.
    """
    linked = runtime_source(options) is RuntimeSource.PACKAGE
    if linked and package == CPP_RUNTIME:
        raise OptionError(f"package {package!r} has the name of the runtime that it depends on")
    return CppRuntime(package, linked)


def copied_text(name: str, package: str) -> str:
    """Return a header or source, by its file name, in the namespace ``runtime`` of a package."""
    text = _path(name).read_text(encoding="utf-8").removeprefix(_NOTICE)
    text = text.replace(f"{CPP_RUNTIME.upper()}__", f"{package}__runtime__".upper())
    text = text.replace(f"{CPP_RUNTIME}/", f"{package}/runtime/")
    return text.replace(CPP_RUNTIME, f"{package}::runtime")


def _path(name: str) -> Path:
    folder = Path(__file__).parent
    return folder / (f"include/{CPP_RUNTIME}" if name.endswith(".hpp") else "src") / name


def _has_source(part: str) -> bool:
    return _path(f"{part}.cpp").is_file()
