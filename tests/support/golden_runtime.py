"""The runtime in generated text: what each copy has to be, so that no golden file repeats it."""

from __future__ import annotations

import ast
import re
from pathlib import Path, PurePosixPath

from deros.generators.api.protocol import File, Files, Owner

_GENERATORS = Path(__file__).resolve().parents[2] / "src/deros/generators"
_CPP = _GENERATORS / "runtime/cpp"
_PYTHON = _GENERATORS / "runtime/python/deros_runtime"
_SCRIPT = _GENERATORS / "system/script/standalone"

_RENAMED = (
    (r'(?<=#include ")deros_runtime_cpp/', "{package}/runtime/"),
    (r"\bnamespace deros_runtime_cpp$", "namespace {package}::runtime"),
    (r"\bDEROS_RUNTIME_CPP(?=__\w+_HPP_$)", "{PACKAGE}__RUNTIME"),
)
"""All that differs between a C++ file of the runtime and its copy in a package: the package."""


def is_copy(path: str) -> bool:
    """Return whether a file of a package is a copy of a file of the runtime."""
    return _source(path) is not None


def assert_copies(files: Files) -> None:
    """Hold each copy of the runtime among some files against the file that it is a copy of."""
    for path, file in files.items():
        source = _source(path)
        if source is not None:
            package = path.partition("/")[0]
            text = source.read_text(encoding="utf-8")
            assert file == File(_renamed(text, package), Owner.GENERATOR), path


def without_modules(script: str) -> str:
    """Return the script of a system with the name of each standalone module in place of its code.

    A module that is lacking, or that differs from its file, changes the text that is returned.
    """
    for path in sorted(_SCRIPT.rglob("[a-z]*.py")):
        text = path.read_text(encoding="utf-8")
        imports = [s for s in ast.parse(text).body if isinstance(s, (ast.Import, ast.ImportFrom))]
        code = "\n".join(text.splitlines()[imports[-1].end_lineno :]).strip("\n")
        script = script.replace(f"\n\n{code}\n", f"\n\n# <{path.relative_to(_SCRIPT)}>\n")
    return script


def _source(path: str) -> Path | None:
    """Return the file of the runtime that a file of a package is a copy of, if it is one."""
    package, name = path.partition("/")[0], PurePosixPath(path).name
    sources = {
        f"{package}/include/{package}/runtime/{name}": _CPP / "include/deros_runtime_cpp" / name,
        f"{package}/src/runtime/{name}": _CPP / "src" / name,
        f"{package}/{package}/{name}": _PYTHON / name,
    }
    source = sources.get(path)
    return source if source and source.is_file() and name != "__init__.py" else None


def _renamed(text: str, package: str) -> str:
    for pattern, form in _RENAMED:
        new = form.format(package=package, PACKAGE=package.upper())
        text = re.sub(pattern, new, text, flags=re.MULTILINE)
    return text
