"""What a reader of some source makes: the texts of models, and what they cannot say."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple


@dataclass(frozen=True, slots=True)
class Parts:
    """The two parts of a file: the one that people write, as it begins, and the imported one."""

    head: str
    body: str


class Missing(NamedTuple):
    """What is in a source and not in the models, and why.

    Attributes:
        file: as the user named it; empty where the source is no file.
        line: from 1; 0 where it is not known.
    """

    what: str
    why: str
    file: str = ""
    line: int = 0

    def __str__(self) -> str:
        place = ":".join(filter(None, (self.file, str(self.line or ""))))
        return f"{place}: {self.what} {self.why}" if place else f"{self.what} {self.why}"


INTERFACES = "interfaces"
"""The folder of interface definitions, beside the models that need them."""


@dataclass(frozen=True, slots=True)
class Imported:
    """The models that a source became.

    Attributes:
        files: by path, the one to check first.
        missing: what is not in them, a line each.
        interfaces: the definitions of interfaces that they need, by path; all of
            them are below :data:`INTERFACES`.
    """

    files: Mapping[str, Parts]
    missing: tuple[str, ...] = ()
    interfaces: Mapping[str, str] = field(default_factory=dict)
