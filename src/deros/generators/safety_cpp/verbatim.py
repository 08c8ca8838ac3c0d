"""The sources that are the same in every package, kept as files that are compiled and tested."""

from __future__ import annotations

from collections.abc import Iterable
from importlib import resources

from deros.generators.cpp_source import runtime_in_package
from deros.generators.protocol import File
from deros.generators.rosnode_cpp.generate import licensed

_HEADERS_ONLY = ("descriptor", "refusal")
_SOURCES = (
    *("agenda", "clock_choice", "diagnostics", "events", "guardian", "instance", "latches"),
    *("machine", "ports", "process", "publishers", "regular_file", "sha256", "siblings"),
    *("simulated", "start_order", "text", "told", "watch", "worker"),
)


def runtime_sources(names: Iterable[str] = _SOURCES) -> tuple[str, ...]:
    """Return the sources that a library is made of, relative to the package."""
    return tuple(f"src/runtime/{name}.cpp" for name in names)


def runtime_files(package: str, copyright_line: str = "") -> dict[str, File]:
    """Return the files of :mod:`deros.generators.safety_cpp.runtime` as files of a package."""
    files: dict[str, File] = {}
    for name in (*_HEADERS_ONLY, *_SOURCES):
        header = f"{package}/include/{package}/runtime/{name}.hpp"
        files[header] = File(licensed(runtime_text(f"{name}.hpp", package), copyright_line))
    for name in _SOURCES:
        source = f"{package}/src/runtime/{name}.cpp"
        files[source] = File(licensed(runtime_text(f"{name}.cpp", package), copyright_line))
    return files


def runtime_text(name: str, package: str, generator: str = "safety_cpp") -> str:
    """Return one file of a generator's runtime in the namespace ``runtime`` of a package."""
    folder = resources.files(f"deros.generators.{generator}.runtime")
    return runtime_in_package((folder / name).read_text(encoding="utf-8"), package)
