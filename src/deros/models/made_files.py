"""Files that are made before anything is started: the statements that name them."""

from __future__ import annotations

from dataclasses import dataclass, field

from deros.diagnostics import Span
from deros.models.arguments import Condition
from deros.models.launch_files import XacroFile


@dataclass(frozen=True, slots=True)
class MadeFile:
    """``file NAME from xacro PATH (NAME = VALUE, …)``.

    Attributes:
        name: by which its path is used, ``$NAME``, wherever in the system.
        xacro: of which file it is made, and with which arguments.
        when: where it is made; elsewhere, its path is the empty text.
    """

    name: str
    xacro: XacroFile
    span: Span = field(compare=False, repr=False)
    name_span: Span = field(compare=False, repr=False)
    when: Condition | None = None
