"""The runtime: code that is the same in all generated packages, as a copy or as a package.

The package of a safety node depends on the ROS 2 package ``deros_runtime`` or
``deros_runtime_cpp``, in the very version that it was generated for. With the option ``runtime``,
it carries a copy of the modules that it needs instead, so that what is certified is complete in
itself. The package of other nodes, which needs few of them, always carries a copy.
"""

from __future__ import annotations

import enum
import xml.etree.ElementTree as ElementTree
from pathlib import Path

from deros import __version__
from deros.generators.api.protocol import File, Files, OptionError, Options
from deros.generators.user_files.manifest import named

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
    """Return what the option ``runtime`` says; a copy if it is absent, as it is for most nodes.

    Raises:
        OptionError: if it is neither ``copy`` nor ``package``.
    """
    text = options.get("runtime", RuntimeSource.COPY.value)
    try:
        return RuntimeSource(text)
    except ValueError:
        known = " nor ".join(repr(source.value) for source in RuntimeSource)
        raise OptionError(f"runtime {text!r} is neither {known}") from None


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


def runtime_names(files: Files) -> tuple[str, ...]:
    """Return the names of the runtime packages that generated packages depend on.

    Args:
        files: the packages, by path relative to their common folder.
    """
    manifests = [file for path, file in files.items() if path.partition("/")[2] == "package.xml"]
    depended = {name for manifest in manifests for name in _depended(manifest.text)}
    return tuple(name for name in _FOLDERS if name in depended)


def with_runtime(files: Files) -> Files:
    """Return generated packages and the runtime packages that they depend on, side by side."""
    packages = {
        path: file for name in runtime_names(files) for path, file in runtime_package(name).items()
    }
    return {**files, **packages}


def _depended(manifest: str) -> set[str]:
    try:
        return named(ElementTree.fromstring(manifest))
    except (ElementTree.ParseError, ValueError):  # of somebody else's generator
        return set()


def _is_of_package(path: Path) -> bool:
    if str(path) in _OURS or path.name == "ruff.toml" or path.suffix == ".pyc":
        return False
    return not any(part.startswith(".") or part == "__pycache__" for part in path.parts)
