"""Generated packages that are run where they are kept: one folder for each text of their files.

Nothing in a folder is trusted: it is used if all of its files are there and say what they are to
say, and made anew if not. Files of Python's own, compiled from these, may lie beside them.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import shutil
import tempfile
import time
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from deros.generators.api.protocol import Files

LONGEST_UNUSED = 30 * 24 * 3600
"""Seconds after which a folder that nobody has used is removed."""


def kept(files: Files, folder: Path) -> Path:
    """Return the folder with the files, below the folder of all of them.

    Raises:
        OSError: it cannot be written.
    """
    folder.mkdir(parents=True, exist_ok=True, mode=0o700)
    _clear(folder)
    texts = {path: each.text for path, each in sorted(files.items())}
    place = folder / hashlib.sha256(json.dumps(texts).encode()).hexdigest()[:32]
    if not _is_whole(place, texts):
        _replace(place, texts)
    os.utime(place)
    return place


def _is_whole(place: Path, texts: dict[str, str]) -> bool:
    """Return whether a folder has all files and, but for what Python compiles, no others."""
    try:
        present = {
            each.relative_to(place).as_posix(): each.read_bytes()
            for each in place.rglob("*")
            if each.is_file() and each.parent.name != "__pycache__"
        }
    except OSError:
        return False
    return present == {path: text.encode() for path, text in texts.items()}


def _replace(place: Path, texts: dict[str, str]) -> None:
    """Put a folder in its place at once: who starts at the same time finds a whole one."""
    made = Path(tempfile.mkdtemp(prefix=".new-", dir=place.parent))
    try:
        for path, text in texts.items():
            file = made / path
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_bytes(text.encode())
        if place.exists():
            os.rename(place, f"{made}-old")  # noqa: PTH104 - a path and a name
        with contextlib.suppress(OSError):  # another one was faster, with the same texts
            made.rename(place)
    finally:
        shutil.rmtree(made, ignore_errors=True)
        shutil.rmtree(f"{made}-old", ignore_errors=True)


def _clear(folder: Path) -> None:
    """Remove what has not been used for long."""
    oldest = time.time() - LONGEST_UNUSED
    for each in folder.iterdir():
        if each.stat().st_mtime < oldest:
            shutil.rmtree(each, ignore_errors=True)
