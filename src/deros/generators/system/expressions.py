"""Expressions and conditions as Python text, for scripts that know the values of the arguments."""

from __future__ import annotations

import itertools
import os
from collections.abc import Callable
from pathlib import Path

from deros.generators.system.computed import Computed
from deros.models.arguments import (
    Argument,
    Calculation,
    Chosen,
    Compared,
    Condition,
    Expression,
    Holds,
    Interpolation,
    Joined,
    Literally,
    Lookup,
    Not,
    OneOf,
    Opposite,
    merged,
)
from deros.models.node import ParameterType

Named = Callable[[Argument | Lookup | Chosen], str]
"""Returns the text that stands for the value of an argument, of what is looked up, or chosen."""

_CHOICE, _SUM, _PRODUCT, _UNARY, _ATOM = range(5)
_STRENGTH = {"+": _SUM, "-": _SUM, "*": _PRODUCT, "/": _PRODUCT}
_COMPARISONS = {"=": "==", "!=": "!="}
_OR, _AND, _NOT, _COMPARISON = range(4)


def relative_folder(found: Lookup, start: Path) -> str | None:
    """Return the way from a folder to the one that ``this_dir`` means; None: it is the same."""
    folder = Path(os.path.relpath(found.name, start)).as_posix()
    return None if folder == "." else folder


def python_value(found: Computed, named: Named) -> str:
    """Return the text of a computed value, converted to a double where that is declared."""
    if len(found.pieces) > 1 or isinstance(found.pieces[0], str | Interpolation):
        return _text(found.pieces, named)
    text = python_expression(found.pieces[0], named)
    return f"float({text})" if found.type is ParameterType.DOUBLE else text


def python_expression(found: Expression, named: Named) -> str:
    """Return the text of an expression."""
    return _expression(found, named)[0]


def _expression(found: Expression, named: Named) -> tuple[str, int]:
    match found:
        case Literally(value):
            return repr(value), _UNARY if _is_negative(value) else _ATOM
        case Argument() | Lookup():
            return named(found), _ATOM
        case Interpolation(pieces):
            return _text(pieces, named), _ATOM
        case Chosen():
            return named(found), _CHOICE
        case Opposite(operand):
            return f"-{_operand(operand, _UNARY, named)}", _UNARY
        case Calculation(operator, left, right):
            strength = _STRENGTH[operator]
            one, other = (_operand(left, strength, named), _operand(right, strength + 1, named))
            return f"{one} {operator} {other}", strength


def python_choice(found: Chosen, named: Named) -> str:
    """Return the text of a choice between two values."""
    chosen = _operand(found.chosen, _SUM, named)
    otherwise = _operand(found.otherwise, _CHOICE, named)
    return f"{chosen} if {python_condition(found.condition, named)} else {otherwise}"


def _is_negative(value: object) -> bool:
    return isinstance(value, int | float) and value < 0


def _operand(found: Expression, least: int, named: Named) -> str:
    text, strength = _expression(found, named)
    return text if strength >= least else f"({text})"


def _text(pieces: tuple[str | Expression, ...], named: Named) -> str:
    """Return an f-string; a single value needs none.

    What is looked up, or chosen, stands beside it: quotes would end the string.
    """
    joined: list[str] = []
    for stand_beside, run in itertools.groupby(merged(pieces), key=_stands_beside):
        found = tuple(run)
        joined += [_beside(e, named) for e in found] if stand_beside else [_f_string(found, named)]
    return " + ".join(joined) if len(joined) > 1 else "".join(joined) or repr("")


def _stands_beside(piece: str | Expression) -> bool:
    return isinstance(piece, Lookup | Chosen)


def _beside(piece: str | Expression, named: Named) -> str:
    assert not isinstance(piece, str)
    text = python_expression(piece, named)
    return text if isinstance(piece, Lookup) else f"str({text})"


def _f_string(flat: tuple[str | Expression, ...], named: Named) -> str:
    if len(flat) == 1 and not isinstance(flat[0], str):
        return f"str({python_expression(flat[0], named)})"
    if all(isinstance(each, str) for each in flat):
        return repr("".join(map(str, flat)))
    # Of a text with a quotation mark in it, repr stands between apostrophes, and escapes those.
    inside = "".join(
        repr(f'"{each}')[2:-1].replace("{", "{{").replace("}", "}}")
        if isinstance(each, str)
        else f"{{{python_expression(each, named)}}}"
        for each in flat
    )
    return f"f'{inside}'"


def python_condition(found: Condition, named: Named) -> str:
    """Return the text of a condition."""
    return _condition(found, named)[0]


def _condition(found: Condition, named: Named) -> tuple[str, int]:
    match found:
        case Holds(operand):
            return _operand(operand, _SUM, named), _COMPARISON
        case Compared(operator, left, right):
            one, other = (_operand(each, _SUM, named) for each in (left, right))
            return f"{one} {_COMPARISONS.get(operator, operator)} {other}", _COMPARISON
        case OneOf(operand, choices):
            return f"{_operand(operand, _SUM, named)} in {_choices(choices)}", _COMPARISON
        case Not(OneOf(operand, choices)):
            return f"{_operand(operand, _SUM, named)} not in {_choices(choices)}", _COMPARISON
        case Not(operand):
            return f"not {_within(operand, _NOT, named)}", _NOT
        case Joined(word, operands):
            strength = _AND if word == "and" else _OR
            joined = (_within(each, strength, named) for each in operands)
            return f" {word} ".join(joined), strength


def _choices(choices: tuple[Literally, ...]) -> str:
    listed = ", ".join(repr(each.value) for each in choices)
    return f"({listed}{',' * (len(choices) == 1)})"


def _within(found: Condition, least: int, named: Named) -> str:
    text, strength = _condition(found, named)
    return text if strength >= least else f"({text})"
