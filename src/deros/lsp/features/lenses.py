"""What can be done with a file at one click: generate, draw, test, simulate, run."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

from lsprotocol import types

from deros.lsp.analysis import Analysis
from deros.lsp.places import Places
from deros.models.node import NodeType
from deros.models.rules import Rules
from deros.models.system import System
from deros.pipeline.rule_tests import SUFFIXES, is_timeline_file

RUN = "deros.run"
"""The command of the client: run the program ``deros`` with these arguments in a terminal."""


TRACE = ".jsonl"
"""What a trace of some rules ends in that lies beside them, under their name."""


def lenses(places: Places, analysis: Analysis) -> Iterator[types.CodeLens]:
    """Yield the commands that fit the language, at the head of the file's model."""
    path = os.path.abspath(analysis.file.path)  # noqa: PTH100 - links stay
    start = types.Position(0, 0)
    at = types.Range(start, start)
    match analysis.file.model:
        case NodeType(name_span=span):
            at, offered = places.range(span), {"Generate": ["generate", path]}
        case System(name_span=span):
            at = places.range(span)
            offered = {"Generate": ["generate", path], "Draw": ["graph", path]}
        case Rules():
            offered = {
                "Generate": ["generate", path],
                **dict(_played(Path(path))),
                "Run in the shadow": ["run", "--shadow", path],
            }
        case _:
            return
    for title, arguments in offered.items():
        yield types.CodeLens(at, types.Command(title, RUN, arguments=list(arguments)))


def _played(rules: Path) -> Iterator[tuple[str, list[str]]]:
    """Yield the commands that play what lies beside rules, under their name: timelines, a trace."""
    beside = (rules.with_suffix(each) for each in SUFFIXES)
    timelines = [str(each) for each in beside if each.is_file() and is_timeline_file(str(each))]
    if timelines:
        yield "Test", ["test", *timelines]
    trace = rules.with_suffix(TRACE)
    if trace.is_file():
        yield "Simulate", ["simulate", str(rules), "--trace", str(trace), "--format", "text"]
