"""Expressions and conditions of systems as text, in one form for all that mean the same.

The operands of ``and`` and ``or`` are sorted, because their order means nothing.
"""

from __future__ import annotations

from deros.diff.texts import joined, value_text
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
    LaunchArgument,
    Literally,
    Lookup,
    Not,
    OneOf,
    Opposite,
)

ALWAYS = "always"
"""The condition of a part without one."""


def expression_text(found: Expression) -> str:
    """Return an expression as systems write it."""
    match found:
        case Literally(value):
            return value_text(value)
        case Argument(name):
            return f"${name}"
        case Lookup():
            return _lookup_text(found)
        case Interpolation(pieces):
            return f'"{"".join(map(piece_text, pieces))}"'
        case Calculation(word, left, right):
            return f"({expression_text(left)} {word} {expression_text(right)})"
        case Chosen(condition, chosen, otherwise):
            texts = condition_text(condition), expression_text(chosen), expression_text(otherwise)
            return "if {} then {} else {}".format(*texts)
        case Opposite(operand):
            return f"-{expression_text(operand)}"


def piece_text(piece: str | Expression) -> str:
    """Return a piece of a text: the computed ones in ``${…}``."""
    if isinstance(piece, str):
        return piece
    return f"${{{expression_text(piece).removeprefix('$')}}}"


def _lookup_text(found: Lookup) -> str:
    if found.made is not None:
        given = joined(map(_given_text, found.made.arguments))
        return f"xacro({value_text(found.made.path)}{', ' if given else ''}{given})"
    if found.function == "this_dir":  # the folder itself differs between two copies of a file
        return "this_dir()"
    name = value_text(found.name) if found.name_from is None else expression_text(found.name_from)
    default = "" if found.default is None else f", {value_text(found.default)}"
    return f"{found.function}({name}{default})"


def _given_text(found: LaunchArgument) -> str:
    value = found.value_from
    return f"{found.name} = {value_text(found.value) if value is None else expression_text(value)}"


def condition_text(found: Condition | None) -> str:
    """Return a condition as systems write it."""
    match found:
        case None:
            return ALWAYS
        case Holds(operand):
            return expression_text(operand).removeprefix("$")
        case Compared(word, left, right):
            return f"{expression_text(left).removeprefix('$')} {word} {expression_text(right)}"
        case OneOf(operand, choices):
            values = sorted(value_text(each.value) for each in choices)
            return f"{expression_text(operand).removeprefix('$')} in [{joined(values)}]"
        case Not(operand):
            return f"not {_inner(operand)}"
        case Joined(word, operands):
            return f" {word} ".join(sorted(map(_inner, operands)))


def _inner(found: Condition) -> str:
    text = condition_text(found)
    return f"({text})" if isinstance(found, Joined | Compared | OneOf) else text


def conjuncts(text_of: Condition | None) -> frozenset[str]:
    """Return the conditions that all have to hold; of a part without one, none."""
    if text_of is None:
        return frozenset()
    if isinstance(text_of, Joined) and text_of.word == "and":
        return frozenset().union(*map(conjuncts, text_of.operands))
    return frozenset((condition_text(text_of),))
