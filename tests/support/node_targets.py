"""What the targets of node descriptions make of a text, and which one they refuse."""

from __future__ import annotations

from collections.abc import Mapping

import pytest

from deros.generators.api.protocol import Context, Files, GenerateFunction, GenerationError
from deros.generators.node.cpp.generate import generate as generate_cpp
from deros.generators.node.python.generate import generate as generate_python
from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from deros.models.node import NodeType

in_each_language = pytest.mark.parametrize(
    "generate",
    [pytest.param(generate_python, id="python"), pytest.param(generate_cpp, id="cpp")],
)
"""Runs a test with the generator of each language."""


def node_of(text: str) -> NodeType:
    """Return the model of a node description in a folder of its own."""
    loaded = Repository().load_text("/nonexistent/a_node.rnd", text)
    assert isinstance(loaded.model, NodeType), loaded.diagnostics
    return loaded.model


def files_of(
    generate: GenerateFunction, text: str, options: Mapping[str, str] | None = None
) -> Files:
    """Return what is generated for a node description."""
    return generate(node_of(text), Context(InterfaceStore(), Repository()), options or {})


def refusal(generate: GenerateFunction, text: str) -> tuple[str, str, int]:
    """Return code, message and line of the one diagnostic that a description ends in."""
    with pytest.raises(GenerationError) as raised:
        files_of(generate, text)
    (found,) = raised.value.diagnostics
    return found.code.name, found.message, found.span.line
