"""The modules that are the same in every package, kept as files that are checked and tested."""

from __future__ import annotations

from collections.abc import Iterable
from importlib import resources

from deros.generators.protocol import File
from deros.generators.rosnode_python.generate import licensed


def runtime_files(
    package: str, modules: Iterable[str], copyright_line: str = ""
) -> dict[str, File]:
    """Return modules of :mod:`deros.generators.safety_python.runtime` as files of a package."""
    folder = resources.files("deros.generators.safety_python.runtime")
    return {
        f"{package}/{package}/{module}.py": File(
            licensed((folder / f"{module}.py").read_text(encoding="utf-8"), copyright_line)
        )
        for module in modules
    }
