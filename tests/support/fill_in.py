"""What a user does to generated C++: fill handlers, and add to files."""

from __future__ import annotations

import re
from pathlib import Path


def fill_in(path: Path, handler: str, code: str) -> None:
    """Write the body of a handler in place of the one that does nothing yet."""
    pattern = rf"(::{handler}\([^{{]*)\{{\n.*?\n\}}"

    def filled(match: re.Match[str]) -> str:
        used = re.sub(r"/\*(\w+)\*/", lambda n: n[1] if n[1] in code else n[0], match[1])
        return f"{used}{{{code}}}"

    text, count = re.subn(pattern, filled, path.read_text(), count=1, flags=re.DOTALL)
    assert count == 1
    path.write_text(text)


def insert(path: Path, before: str, text: str) -> None:
    """Write a text in front of the first place where another one stands."""
    old = path.read_text()
    assert before in old
    path.write_text(old.replace(before, text.removeprefix("\n") + before, 1))
