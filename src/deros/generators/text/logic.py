"""Boolean expressions of the emitted Python, and their layout.

They are two-valued. A condition of the rules, which is three-valued, is emitted as two expressions:
whether it is true, and whether it is false (:mod:`deros.generators.monitor.python.conditions`).
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from deros.generators.text.document import (
    LINE,
    SOFTLINE,
    Document,
    concat,
    flatten,
    group,
    if_broken,
    join,
    nest,
    render_lines,
)
from deros.generators.text.python import LINE_LENGTH


@dataclass(frozen=True, slots=True)
class Atom:
    """An operand that needs no brackets: a comparison, a name, or ``not`` of a name."""

    text: str


@dataclass(frozen=True, slots=True)
class _Junction:
    operands: tuple[Logic, ...]


class AllOf(_Junction):
    """The conjunction of two or more operands."""

    __slots__ = ()


class AnyOf(_Junction):
    """The disjunction of two or more operands."""

    __slots__ = ()


@dataclass(frozen=True, slots=True)
class NoneOf:
    """The negation of an operand."""

    operand: Logic


Logic = Atom | AllOf | AnyOf | NoneOf


def all_of(operands: Iterable[Logic]) -> Logic:
    """Return the conjunction, without nested conjunctions and repeated operands."""
    flat: dict[Logic, None] = {}
    for op in operands:
        flat.update(dict.fromkeys(op.operands if isinstance(op, AllOf) else (op,)))
    return next(iter(flat)) if len(flat) == 1 else AllOf(tuple(flat))


def any_of(operands: Iterable[Logic]) -> Logic:
    """Return the disjunction, without nested disjunctions and repeated operands."""
    flat: dict[Logic, None] = {}
    for op in operands:
        flat.update(dict.fromkeys(op.operands if isinstance(op, AnyOf) else (op,)))
    return next(iter(flat)) if len(flat) == 1 else AnyOf(tuple(flat))


def text(logic: Logic) -> str:
    """Return the expression on one line."""
    return flatten(_document("", logic))


def lay_out(indent: int, before: str, logic: Logic, after: str = "") -> list[str]:
    """Return ``before`` + expression + ``after`` in lines that are not too long.

    Args:
        indent: the blanks in front of every line.
        before: the text in front of the expression, ``if `` for instance.
        logic: the expression.
        after: the text behind it, ``:`` for instance.
    """
    return render_lines(concat(_document(before, logic), after), LINE_LENGTH, indent)


def _document(before: str, logic: Logic, *, in_brackets: bool = False) -> Document:
    """Return the layout of an expression: one operand on each line where it is too long.

    Args:
        before: the text in front of it.
        logic: the expression.
        in_brackets: whether it needs brackets on one line, too.
    """
    while isinstance(logic, NoneOf):
        before, logic, in_brackets = f"{before}not ", logic.operand, True
    if isinstance(logic, Atom) and not in_brackets:
        return before + logic.text
    opening, closing = ("(", ")") if in_brackets else (if_broken("("), if_broken(")"))
    return group(before, opening, nest(4, SOFTLINE, _operands(logic)), SOFTLINE, closing)


def _operands(logic: Atom | AllOf | AnyOf) -> Document:
    if isinstance(logic, Atom):
        return logic.text
    operands = (_document("", op, in_brackets=isinstance(op, AnyOf)) for op in logic.operands)
    return join(concat(LINE, "and " if isinstance(logic, AllOf) else "or "), operands)
