"""Boolean expressions of the emitted Python, and how they are laid out in lines.

They are two-valued: three-valued conditions are emitted as the question whether they are true, or
whether they are false (:mod:`deros.generators.monitor.python.conditions`).
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

MAX_LINE = 99
"""The length that ament_flake8 allows."""


@dataclass(frozen=True, slots=True)
class Atom:
    """Text that binds more tightly than ``and``: a comparison, a name, ``not`` of a name."""

    text: str


@dataclass(frozen=True, slots=True)
class AllOf:
    """``and`` of its operands, of which there are two or more."""

    operands: tuple[Logic, ...]


@dataclass(frozen=True, slots=True)
class AnyOf:
    """``or`` of its operands, of which there are two or more."""

    operands: tuple[Logic, ...]


@dataclass(frozen=True, slots=True)
class NoneOf:
    """``not`` of its operand."""

    operand: Logic


Logic = Atom | AllOf | AnyOf | NoneOf


def all_of(operands: Iterable[Logic]) -> Logic:
    """Return the conjunction, without needless nesting and repeats."""
    flat: dict[Logic, None] = {}
    for each in operands:
        flat.update(dict.fromkeys(each.operands if isinstance(each, AllOf) else (each,)))
    return next(iter(flat)) if len(flat) == 1 else AllOf(tuple(flat))


def any_of(operands: Iterable[Logic]) -> Logic:
    """Return the disjunction, without needless nesting and repeats."""
    flat: dict[Logic, None] = {}
    for each in operands:
        flat.update(dict.fromkeys(each.operands if isinstance(each, AnyOf) else (each,)))
    return next(iter(flat)) if len(flat) == 1 else AnyOf(tuple(flat))


def text(logic: Logic) -> str:
    """Return the expression in one line."""
    if isinstance(logic, Atom):
        return logic.text
    if isinstance(logic, NoneOf):
        return f"not ({text(logic.operand)})"
    parts = [text(each) for each in logic.operands]
    if isinstance(logic, AllOf):
        inner = zip(parts, logic.operands, strict=True)
        return " and ".join(f"({part})" if isinstance(op, AnyOf) else part for part, op in inner)
    return " or ".join(parts)


def lay_out(indent: int, before: str, logic: Logic, after: str = "") -> list[str]:
    """Return ``before`` + expression + ``after`` in lines that are not too long.

    ``before`` and ``after`` are what stands around the expression, as ``if `` and ``:``.
    """
    blank = " " * indent
    line = f"{blank}{before}{text(logic)}{after}"
    if len(line) <= MAX_LINE or isinstance(logic, Atom):
        return [line]
    before, inner = _unnegated(before, logic)
    return [f"{blank}{before}(", *_operands(indent + 4, inner), f"{blank}){after}"]


def _operands(indent: int, logic: Atom | AllOf | AnyOf) -> list[str]:
    if isinstance(logic, Atom):
        return [f"{' ' * indent}{logic.text}"]
    word = "and " if isinstance(logic, AllOf) else "or "
    lines: list[str] = []
    for number, each in enumerate(logic.operands):
        lines += _operand(indent, word if number else "", each)
    return lines


def _operand(indent: int, before: str, logic: Logic) -> list[str]:
    blank = " " * indent
    line = f"{blank}{before}{text(logic)}"
    if isinstance(logic, Atom) or (not isinstance(logic, AnyOf) and len(line) <= MAX_LINE):
        return [line]
    before, inner = _unnegated(before, logic)
    line = f"{blank}{before}({text(inner)})"
    if len(line) <= MAX_LINE:
        return [line]
    return [f"{blank}{before}(", *_operands(indent + 4, inner), f"{blank})"]


def _unnegated(before: str, logic: Logic) -> tuple[str, Atom | AllOf | AnyOf]:
    """Return what stands before a pair of parentheses, which ``not`` needs, and within it."""
    while isinstance(logic, NoneOf):
        before, logic = f"{before}not ", logic.operand
    return before, logic


def lay_out_call(indent: int, before: str, arguments: Sequence[str], after: str = ")") -> list[str]:
    """Return a call in lines that are not too long; ``before`` ends with its ``(``."""
    blank = " " * indent
    line = f"{blank}{before}{', '.join(arguments)}{after}"
    if len(line) <= MAX_LINE:
        return [line]
    lines = [f"{blank}{before}", f"{blank}    "]
    for argument in arguments:
        piece = f"{argument}, "
        if len(lines[-1]) + len(piece) > MAX_LINE + 1 and lines[-1].strip():
            lines.append(f"{blank}    ")
        lines[-1] += piece
    return [*(line.rstrip() for line in lines), f"{blank}{after}"]
