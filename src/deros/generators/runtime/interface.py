"""The runtime in Python as files of a package."""

from __future__ import annotations

from collections.abc import Iterable
from importlib import resources

from deros.generators.api.protocol import File
from deros.generators.text.notice import licensed_python


def python_runtime(package: str, modules: Iterable[str], notice: str = "") -> dict[str, File]:
    """Return modules of the package ``deros_runtime`` as files of a package."""
    folder = resources.files("deros.generators.runtime.python") / "deros_runtime"
    return {
        f"{package}/{package}/{module}.py": File(
            licensed_python((folder / f"{module}.py").read_text(encoding="utf-8"), notice)
        )
        for module in modules
    }
