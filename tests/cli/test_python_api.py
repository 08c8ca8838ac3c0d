"""``docs/python-api.md`` lists what programs may import; other pages import nothing else."""

from __future__ import annotations

import ast
import re
from importlib import import_module

import pytest

from tests.support import pages
from tests.support.pages import ROOT

LISTED = re.findall(
    r"^::: ([\w.]+)$", (ROOT / "docs/python-api.md").read_text(encoding="utf-8"), re.MULTILINE
)


@pytest.mark.parametrize("name", LISTED)
def test_listed_name_exists_and_says_what_it_is(name: str) -> None:
    """The page is made of docstrings: without one it would show a bare signature."""
    module, _, attribute = name.rpartition(".")
    assert getattr(import_module(module), attribute).__doc__


def test_pages_import_only_what_is_listed() -> None:
    """An example that imports something internal would make it public unnoticed."""
    imported = {
        f"{node.module}.{alias.name}"
        for block in pages.blocks()
        if block.language == "python" and "from deros" in block.text
        for node in ast.walk(ast.parse(block.text))
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("deros.")
        for alias in node.names
    }
    assert len(imported) > 5
    types = {"deros.generators.api.protocol.Files", "deros.generators.api.protocol.Options"}
    assert imported - types <= {*LISTED}
