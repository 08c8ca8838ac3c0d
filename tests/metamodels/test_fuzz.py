"""Loading any file returns a model or diagnostics, and never raises."""

from __future__ import annotations

import tempfile
from pathlib import Path

from hypothesis import given, settings
from hypothesis import strategies as st

from deros.metamodels.load import LoadedFile, Repository
from tests.support.mutations import PIECES, TEXTS, mutated
from tests.support.profiles import scaled


def _assert_valid(loaded: LoadedFile) -> None:
    """Check that a result has a model or a finding, and spans that lie in the text."""
    assert loaded.model is not None or loaded.diagnostics
    for finding in loaded.diagnostics:
        assert finding.message
        assert 0 <= finding.span.start <= finding.span.end <= len(finding.span.source.text)
        assert (finding.span.line, finding.span.column) <= (
            finding.span.end_line,
            finding.span.end_column,
        )


@settings(max_examples=scaled(300))
@given(mutated())
def test_mutated_listings_do_not_raise(case: tuple[str, str]) -> None:
    """Truncated and mutated models load without an exception."""
    suffix, text = case
    _assert_valid(Repository().load_text(f"fuzz.{suffix}", text))


@given(st.sampled_from(sorted(TEXTS)), st.data())
def test_mutated_bytes_do_not_raise(suffix: str, data: st.DataObject) -> None:
    """Model files with some bytes replaced load without an exception."""
    content = bytearray(data.draw(st.sampled_from(TEXTS[suffix])).encode())
    for _ in range(data.draw(st.integers(1, 4))):
        content[data.draw(st.integers(0, len(content) - 1))] = data.draw(st.integers(0, 255))
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"fuzz.{suffix}"
        path.write_bytes(content)
        _assert_valid(Repository().load(path))


@given(st.sampled_from(sorted(TEXTS)), st.text(max_size=60))
def test_arbitrary_text_does_not_raise(suffix: str, text: str) -> None:
    """Text that is not a model loads without an exception."""
    _assert_valid(Repository().load_text(f"fuzz.{suffix}", text))


@given(st.sampled_from(sorted(TEXTS)), st.lists(PIECES, max_size=40))
def test_arbitrary_tokens_do_not_raise(suffix: str, pieces: list[str]) -> None:
    """Words and symbols of the languages in any order load without an exception."""
    _assert_valid(Repository().load_text(f"fuzz.{suffix}", " ".join(pieces)))
