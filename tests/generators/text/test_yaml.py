"""Names in emitted YAML."""

from __future__ import annotations

import pytest

from deros.generators.text.yaml import is_plain_key


@pytest.mark.parametrize("name", ["speed", "/robot/front_camera", "limits.max-speed", "_x", "nox"])
def test_plain_names_need_no_quotes(name: str) -> None:
    """YAML reads them as strings."""
    assert is_plain_key(name)


@pytest.mark.parametrize("name", ["", "Yes", "null", "n", "1st", "//x", "a b", "a:b", "*", "é"])
def test_ambiguous_names_need_quotes(name: str) -> None:
    """YAML would read them as other values or as syntax."""
    assert not is_plain_key(name)
