"""Names for what files of other tools call otherwise."""

from __future__ import annotations

import re

from deros.importers.file_names import FileNames, numbered
from deros.names.names import check_node_name

_LONGEST = 100
_LONG_WORD = re.compile(r"\w{256}")


def identifier(text: str, otherwise: str = "node") -> str:
    """Return a text as a name: other characters become ``_``; one that is a name stays."""
    if len(text) <= _LONGEST and check_node_name(text) is None:
        return text
    name = re.sub(r"[^A-Za-z0-9_]+", "_", text).strip("_")[:_LONGEST]
    return f"_{name}" if name[:1].isdigit() else name or otherwise


def has_long_word(name: str) -> bool:
    """Return whether a part of a name is longer than what the languages read."""
    return _LONG_WORD.search(name) is not None


class UniqueNames(FileNames):
    """Gives names that come near to texts of other tools."""

    def of(self, text: str) -> str:
        """Return a name that comes near to a text, and was not given before."""
        return self.first(numbered(identifier(text)))
