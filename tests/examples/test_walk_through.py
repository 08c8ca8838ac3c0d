"""The top README quotes the smallest example exactly."""

from __future__ import annotations

from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
EXAMPLE = ROOT / "examples" / "intelligent_one"
QUOTED = {
    "node marking_robot": "marking_robot.rnd",
    "subsystem Robot": "intelligent_one.system",
    "use ": "intelligent_one.deros",
}


def _quotes() -> list[str]:
    blocks = (ROOT / "README.md").read_text().split("```")[1::2]
    return [block.removeprefix("\n") for block in blocks]


@pytest.mark.parametrize("beginning", QUOTED)
def test_readme_quotes_are_in_the_example(beginning: str) -> None:
    """The quotes are verbatim and in the order of the example."""
    quote = next(each for each in _quotes() if each.startswith(beginning))
    text = " ".join((EXAMPLE / QUOTED[beginning]).read_text().split())
    for piece in quote.split("…"):
        for statement in filter(None, (" ".join(part.split()) for part in piece.split("\n\n"))):
            assert statement in text, statement
