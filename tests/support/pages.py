"""The fenced blocks of the documentation, with their places."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
_FENCE = re.compile(r"(\s*)(`{3,}|~{3,})\s*([\w+-]*)(?: title=\"([^\"]+)\")?")
_HEADING = re.compile(r"#+\s+(.*)")


@dataclass(frozen=True)
class Block:
    """A fenced block.

    Attributes:
        page: its path below the root of the repository.
        line: the line of its first line of text, from 1.
        language: the word behind the fence, empty if there is none.
        text: what is between the fences, without the indentation of the fence.
        section: the heading that it stands under.
        title: the name of the file that it shows, empty if it has none.
    """

    page: str
    line: int
    language: str
    text: str
    section: str
    title: str = ""

    def __str__(self) -> str:
        """Return ``page:line``."""
        return f"{self.page}:{self.line}"

    @property
    def code(self) -> str:
        """The diagnostic code that the page is about, empty for other pages."""
        found = re.fullmatch(r"docs/diagnostics/(DRS\d{3})\.md", self.page)
        return found[1] if found else ""

    @property
    def is_bad(self) -> bool:
        """Whether the page shows it as an example of what it is about."""
        return bool(self.code) and self.section == "Example"


def pages() -> list[Path]:
    """Return the pages of the documentation, the README first."""
    return [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]


def blocks() -> list[Block]:
    """Return the fenced blocks of all pages, in order."""
    return [block for page in pages() for block in _blocks(page)]


def _blocks(path: Path) -> Iterator[Block]:
    page = path.relative_to(ROOT).as_posix()
    section, fence, indent, language, title, start = "", "", "", "", "", 0
    lines: list[str] = []
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1):
        found = _FENCE.match(line)
        if fence:
            if found and found[2].startswith(fence) and not found[3]:
                yield Block(page, start, language, "".join(lines), section, title or "")
                fence = ""
            else:
                lines.append(line.removeprefix(indent) + "\n")
        elif found:
            indent, fence, language, title = found.groups()
            start, lines = number + 1, []
        elif heading := _HEADING.match(line):
            section = heading[1]
    assert not fence, f"{page}:{start}: the block has no end"
