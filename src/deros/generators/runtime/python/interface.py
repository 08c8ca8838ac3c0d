"""The Python runtime of a generated package: its own copy, or the package ``deros_runtime``."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from deros.generators.api.protocol import File, OptionError, Options
from deros.generators.runtime.interface import (
    PYTHON_RUNTIME,
    RUNTIME_VERSION,
    RuntimeSource,
    runtime_source,
)
from deros.generators.text.notice import licensed_python


@dataclass(frozen=True, slots=True)
class PythonRuntime:
    """The runtime as a generated Python package sees it.

    Attributes:
        module: the package that the modules of the runtime are imported from.
        version: of ``deros_runtime``, which the package depends on; empty if it has a copy.
        notice: copyright and licence of the generated package.
    """

    module: str
    version: str = ""
    notice: str = ""

    def files(self, package: str, modules: Iterable[str]) -> dict[str, File]:
        """Return the copies of modules that a package carries."""
        if self.version:
            return {}
        return {
            f"{package}/{package}/{module}.py": File(licensed_python(_text(module), self.notice))
            for module in modules
        }


def python_runtime(package: str, options: Options, notice: str = "") -> PythonRuntime:
    """Return where a generated Python package takes the runtime from.

    Raises:
        OptionError: if the option ``runtime`` cannot be read, or the package is called like the
            runtime.
    """
    if runtime_source(options) is RuntimeSource.COPY:
        return PythonRuntime(package, notice=notice)
    if package == PYTHON_RUNTIME:
        raise OptionError(f"package {package!r} has the name of the runtime that it depends on")
    return PythonRuntime(PYTHON_RUNTIME, RUNTIME_VERSION, notice)


def _text(module: str) -> str:
    path = Path(__file__).parent / PYTHON_RUNTIME / f"{module}.py"
    return path.read_text(encoding="utf-8")
