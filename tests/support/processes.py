"""Which processes a test has left behind."""

from __future__ import annotations

from pathlib import Path


def processes_with(text: str) -> list[int]:
    """Return the ids of the running processes that have ``text`` in their environment."""
    found = []
    for entry in Path("/proc").iterdir():
        if not entry.name.isdigit():
            continue
        try:
            environment = (entry / "environ").read_bytes()
        except OSError:
            continue  # it has ended meanwhile, or is not ours
        if text.encode() in environment:
            found.append(int(entry.name))
    return found
