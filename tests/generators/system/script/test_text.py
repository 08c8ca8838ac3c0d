"""The text of the script: complete, deterministic, lint-clean."""

from __future__ import annotations

import ast
import inspect
import os
import stat
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest

from deros import codes
from deros.generators.api.protocol import Context, GenerationError
from deros.generators.builtin import rossystem_script
from deros.generators.output.writer import write
from deros.generators.system.script.assemble import module_names
from deros.metamodels.load import Repository
from tests.support.golden import Golden
from tests.support.golden_runtime import without_modules
from tests.support.lint import assert_lint_clean
from tests.support.rules import embedded_store
from tests.support.systems import CONTEXT, EVERYTHING, load, load_text

STANDALONE = "deros/generators/system/script/standalone"


def test_script_matches_golden(golden: Golden) -> None:
    """The text for a system with every construct matches the reviewed one.

    The code that is the same in all scripts is compared with the modules that it comes from.
    """
    files = rossystem_script(load(EVERYTHING), CONTEXT)
    golden.check(
        "rossystem_script",
        {path: replace(file, text=without_modules(file.text)) for path, file in files.items()},
    )


def test_script_needs_only_the_standard_library() -> None:
    """Every import is of a module of Python."""
    (file,) = rossystem_script(load(EVERYTHING), CONTEXT).values()
    imported = {
        name.partition(".")[0]
        for node in ast.walk(ast.parse(file.text))
        for name in (
            [alias.name for alias in node.names]
            if isinstance(node, ast.Import)
            else [node.module or ""]
            if isinstance(node, ast.ImportFrom)
            else []
        )
    }
    assert imported <= sys.stdlib_module_names


def test_script_passes_the_ament_linters(tmp_path: Path) -> None:
    """flake8 and pep257 with ament's settings find nothing, even with difficult values."""
    write(rossystem_script(load(EVERYTHING), CONTEXT), tmp_path)
    assert_lint_clean(tmp_path)


@pytest.mark.parametrize("name", ["Logging", "signal", "Token", "Rclpy", "LifecycleMsgs"])
def test_script_that_hides_a_module_is_refused(tmp_path: Path, name: str) -> None:
    """Its own folder is searched first, so that it would import itself."""
    context = Context(embedded_store(), Repository())
    with pytest.raises(GenerationError) as caught:
        rossystem_script(load_text(tmp_path, f"system {name}"), context)
    (finding,) = caught.value.diagnostics
    assert (finding.code, finding.span.text) == (codes.SHADOWED_MODULE, name)
    assert rossystem_script(load_text(tmp_path, f"system {name}Robot"), context)


def test_script_is_executable(tmp_path: Path) -> None:
    """It has an interpreter line before the banner."""
    write(rossystem_script(load(EVERYTHING), CONTEXT), tmp_path)
    script = tmp_path / "every_thing.py"
    assert script.stat().st_mode & stat.S_IXUSR
    done = subprocess.run(
        [script, "--help"], capture_output=True, text=True, env={"PATH": os.environ["PATH"]}
    )
    assert done.returncode == 0
    assert "Run the nodes of EveryThing." in done.stdout


def test_every_standalone_module_is_part_of_the_script() -> None:
    """A new module cannot be forgotten."""
    import deros.generators.system.script.standalone as package

    folder = Path(package.__path__[0])
    everything = module_names(*[True] * len(inspect.signature(module_names).parameters))
    assert sorted(everything) == sorted(
        path.relative_to(folder).with_suffix("").as_posix() for path in folder.rglob("[a-z]*.py")
    )
