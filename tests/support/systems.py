"""Systems that the tests of their targets share."""

from __future__ import annotations

from pathlib import Path

from deros.generators.api.protocol import Context
from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from deros.models.system import System

MODELS = Path(__file__).resolve().parent.parent / "generators/system/models"

EVERYTHING = MODELS / "every_thing.system"
"""A system that uses all that the language can say about a node."""

CONTEXT = Context(InterfaceStore(), Repository())
"""What generators of systems get; they look at nothing but the model."""


def load(path: Path) -> System:
    """Load a system that has no faults of reading, syntax or reference."""
    repository = Repository()
    loaded = repository.load(path)
    assert repository.diagnostics == []
    assert isinstance(loaded.model, System)
    return loaded.model


def load_text(folder: Path, text: str, **nodes: str) -> System:
    """Load a system from its text, with node descriptions that it can import by their names."""
    for name, description in nodes.items():
        (folder / f"{name}.rnd").write_text(description, encoding="utf-8")
    path = folder / "test.system"
    path.write_text(text, encoding="utf-8")
    return load(path)
