"""Files of two parts: the upper one is people's, each import replaces the lower one.

A line between them has a digest of the lower part. While it matches, nobody has edited that part.
What people write in the upper part for a thing that the import has, too, counts in its place.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from deros.generators.api.protocol import File, Owner
from deros.importers.kept.amending import amended
from deros.importers.kept.removal import tidy
from deros.importers.results import Missing, Parts
from deros.interfaces.files import read_regular
from deros.metamodels.imported_part import NOTICE

_LINE = re.compile(rf"^{re.escape(NOTICE)}\n// digest: ([0-9a-f]{{16}})\n", re.MULTILINE)
_LARGEST = 16 << 20
"""The largest size in bytes of an existing file."""

ASIDE = ".new"
"""What the name of a file gets that would replace an edited one."""


@dataclass(frozen=True, slots=True)
class Renewed:
    """The files to write.

    Attributes:
        files: all of them, by path.
        edited: the paths of those whose lower part was edited, or that were not imported.
        otherwise: what the import says, and people say otherwise, or not, in an upper part.
    """

    files: Mapping[str, File]
    edited: tuple[str, ...]
    otherwise: tuple[Missing, ...] = ()


class _There(NamedTuple):
    """A file that is there: its upper and its lower part, and whether the latter is untouched."""

    head: str
    body: str
    is_intact: bool


def renewed(parts: Mapping[str, Parts], directory: Path) -> Renewed:
    """Return the files of an import, with what people wrote into those that are there.

    A file whose lower part was edited is not among them; the new text has ``.new`` behind its name.
    A statement that was moved from the lower part to the upper one is no such edit.

    Raises:
        OSError: if a file that is there cannot be read.
    """
    files: dict[str, File] = {}
    edited: list[str] = []
    otherwise: list[Missing] = []
    for path, part in parts.items():
        target = directory / path
        there, is_known = None, True
        if target.exists():
            there = _split(read_regular(target, _LARGEST).decode(errors="replace"))
            is_known = there is not None
        if there is not None:
            body, more = amended(part, there.head, target)
            is_known = there.is_intact or tidy(there.body) == tidy(body)
            part = Parts(there.head, body)
            otherwise += more
        if not is_known:
            edited.append(path)
        files[path if is_known else path + ASIDE] = File(joined(part), Owner.SHARED)
    return Renewed(files, tuple(edited), tuple(otherwise))


def joined(parts: Parts) -> str:
    """Return the text of a file."""
    head = parts.head.rstrip("\n") + "\n\n" if parts.head.strip() else ""
    below = f"\n{parts.body}" if parts.body else ""
    return f"{head}{NOTICE}\n// digest: {_digest(parts.body)}\n{below}"


def _split(text: str) -> _There | None:
    """Return the parts of a file; ``None`` if it has no line between them."""
    # A checkout may have converted the line endings, which is not an edit.
    text = text.replace("\r\n", "\n")
    found = _LINE.search(text)
    if found is None:
        return None
    body = text[found.end() :].removeprefix("\n")
    return _There(text[: found.start()], body, _digest(body) == found[1])


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()[:16]
