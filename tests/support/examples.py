"""The examples' own modules, which lie in the packages that they are part of."""

from __future__ import annotations

import functools
import importlib
import sys
from pathlib import Path
from typing import Any

from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from deros.models.rules import Rules
from deros.rules.compiler.build import build
from deros.rules.program.ir import Program

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"


def example_module(example: str, name: str) -> Any:
    """Import a module of an example: of its demonstration, or of a package under ``src``."""
    folder = EXAMPLES / example
    for path in [folder, *sorted(folder.glob("src/*"))]:
        if str(path) not in sys.path:
            sys.path.append(str(path))
    return importlib.import_module(name)


@functools.cache
def example_program(example: str) -> Program:
    """Return the program of an example's rules."""
    rules = Repository().load(str(EXAMPLES / example / f"{example}.deros")).model
    assert isinstance(rules, Rules)
    built = build(rules, InterfaceStore())
    assert built.program is not None
    return built.program
