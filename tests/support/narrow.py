"""Python generated with shorter lines than are allowed, so that all that can break does."""

from __future__ import annotations

import sys

import pytest

_OTHERS = {"c", "cpp"}


def narrow(width: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Let what lays out Python take lines of more than ``width`` letters for too long."""
    changed = 0
    for name, module in list(sys.modules.items()):
        of_python = name.startswith("deros.generators.") and not _OTHERS & set(name.split("."))
        if of_python and hasattr(module, "LINE_LENGTH"):
            monkeypatch.setattr(module, "LINE_LENGTH", width)
            changed += 1
    assert changed
