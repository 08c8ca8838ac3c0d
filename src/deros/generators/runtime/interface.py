"""The runtime as files of a package: modules in Python, headers and sources in C++."""

from __future__ import annotations

from collections.abc import Iterable
from importlib import resources

from deros.generators.api.protocol import File
from deros.generators.text.notice import licensed_cpp, licensed_python

_CPP = "deros.generators.runtime.cpp"
_NAMESPACE = "deros_runtime"


def python_runtime(package: str, modules: Iterable[str], notice: str = "") -> dict[str, File]:
    """Return modules of the package ``deros_runtime`` as files of a package."""
    folder = resources.files("deros.generators.runtime.python") / "deros_runtime"
    return {
        f"{package}/{package}/{module}.py": File(
            licensed_python((folder / f"{module}.py").read_text(encoding="utf-8"), notice)
        )
        for module in modules
    }


def cpp_runtime(package: str, names: Iterable[str], notice: str = "") -> dict[str, File]:
    """Return parts of :mod:`deros.generators.runtime.cpp`, each a header, most with a source."""
    return {
        path: File(licensed_cpp(cpp_runtime_text(name, package), notice))
        for each in names
        for path, name in _paths(package, each).items()
    }


def cpp_sources(names: Iterable[str]) -> tuple[str, ...]:
    """Return the sources of parts of the runtime, relative to the package."""
    return tuple(f"src/runtime/{name}.cpp" for name in names if _has_source(name))


def cpp_runtime_text(name: str, package: str) -> str:
    """Return one file of the runtime in C++ in the namespace ``runtime`` of a package."""
    text = (
        (resources.files(_CPP) / name)
        .read_text(encoding="utf-8")
        .replace(_NAMESPACE.upper(), package.upper())
    )
    text = text.replace(f"{_NAMESPACE}/", f"{package}/")
    return text.replace(_NAMESPACE, f"{package}::runtime")


def _paths(package: str, name: str) -> dict[str, str]:
    paths = {f"{package}/include/{package}/runtime/{name}.hpp": f"{name}.hpp"}
    if _has_source(name):
        paths[f"{package}/src/runtime/{name}.cpp"] = f"{name}.cpp"
    return paths


def _has_source(name: str) -> bool:
    return (resources.files(_CPP) / f"{name}.cpp").is_file()
