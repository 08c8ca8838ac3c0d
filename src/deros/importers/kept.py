"""Files of two parts: the upper one is people's, each import replaces the lower one.

A line between them has a digest of the lower part. While it matches, nobody has edited that part.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from deros.generators.api.protocol import File, Owner
from deros.importers.results import Parts
from deros.interfaces.files import read_regular

_NOTICE = "// Imported: the next import replaces all that is below this line."
_LINE = re.compile(rf"^{re.escape(_NOTICE)}\n// digest: ([0-9a-f]{{16}})\n", re.MULTILINE)
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
    """

    files: Mapping[str, File]
    edited: tuple[str, ...]


def renewed(parts: Mapping[str, Parts], directory: Path) -> Renewed:
    """Return the files of an import, with what people wrote into those that are there.

    A file whose lower part was edited is not among them; the new text has ``.new`` behind its name.

    Raises:
        OSError: if a file that is there cannot be read.
    """
    files: dict[str, File] = {}
    edited: list[str] = []
    for path, part in parts.items():
        target = directory / path
        head: str | None = part.head
        if target.exists():
            head = _head(read_regular(target, _LARGEST).decode(errors="replace"))
        if head is None:
            edited.append(path)
            files[path + ASIDE] = File(joined(part), Owner.SHARED)
        else:
            files[path] = File(joined(Parts(head, part.body)), Owner.SHARED)
    return Renewed(files, tuple(edited))


def joined(parts: Parts) -> str:
    """Return the text of a file."""
    head = parts.head.rstrip("\n") + "\n\n" if parts.head.strip() else ""
    below = f"\n{parts.body}" if parts.body else ""
    return f"{head}{_NOTICE}\n// digest: {_digest(parts.body)}\n{below}"


def _head(text: str) -> str | None:
    """Return the upper part of a file; ``None`` if its lower part is not as it was written."""
    # A checkout may have converted the line endings, which is not an edit.
    text = text.replace("\r\n", "\n")
    found = _LINE.search(text)
    if found is None or _digest(text[found.end() :].removeprefix("\n")) != found[1]:
        return None
    return text[: found.start()]


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()[:16]
