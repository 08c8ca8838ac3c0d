"""What importers write is laid out as ``deros format`` leaves it.

To format an imported file is no edit of the part that the next import replaces.
"""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from deros.formatting.format import Fault, formatted
from deros.importers.kept import files as kept
from deros.importers.results import Parts
from deros.metamodels.languages import ROSNODE, ROSSYSTEM


@pytest.fixture(autouse=True)
def all_is_formatted(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Hold every model that a test imports against the formatter, once it is whole."""
    written: list[str] = []
    join = kept.joined

    def joined(parts: Parts) -> str:
        text = join(parts)
        if not parts.head.strip():  # what people wrote stays as they did
            written.append(text)
        return text

    monkeypatch.setattr(kept, "joined", joined)
    yield
    for text in written:
        results = [formatted(text, each) for each in (ROSNODE, ROSSYSTEM)]
        found = [each for each in results if not isinstance(each, Fault)]
        assert found in ([], [text])
