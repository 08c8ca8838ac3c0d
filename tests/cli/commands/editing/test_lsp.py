"""``deros lsp`` before it serves anybody."""

from __future__ import annotations

import sys

import pytest

from tests.support.cli import deros


def test_without_pygls_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of an installation without the extra nothing else is lost."""
    monkeypatch.setitem(sys.modules, "pygls", None)
    result = deros("lsp")
    assert result.code == 2
    assert "pip install 'deros[lsp]'" in result.err
    assert result.out == ""
