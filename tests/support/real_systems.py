"""The models of public systems under ``tests/data/systems``, and checks of them in memory."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from pathlib import Path

from deros.diagnostics import Diagnostic
from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from deros.models.system import System
from deros.systems.flat import FlatSystem
from deros.systems.flatten import flatten
from deros.validators.check import check

FOLDER = Path(__file__).resolve().parents[1] / "data" / "systems"

_SHARED = frozenset({"interfaces", "nodes"})


def names() -> list[str]:
    """Return the names of the systems in order."""
    return sorted(
        each.name for each in FOLDER.iterdir() if each.is_dir() and each.name not in _SHARED
    )


def path_of(name: str) -> Path:
    """Return the file of a system that is checked as a whole."""
    return FOLDER / name / f"{name}.system"


@cache
def store() -> InterfaceStore:
    """Return the definitions: those beside the systems, and the embedded ones.

    No environment is asked, so that the findings are the same on every machine.
    """
    return InterfaceStore([FOLDER / "interfaces"], prefixes=())


def findings(name: str, texts: Mapping[str, str] | None = None) -> list[Diagnostic]:
    """Check a system as ``deros check`` does, with its rules.

    Args:
        name: of the system.
        texts: what takes the place of the text of some files, by path; imported ones first.
    """
    repository = Repository()
    for path, text in (texts or {}).items():
        repository.load_text(path, text)
    return check([repository.load(path_of(name))], repository, store())


def flat_system(name: str) -> FlatSystem:
    """Return what a system amounts to at run time."""
    model = Repository().load(path_of(name)).model
    assert isinstance(model, System)
    return flatten(model)
