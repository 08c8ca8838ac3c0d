"""What a generator is: a pure function from a typed model and options to files.

A generator from outside is one entry point in the group ``textx_generators`` whose object is made by
:func:`generator`; it is then known to ``textx generate`` and ``deros generate`` alike.
"""

from __future__ import annotations

import enum
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any


class Owner(enum.Enum):
    """Whose file it is once written."""

    GENERATOR = "generator"  # refreshed on every run, unless edited by hand
    USER = "user"  # written once, never again


@dataclass(frozen=True, slots=True)
class File:
    """One file of a generator's output."""

    text: str
    owner: Owner = Owner.GENERATOR
    executable: bool = False


@dataclass(frozen=True, slots=True)
class Option:
    """An option of a generator, given as text on the command line (``--name value``)."""

    name: str
    description: str


Files = Mapping[str, File]
"""Relative POSIX paths and what they hold."""

Options = Mapping[str, str]
