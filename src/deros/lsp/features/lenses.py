"""What can be done with a file at one click: generate, draw, run."""

from __future__ import annotations

import os
from collections.abc import Iterator

from lsprotocol import types

from deros.lsp.analysis import Analysis
from deros.lsp.places import Places
from deros.models.node import NodeType
from deros.models.rules import Rules
from deros.models.system import System

RUN = "deros.run"
"""The command of the client: run the program ``deros`` with these arguments in a terminal."""


def lenses(places: Places, analysis: Analysis) -> Iterator[types.CodeLens]:
    """Yield the commands that fit the language, at the head of the file's model."""
    path = os.path.abspath(analysis.file.path)  # noqa: PTH100 - links stay
    start = types.Position(0, 0)
    at = types.Range(start, start)
    match analysis.file.model:
        case NodeType(name_span=span):
            at, offered = places.range(span), {"Generate": ["generate"]}
        case System(name_span=span):
            at, offered = places.range(span), {"Generate": ["generate"], "Draw": ["graph"]}
        case Rules():
            offered = {"Generate": ["generate"], "Run in the shadow": ["run", "--shadow"]}
        case _:
            return
    for title, arguments in offered.items():
        yield types.CodeLens(at, types.Command(title, RUN, arguments=[*arguments, path]))
