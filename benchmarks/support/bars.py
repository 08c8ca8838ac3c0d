"""What is asked of a benchmark, and whether it holds."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from rich.console import Console
from rich.text import Text


@dataclass(frozen=True, slots=True)
class Bar:
    """One thing that is asked for: what was found, what is allowed, and whether it holds."""

    what: str
    found: str
    allowed: str
    held: bool


def show_bars(bars: Iterable[Bar], console: Console) -> None:
    """Print a verdict per bar."""
    for bar in bars:
        mark = Text("holds", style="green") if bar.held else Text("FAILS", style="bold red")
        text = Text.assemble(mark, f"  {bar.what}: {bar.found} (asked for: {bar.allowed})")
        console.print(text, soft_wrap=True)
