"""What programs are started with, besides names and parameters: words, variables, a prefix.

A process that is not a node has nothing else. See :mod:`deros.models.system` for ``…_from``.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from deros.diagnostics import Span
from deros.models.arguments import Condition, Expression
from deros.models.common import Name
from deros.models.starting import AT_ONCE, Starting


@dataclass(frozen=True, slots=True)
class Word:
    """A text for a program: an argument, the value of a variable, a prefix, or a program itself."""

    text: str
    span: Span = field(compare=False, repr=False)
    text_from: Expression | None = None
    when: Condition | None = None


@dataclass(frozen=True, slots=True)
class Variable:
    """``env NAME = TEXT``: an environment variable."""

    name: str
    value: Word
    span: Span = field(compare=False, repr=False)
    name_span: Span = field(compare=False, repr=False)
    when: Condition | None = None


@dataclass(frozen=True, slots=True)
class Remapping:
    """``remap NAME to TARGET``, for a node or all nodes of a group; graph names, as written."""

    name: str
    target: str
    span: Span = field(compare=False, repr=False)
    name_span: Span = field(compare=False, repr=False)
    target_span: Span = field(compare=False, repr=False)
    target_from: Expression | None = None
    when: Condition | None = None
    name_from: Expression | None = None

    @property
    def computed(self) -> tuple[Expression, ...]:
        """What its names are computed from."""
        return tuple(each for each in (self.name_from, self.target_from) if each is not None)


@dataclass(frozen=True, slots=True)
class Respawn:
    """Restart a program when it exits; ``max_restarts`` ``None`` means without limit.

    Where ``when`` does not hold, it is not restarted.
    """

    delay_ns: int = 0
    max_restarts: int | None = None
    when: Condition | None = None


@dataclass(frozen=True, slots=True)
class ProcessInstance:
    """``process NAME : "PROGRAM"``: a process that is not a node.

    Attributes:
        program: the name of a program in the ``PATH``, or a path.
        folder: that it runs in; without it, that of whoever starts the system.
    """

    name: str
    program: Word
    span: Span = field(compare=False, repr=False)
    name_span: Span = field(compare=False, repr=False)
    arguments: tuple[Word, ...] = ()
    environment: tuple[Variable, ...] = ()
    prefix: Word | None = None
    folder: Word | None = None
    respawn: Respawn | None = None
    description: str = ""
    when: Condition | None = None
    starting: Starting = AT_ONCE
    host: Name | None = None

    @property
    def words(self) -> tuple[Word, ...]:
        """All texts that it is started with, in no certain order."""
        return (self.program, *self.arguments, *_given(self.prefix, self.folder, self.environment))


def _given(
    prefix: Word | None, folder: Word | None, environment: tuple[Variable, ...]
) -> tuple[Word, ...]:
    values = (each.value for each in environment)
    return tuple(each for each in (prefix, folder, *values) if each is not None)


def words_of(
    arguments: tuple[Word, ...], environment: tuple[Variable, ...], prefix: Word | None
) -> tuple[Word, ...]:
    """Return all texts that a node's program is started with, in no certain order."""
    return (*arguments, *_given(prefix, None, environment))
