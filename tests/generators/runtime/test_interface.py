"""The runtime as a copy in generated packages, and as a ROS 2 package."""

from __future__ import annotations

import ast
import re
from pathlib import Path
from typing import Any

import pytest

from deros import __version__
from deros.generators.api.protocol import Context, File, Files
from deros.generators.builtin import deros_python
from deros.generators.runtime.interface import (
    PYTHON_RUNTIME,
    RuntimeSource,
    runtime_names,
    runtime_package,
    runtime_source,
    with_runtime,
)
from deros.generators.runtime.python.deros_runtime.report_types import EventKind
from deros.generators.runtime.python.interface import python_runtime
from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository

MODELS = Path(__file__).parents[1]
EVERY_THING = MODELS / "safety_node/python/models/every_thing.deros"
GATES = MODELS / "gate/python/models/gates.deros"


def generated(path: Path, **options: str) -> Files:
    """Return the files of a safety package."""
    repository = Repository()
    model = repository.load(path).model
    return deros_python(model, Context(InterfaceStore(), repository), options)


def imported(text: str) -> set[str]:
    """Return the modules that a text imports."""
    statements = [node for node in ast.walk(ast.parse(text)) if isinstance(node, ast.ImportFrom)]
    return {node.module for node in statements if node.module and not node.level}


def test_runtime_package_has_the_version_of_deros() -> None:
    """Manifest, setup.py and module agree."""
    files = runtime_package(PYTHON_RUNTIME)
    for name, pattern in (
        ("package.xml", "<version>(.*)</version>"),
        ("setup.py", "version='(.*)'"),
        ("deros_runtime/__init__.py", "__version__ = '(.*)'"),
    ):
        assert re.findall(pattern, files[f"{PYTHON_RUNTIME}/{name}"].text) == [__version__]


def test_runtime_package_contains_only_its_own_files() -> None:
    """Linter settings and compiled modules are omitted; the py.typed marker is included."""
    files = runtime_package(PYTHON_RUNTIME)
    assert f"{PYTHON_RUNTIME}/deros_runtime/py.typed" in files
    assert not [path for path in files if path.endswith((".toml", ".pyc"))]
    assert not {f"{PYTHON_RUNTIME}/__init__.py", f"{PYTHON_RUNTIME}/interface.py"} & set(files)


@pytest.mark.parametrize("rules", [EVERY_THING, GATES], ids=["every_thing", "gates"])
def test_package_without_a_copy_imports_the_runtime_package(rules: Path) -> None:
    """Both variants otherwise have the same files, and use the same modules of the runtime."""
    copied, bare = generated(rules, runtime="copy"), generated(rules)
    package = next(iter(copied)).split("/")[0]
    runtime = {
        path.removeprefix(f"{PYTHON_RUNTIME}/deros_runtime/")
        for path in runtime_package(PYTHON_RUNTIME)
        if path.startswith(f"{PYTHON_RUNTIME}/deros_runtime/")
    }
    folder = f"{package}/{package}/"
    carried = {path for path in copied if path.removeprefix(folder) in runtime - {"__init__.py"}}
    assert carried
    assert set(copied) - set(bare) == carried
    assert set(bare) <= set(copied)
    for path, file in bare.items():
        if not path.startswith(folder) or not path.endswith(".py"):
            continue
        ours = imported(file.text)
        theirs = imported(copied[path].text)
        moved = {name.replace("deros_runtime", package) for name in ours}
        assert moved == theirs or path.endswith("__init__.py")


def test_manifest_requires_the_exact_version() -> None:
    """A package with a copy has no such dependency."""
    path = "every_thing_safety/package.xml"
    depend = f'<depend version_eq="{__version__}">deros_runtime</depend>'
    assert depend in generated(EVERY_THING)[path].text
    assert PYTHON_RUNTIME not in generated(EVERY_THING, runtime="copy")[path].text


def test_package_is_the_default_of_safety_packages() -> None:
    """Stating it changes nothing; other nodes have no such option, and carry a copy."""
    assert runtime_source({}) is RuntimeSource.COPY
    assert generated(EVERY_THING, runtime="package") == generated(EVERY_THING)
    assert generated(EVERY_THING, runtime="copy") != generated(EVERY_THING)


def test_packages_are_joined_with_the_runtime_that_they_need() -> None:
    """It depends on the manifests; a manifest that cannot be read needs none."""
    files = generated(EVERY_THING)
    assert runtime_names(files) == (PYTHON_RUNTIME,)
    assert with_runtime(files) == {**files, **runtime_package(PYTHON_RUNTIME)}
    copied = generated(EVERY_THING, runtime="copy")
    assert with_runtime(copied) == copied
    assert runtime_names({"other/package.xml": File("<package>")}) == ()


def test_unknown_source_is_rejected() -> None:
    """The message names both valid values."""
    with pytest.raises(ValueError, match="'link' is neither 'copy' nor 'package'"):
        runtime_source({"runtime": "link"})


def test_package_with_the_name_of_the_runtime_is_rejected() -> None:
    """It would hide its own dependency; with a copy the name is valid."""
    with pytest.raises(ValueError, match="has the name of the runtime"):
        python_runtime(PYTHON_RUNTIME, {"runtime": "package"})
    assert python_runtime(PYTHON_RUNTIME, {}).version == ""


def test_monitors_have_the_event_kinds_of_the_runtime() -> None:
    """The two classes are compared by value, so each member has to be in both."""
    monitor: dict[str, Any] = {"__name__": "monitor"}
    exec(generated(EVERY_THING)["every_thing_safety/every_thing_safety/monitor.py"].text, monitor)
    kinds = {kind.name: kind.value for kind in monitor["EventKind"]}
    assert kinds == {kind.name: kind.value for kind in EventKind}
    assert all(kind == EventKind[kind.name] for kind in monitor["EventKind"])
