"""Arguments of systems, and what a system computes from them: expressions and conditions.

An argument is declared as a parameter is: :class:`~deros.models.node.Parameter`. What these classes
mean is defined in :mod:`deros.systems.arguments.evaluate`.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal

from deros.diagnostics import Span
from deros.models.common import Name, Scalar
from deros.models.terms import ArithmeticOperator, ComparisonOperator

if TYPE_CHECKING:
    from deros.models.launch_files import XacroFile


@dataclass(frozen=True, slots=True)
class Literally:
    """A value as written."""

    value: Scalar
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Argument:
    """``$speed``: the value of an argument."""

    name: str
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Lookup:
    """``env("ROBOT", "courier")``: a text that is looked up where the system is started.

    Attributes:
        function: ``env``, a variable of the environment; ``share``, the share folder of a package;
            ``this_dir``, the folder of the file that starts the system.
            ``made``, the path of a file that is made before anything is started; ``installed``,
            whether there is a package, which only the default of an argument may say.
        name: of the variable or the package; of ``this_dir``, the folder of the file it stands in.
        name_from: what the name of a package is computed from; ``name`` is then as written.
        default: of a variable that is not set; ``None``: it has to be.
        made: the file that xacro makes another one of.
    """

    function: Literal["env", "share", "this_dir", "made", "installed"]
    name: str
    default: str | None
    span: Span = field(compare=False, repr=False)
    made: XacroFile | None = None
    name_from: Expression | None = None

    @property
    def key(self) -> str:
        """By which its value is known among those of arguments, whose names have no blank.

        One variable with two defaults has two values where it is not set.
        """
        default = "" if self.default is None else f", {self.default}"
        return f"{self.function} {self.name}{default}"

    @property
    def usual(self) -> str | bool:
        """The text, or the truth, that stands for it while a system is checked."""
        if self.function == "installed":
            return True
        if self.function == "share":
            return f"share:{self.name}"
        if self.function == "made":
            return f"/{self.name}"
        return self.name if self.default is None else self.default


@dataclass(frozen=True, slots=True)
class Interpolation:
    """``"${robot}_base"``: text with the values of arguments in it."""

    pieces: tuple[str | Expression, ...]
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Calculation:
    """``$speed * 2``."""

    operator: ArithmeticOperator
    left: Expression
    right: Expression
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Opposite:
    """``-$speed``."""

    operand: Expression
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Chosen:
    """``if simulated then 0.1 else 1.0``."""

    condition: Condition
    chosen: Expression
    otherwise: Expression
    span: Span = field(compare=False, repr=False)


Expression = Literally | Argument | Lookup | Interpolation | Calculation | Opposite | Chosen
"""What the value of a parameter, a name or a namespace is computed from."""


@dataclass(frozen=True, slots=True)
class Holds:
    """``slam``: an argument of type bool as a condition."""

    operand: Expression
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Compared:
    """``mode = "auto"``."""

    operator: ComparisonOperator
    left: Expression
    right: Expression
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class OneOf:
    """``mode in ["auto", "manual"]``."""

    operand: Expression
    choices: tuple[Literally, ...]
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Not:
    """``not slam``."""

    operand: Condition
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Joined:
    """Conditions of which all hold (``and``), or at least one (``or``)."""

    word: Literal["and", "or"]
    operands: tuple[Condition, ...]
    span: Span = field(compare=False, repr=False)


Condition = Holds | Compared | OneOf | Not | Joined
"""What decides whether a part of a system is there."""


def both(outer: Condition | None, inner: Condition | None) -> Condition | None:
    """Return the condition that two hold, each of which may be missing."""
    if outer is None or inner is None:
        return outer or inner
    return Joined("and", (outer, inner), inner.span)


@dataclass(frozen=True, slots=True)
class Passed:
    """``speed = $speed``: the value that a system which uses another gives to its argument."""

    name: Name
    value: Expression
    span: Span = field(compare=False, repr=False)


def merged(pieces: Iterable[str | Expression]) -> tuple[str | Expression, ...]:
    """Return the pieces of a text with those of texts within it, and neighbouring texts as one."""
    found: list[str | Expression] = []
    for piece in pieces:
        inner: tuple[str | Expression, ...] = (piece,)
        if isinstance(piece, Interpolation):
            inner = merged(piece.pieces)
        elif isinstance(piece, Literally):
            inner = (str(piece.value),)
        for each in inner:
            if isinstance(each, str) and found and isinstance(found[-1], str):
                found[-1] += each
            elif each != "":
                found.append(each)
    return tuple(found)


def arguments_in(found: Expression | Condition) -> Iterator[Argument]:
    """Yield every use of an argument, in the order written."""
    return (each for each in open_in(found) if isinstance(each, Argument))


def lookups_in(found: Expression | Condition) -> Iterator[Lookup]:
    """Yield everything that is looked up, in the order written."""
    return (each for each in open_in(found) if isinstance(each, Lookup))


def made_in(found: Expression | Condition) -> Iterator[Lookup]:
    """Yield every use of the path of a file that is made."""
    return (each for each in lookups_in(found) if each.made is not None)


def open_in(found: Expression | Condition) -> Iterator[Argument | Lookup]:
    """Yield everything that is known only when the system is started."""
    match found:
        case Argument():
            yield found
        case Lookup(name_from=name):
            yield found
            if name is not None:
                yield from open_in(name)
        case Interpolation(pieces):
            for piece in pieces:
                if not isinstance(piece, str):
                    yield from open_in(piece)
        case Calculation(left=left, right=right) | Compared(left=left, right=right):
            yield from open_in(left)
            yield from open_in(right)
        case Chosen(condition, chosen, otherwise):
            for each in (condition, chosen, otherwise):
                yield from open_in(each)
        case Opposite(operand) | Holds(operand) | OneOf(operand) | Not(operand):
            yield from open_in(operand)
        case Joined(operands=operands):
            for operand in operands:
                yield from open_in(operand)


def launch_text(value: Scalar) -> str:
    """Return a value as the text that launch files and xacro expect."""
    return str(value).lower() if isinstance(value, bool) else str(value)


@dataclass(frozen=True, slots=True)
class LaunchArgument:
    """``NAME = VALUE``: what a launch file, xacro or a parameter file is given, as text.

    ``is_assumed``: its value only stands for others, which may be given at the start.
    """

    name: str
    value: str
    span: Span = field(compare=False, repr=False)
    name_span: Span = field(compare=False, repr=False)
    value_span: Span = field(compare=False, repr=False)
    value_from: Expression | None = None
    is_assumed: bool = False
