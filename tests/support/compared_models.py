"""Models whose versions are compared: read without errors, and with single edits."""

from __future__ import annotations

from pathlib import Path

from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from deros.validators.check import check_all


def without_errors(path: Path) -> object:
    """Return the model of a file that has none."""
    repository = Repository()
    loaded = repository.load(path)
    checked = check_all([loaded], repository, InterfaceStore())
    errors = [f"{each.span.line}: {each.message}" for each in checked.findings if each.is_error]
    assert not errors, errors
    return loaded.model


def with_edit(text: str, old: str, new: str) -> str:
    """Return a text with one part of it, which is there once, replaced."""
    assert text.count(old) == 1, text.count(old)
    return text.replace(old, new)
