"""The runtime: code that is the same in all generated packages, as a copy or as a package.

By default, a generated package carries a copy of the modules that it needs, so that what is
certified is complete in itself. With the option ``runtime``, it depends on the ROS 2 package
``deros_runtime`` or ``deros_runtime_cpp`` instead, in the very version that it was generated for.
"""

from __future__ import annotations

import enum
from pathlib import Path

from deros import __version__
from deros.generators.api.protocol import File, Files, Options

PYTHON_RUNTIME = "deros_runtime"
CPP_RUNTIME = "deros_runtime_cpp"
"""The names of the ROS 2 packages."""

RUNTIME_VERSION = __version__
"""The version of both packages; a generated package takes no other."""

_FOLDERS = {PYTHON_RUNTIME: "python", CPP_RUNTIME: "cpp"}
_OURS = ("__init__.py", "interface.py")
"""Modules at the top of a package's folder that make it a part of deros."""


class RuntimeSource(enum.Enum):
    """Where a generated package takes the runtime from."""

    COPY = "copy"
    PACKAGE = "package"


def runtime_source(options: Options) -> RuntimeSource:
    """Return what the option ``runtime`` says.

    Raises:
        ValueError: if it is neither ``copy`` nor ``package``.
    """
    text = options.get("runtime", RuntimeSource.COPY.value)
    try:
        return RuntimeSource(text)
    except ValueError:
        known = " nor ".join(repr(source.value) for source in RuntimeSource)
        raise ValueError(f"runtime {text!r} is neither {known}") from None


def runtime_packages() -> Files:
    """Return the ROS 2 packages of the runtime, in both languages."""
    return {path: file for name in _FOLDERS for path, file in runtime_package(name).items()}


def runtime_package(name: str) -> Files:
    """Return one ROS 2 package of the runtime, :data:`PYTHON_RUNTIME` or :data:`CPP_RUNTIME`."""
    folder = Path(__file__).with_name(_FOLDERS[name])
    return {
        f"{name}/{path.relative_to(folder).as_posix()}": File(path.read_text(encoding="utf-8"))
        for path in sorted(folder.rglob("*"))
        if path.is_file() and _is_of_package(path.relative_to(folder))
    }


def _is_of_package(path: Path) -> bool:
    if str(path) in _OURS or path.name == "ruff.toml" or path.suffix == ".pyc":
        return False
    return not any(part.startswith(".") or part == "__pycache__" for part in path.parts)
