"""Runs the generated script of a system in this process, without leaving it behind."""

from __future__ import annotations

import runpy
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

from deros.generators.system.script.generate import script_files
from deros.models.system import System


def run_generated_script(system: System, program: str, arguments: Sequence[str]) -> int:
    """Run the script of a system, and return its exit code.

    Args:
        system: checked, and not yet resolved.
        program: what the script calls itself in what it says about its command line.
        arguments: of its command line.

    Raises:
        GenerationError: if there is no script for the system.
    """
    files = script_files(system)
    with tempfile.TemporaryDirectory(prefix="deros-up-") as folder:
        for path, found in files.items():
            file = Path(folder, path)
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(found.text, encoding="utf-8", newline="")
        sys.argv = [program, *arguments]
        try:
            runpy.run_path(str(Path(folder, next(iter(files)))), run_name="__main__")
        except SystemExit as end:
            return end.code if isinstance(end.code, int) else 1
    return 0
