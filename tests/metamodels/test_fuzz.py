"""Whatever a file holds, loading it ends in a model or in diagnostics, never in an exception."""

from __future__ import annotations

import tempfile
from pathlib import Path

from hypothesis import given, settings
from hypothesis import strategies as st

from deros.metamodels.load import LoadedFile, Repository
from tests.support import paper

_EXTENSIONS = """\
node a : p "d" executable "x" lifecycle
parameters name x : double[] = [1.0, 2e3] [m/s] in [0.1, 2) one_of [1] size 3 read_only "d"
publishes topic /o : a.B { t.x[2] [m/s], y [rad] } qos best_effort depth 5 deadline 1 ms via x
timers timer t every 20 ms
"""
_RULES = """\
unit knot = 0.5 m/s
action stop publishes true on /stop : std_msgs.Bool reset_by ok latched "d";
input s = topic /scan.ranges[2] timeout 0.5 sec
entity e { r: (not /a.b.c(1, -2 deg).d() >= -x.y for 2 sec) or s in (0, 1 m] and t; }
behaviour b: if e.r then { stop; if e.r then { log_state("a\\"b"); }; };
"""
_SYSTEM = """\
system S imports import "n/*.rnd" topics external topic /t : a.B qos reliable "d"
subsystem l : Arm namespace /l node n : a namespace x respawn delay 1 sec max 3 log_level warn
parameters param p = [true, "x", -1.5e3] wirings connect a to ~/b;
"""
TEXTS = {
    "rnd": [paper.FIGURE_11, _EXTENSIONS],
    "system": [paper.FIGURE_12, _SYSTEM],
    "deros": [*paper.RULES.values(), _RULES],
}
_WORDS = "not for in if topic node subsystem connect qos 0 1e9 é \u00a0 \x0c \U0001f916"
_SIGNS = '" \\ /* */ // ( ) [ ] { } ; : . , - ~ / ='
_PIECES = st.sampled_from(["", " ", "\n", *_WORDS.split(" "), *_SIGNS.split(" ")])


@st.composite
def _mutated(draw: st.DrawFn) -> tuple[str, str]:
    """Draw a suffix and one of its texts, cut short or with pieces replaced."""
    suffix = draw(st.sampled_from(sorted(TEXTS)))
    text = draw(st.sampled_from(TEXTS[suffix]))
    if draw(st.booleans()):
        return suffix, text[: draw(st.integers(0, len(text)))]
    for _ in range(draw(st.integers(1, 5))):
        start = draw(st.integers(0, len(text)))
        end = min(len(text), start + draw(st.integers(0, 8)))
        text = text[:start] + draw(_PIECES) + text[end:]
    return suffix, text


def _sound(loaded: LoadedFile) -> None:
    """Hold what is true of every result: a model or a finding, and places that lie in the text."""
    assert loaded.model is not None or loaded.diagnostics
    for found in loaded.diagnostics:
        assert found.message
        assert 0 <= found.span.start <= found.span.end <= len(found.span.source.text)
        assert (found.span.line, found.span.column) <= (found.span.end_line, found.span.end_column)


@settings(max_examples=300, deadline=None)
@given(_mutated())
def test_mutated_listings(case: tuple[str, str]) -> None:
    """Truncated and mutated models load without an exception."""
    suffix, text = case
    _sound(Repository().load_text(f"fuzz.{suffix}", text))


@settings(max_examples=100, deadline=None)
@given(st.sampled_from(sorted(TEXTS)), st.data())
def test_mutated_bytes(suffix: str, data: st.DataObject) -> None:
    """Bytes of a model file, some of them replaced, load without an exception."""
    content = bytearray(data.draw(st.sampled_from(TEXTS[suffix])).encode())
    for _ in range(data.draw(st.integers(1, 4))):
        content[data.draw(st.integers(0, len(content) - 1))] = data.draw(st.integers(0, 255))
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"fuzz.{suffix}"
        path.write_bytes(content)
        _sound(Repository().load(path))


@settings(max_examples=100, deadline=None)
@given(st.sampled_from(sorted(TEXTS)), st.text(max_size=60))
def test_any_text(suffix: str, text: str) -> None:
    """Text that is no model at all loads without an exception."""
    _sound(Repository().load_text(f"fuzz.{suffix}", text))


@settings(max_examples=100, deadline=None)
@given(st.sampled_from(sorted(TEXTS)), st.lists(_PIECES, max_size=40))
def test_any_pieces(suffix: str, pieces: list[str]) -> None:
    """Words and signs of the languages in any order load without an exception."""
    _sound(Repository().load_text(f"fuzz.{suffix}", " ".join(pieces)))
