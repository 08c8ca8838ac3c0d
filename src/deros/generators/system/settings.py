"""Texts and values of a system, as far as they are known before it is started."""

from __future__ import annotations

from collections.abc import Iterable

from deros.generators.system.computed import Computed, Setting, Text
from deros.models.common import Scalar, Value
from deros.models.node import ParameterType
from deros.models.programs import Variable, Word
from deros.systems.arguments.evaluate import type_of
from deros.systems.arguments.symbolic import SymbolicSystem, as_written

_ELEMENTS = {
    ParameterType.BOOL_ARRAY: ParameterType.BOOL,
    ParameterType.INTEGER_ARRAY: ParameterType.INTEGER,
    ParameterType.DOUBLE_ARRAY: ParameterType.DOUBLE,
    ParameterType.STRING_ARRAY: ParameterType.STRING,
}


def environment_of(
    variables: Iterable[Variable], symbolic: SymbolicSystem | None
) -> tuple[tuple[str, Text], ...]:
    """Return variables of the environment."""
    return tuple((each.name, word_text(each.value, symbolic)) for each in variables)


def word_text(word: Word, symbolic: SymbolicSystem | None) -> Text:
    """Return a word that a program is started with."""
    return marked_text(as_written(word.text), symbolic)


def marked_text(text: str, symbolic: SymbolicSystem | None) -> Text:
    """Return a text, or what one with marks of computed parts is made of."""
    if symbolic is None:
        return text
    pieces = symbolic.pieces(text)
    return text if all(isinstance(each, str) for each in pieces) else Computed(pieces)


def setting_of(
    value: Value, kind: ParameterType | None, symbolic: SymbolicSystem | None
) -> Setting:
    """Return the value of a parameter, or what it is computed from."""
    if not isinstance(value, tuple):
        return _computed(value, kind, symbolic)
    found = tuple(_computed(each, kind, symbolic) for each in value)
    if kind is None and _is_of_doubles(found):
        return tuple(_computed(each, ParameterType.DOUBLE_ARRAY, symbolic) for each in value)
    return found


def _is_of_doubles(found: tuple[Scalar | Computed, ...]) -> bool:
    """Return whether there is a double among numbers, which makes all of them doubles."""
    kinds = {each.type if isinstance(each, Computed) else type_of(each) for each in found}
    return kinds == {ParameterType.INTEGER, ParameterType.DOUBLE}


def value_as_written(value: Value) -> Value:
    """Return a value with the texts in it as the system has them."""
    if isinstance(value, tuple):
        return tuple(as_written(each) if isinstance(each, str) else each for each in value)
    return as_written(value) if isinstance(value, str) else value


def _computed(
    value: Scalar, kind: ParameterType | None, symbolic: SymbolicSystem | None
) -> Scalar | Computed:
    """Return a value, or what it is computed from, with the type that the node declares.

    Where it declares none, it is that of the expression.
    """
    found = marked_text(value, symbolic) if isinstance(value, str) else value
    if isinstance(found, Computed) and symbolic is not None:
        own = symbolic.type_of(found.pieces) if kind is None else _ELEMENTS.get(kind, kind)
        return Computed(found.pieces, own)
    if kind in (ParameterType.DOUBLE, ParameterType.DOUBLE_ARRAY) and type(found) is int:
        return float(found)  # ROS 2 distinguishes both
    return found
