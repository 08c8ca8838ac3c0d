"""What can be done with a file at one click: generate, draw, simulate."""

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
    path = os.path.abspath(analysis.file.path)  # noqa: PTH100
    match analysis.file.model:
        case NodeType(name_span=span):
            offered = [("Generate", ["generate", path])]
        case System(name_span=span):
            offered = [("Generate", ["generate", path]), ("Draw", ["graph", path])]
        case Rules(source=source):
            start = types.Position(0, 0)
            offered = [
                ("Generate", ["generate", path]),
                ("Run in the shadow", ["run", "--shadow", path]),
            ]
            del source
            yield from _lenses(types.Range(start, start), offered)
            return
        case _:
            return
    yield from _lenses(places.range(span), offered)


def _lenses(at: types.Range, offered: list[tuple[str, list[str]]]) -> Iterator[types.CodeLens]:
    for title, arguments in offered:
        yield types.CodeLens(at, types.Command(title, RUN, arguments=arguments))
