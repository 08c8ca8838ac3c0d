"""Pairs of rules and a trace, on which engines are compared, and their form in files.

Where a comparison fails, ``make pairs`` writes the pair, as small as it could be made, into
``tests/generators/monitor/python/counterexamples``. It stays there and is compared in every run of
the tests. A file is one line of JSON: an object of the field ``is`` and the fields of the class so
named; a span is the number of its line; NaN and infinities are written as Python does.
"""

from __future__ import annotations

import hashlib
import json
import math
from dataclasses import dataclass, fields, is_dataclass
from pathlib import Path
from typing import Any, get_args

from hypothesis import strategies as st

from deros.diagnostics import Span
from deros.generators.monitor.python.interface import render_monitor
from deros.interfaces.fields import Key
from deros.interfaces.types import FieldType, InterfaceType
from deros.rules.program import formulas, ir
from tests.support import monitors
from tests.support.strategies import Start, Step, span, starts, traces

FOLDER = Path(__file__).resolve().parents[1] / "generators/monitor/python/counterexamples"


@dataclass(frozen=True)
class Pair:
    """A program, how its monitor starts, and what it is driven with."""

    program: ir.Program
    start: Start
    steps: tuple[Step, ...]

    def compare(self) -> None:
        """Compare the generated monitor with the reference engine.

        Raises:
            AssertionError: they differ.
        """
        texts = render_monitor(self.program)
        monitors.remark("\n".join(texts.values()))
        monitors.compare(self.program, self.steps, texts, self.start)


def pairs(program: ir.Program) -> st.SearchStrategy[Pair]:
    """Draw starts and traces for a program."""
    return st.builds(Pair, st.just(program), starts(program), traces(program).map(tuple))


def write(pair: Pair, folder: Path = FOLDER) -> Path:
    """Write a pair into a file named after its content; return its path."""
    text = json.dumps(encoded(pair), separators=(",", ":")) + "\n"
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{hashlib.sha256(text.encode()).hexdigest()[:12]}.json"
    path.write_text(text, encoding="utf-8")
    return path


def read(path: Path) -> Pair:
    """Read a pair from its file."""
    return decoded(json.loads(path.read_text(encoding="utf-8")))


def decoded(value: Any) -> Pair:
    """Return the pair that :func:`encoded` has made JSON of."""
    pair = _decoded(value)
    assert isinstance(pair, Pair)
    return pair


def encoded(pair: Pair) -> Any:
    """Return a pair as JSON values."""
    return _encoded(pair)


def _encoded(value: Any) -> Any:
    if isinstance(value, Span):
        return {"is": "Span", "line": value.line}
    if is_dataclass(value) and not isinstance(value, type):
        held = {each.name: _encoded(getattr(value, each.name)) for each in fields(value)}
        return {"is": type(value).__name__, **held}
    if isinstance(value, dict):
        return {"is": "dict", "items": [[key, _encoded(each)] for key, each in value.items()]}
    if isinstance(value, list):
        return {"is": "list", "items": [_encoded(each) for each in value]}
    if isinstance(value, frozenset):
        return {"is": "frozenset", "items": sorted(value)}
    return [_encoded(each) for each in value] if isinstance(value, tuple) else value


def _decoded(value: Any) -> Any:
    if isinstance(value, list):
        return tuple(_decoded(each) for each in value)
    if not isinstance(value, dict):
        return value
    held = {name: _decoded(each) for name, each in value.items() if name != "is"}
    match value["is"]:
        case "Span":
            return span(held["line"])
        case "dict" | "list" | "frozenset" as name:
            return {"dict": dict, "list": list, "frozenset": frozenset}[name](held["items"])
        case "Number" if math.isnan(held["value"]):  # of which there is one, as NaN equals nothing
            return formulas.UNKNOWN
        case name:
            return _CLASSES[name](**held)


_CLASSES: dict[str, Any] = {
    **{name: each for name, each in vars(formulas).items() if is_dataclass(each)},
    **{name: each for name, each in vars(ir).items() if is_dataclass(each)},
    **{each.__name__: each for each in get_args(ir.Shape)},
    **{each.__name__: each for each in (Pair, Start, Step, FieldType, InterfaceType, Key)},
}
