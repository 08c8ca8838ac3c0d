"""The example of the page about formatting."""

from __future__ import annotations

from deros.formatting.format import formatted
from deros.metamodels.languages import DEROS
from tests.support.pages import blocks


def test_the_example_becomes_what_is_shown() -> None:
    """The text before becomes the model behind it."""
    page = [each for each in blocks() if each.page == "docs/formatting.md"]
    before, after = (next(b.text for b in page if b.language == of) for of in ("text", "deros"))
    assert before != after
    assert formatted(before, DEROS) == after
