"""What importers write is laid out as ``deros format`` leaves it.

To format an imported file is no edit of the part that the next import replaces.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

from deros.formatting.format import Fault, formatted
from deros.importers import first_rules
from deros.importers.kept import files as kept
from deros.importers.results import Parts
from deros.metamodels.languages import LANGUAGES


@pytest.fixture(autouse=True)
def all_is_formatted(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Hold all that a test imports, or has made of a system, against the formatter, once whole."""
    written: list[str] = []
    join = kept.joined

    def joined(parts: Parts) -> str:
        text = join(parts)
        if not parts.head.strip():  # what people wrote stays as they did
            written.append(text)
        return text

    make_rules = first_rules.first_rules

    def made_rules(*given: Any) -> first_rules.FirstRules:
        rules = make_rules(*given)
        written.append(rules.text)
        return rules

    monkeypatch.setattr(kept, "joined", joined)
    monkeypatch.setattr(first_rules, "first_rules", made_rules)
    yield
    for text in written:
        results = [formatted(text, each) for each in LANGUAGES]
        found = [each for each in results if not isinstance(each, Fault)]
        assert found == [text]
