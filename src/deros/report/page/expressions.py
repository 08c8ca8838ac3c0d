"""Expressions and conditions of a system as plain data, which the page evaluates.

A tree is a list: its first element says what it is, the others are its operands.

======================= ===========================================================================
tree                    what it stands for
======================= ===========================================================================
``["value", v]``        a value as written
``["argument", name]``  the value of an argument of the outermost system
``["lookup", key]``     what is looked up where the system is started
``["text", piece, …]``  a text; each piece is one, or a tree
``["+", a, b]`` …       a calculation; ``["neg", a]`` is the opposite of a number
``["if", c, a, b]``      one of two values, by a condition
``["holds", a]``        a bool as a condition
``["=", a, b]`` …       a comparison; ``["in", a, v, …]``: one of several values
``["not", c]``          and ``["and", c, …]``, ``["or", c, …]`` of conditions
======================= ===========================================================================

A value is a text or a bool as it is. An integer is ``{"int": "3"}`` and a double
``{"double": "0.5"}``: JSON does not tell them apart, and a browser would round large integers.
"""

from __future__ import annotations

from typing import Any

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
)
from deros.models.common import Scalar, Value
from deros.systems.arguments.symbolic import SymbolicSystem, as_written, joined

Json = Any
"""What :mod:`json` can write."""


class Encoder:
    """Writes the texts, values and conditions of one system as data.

    Attributes:
        lookups: what the system looks up when it is started, by key.
    """

    def __init__(self, symbolic: SymbolicSystem | None) -> None:
        """Encode the texts of ``symbolic``; without one, no text has a mark."""
        self._symbolic = symbolic
        self.lookups: dict[str, Lookup] = {}

    def name(self, name: str) -> Json:
        """Return a graph name.

        What is computed in one may turn out absolute: behind a doubled ``/`` the name starts anew.
        """
        return self.text(joined(name))

    def text(self, text: str) -> Json:
        """Return a text as it is, or the tree that it is computed from."""
        if self._symbolic is None:
            return text
        pieces = self._symbolic.pieces(text)
        if all(isinstance(each, str) for each in pieces):
            return text
        if len(pieces) == 1 and not isinstance(pieces[0], str):
            return self.expression(pieces[0])
        return ["text", *(p if isinstance(p, str) else self.expression(p) for p in pieces)]

    def setting(self, value: Value) -> Json:
        """Return the value of a parameter: a tree, a value, or a list ``["list", …]`` of them."""
        if isinstance(value, tuple):
            return ["list", *map(self.setting, value)]
        return self.text(as_written(value)) if isinstance(value, str) else literal(value)

    def expression(self, found: Expression) -> Json:
        """Return the tree of an expression."""
        match found:
            case Literally(value):
                return ["value", literal(value)]
            case Argument(name):
                return ["argument", name]
            case Lookup(name_from=name) if name is not None:
                return ["text", "share:", self.expression(name)]
            case Lookup():
                self.lookups.setdefault(found.key, found)
                return ["lookup", found.key]
            case Interpolation(pieces):
                return ["text", *(p if isinstance(p, str) else self.expression(p) for p in pieces)]
            case Calculation(word, left, right):
                return [word, self.expression(left), self.expression(right)]
            case Chosen(condition, chosen, otherwise):
                both = self.expression(chosen), self.expression(otherwise)
                return ["if", self.condition(condition), *both]
            case Opposite(operand):
                return ["neg", self.expression(operand)]

    def condition(self, found: Condition) -> Json:
        """Return the tree of a condition."""
        match found:
            case Holds(operand):
                return ["holds", self.expression(operand)]
            case Compared(word, left, right):
                return [word, self.expression(left), self.expression(right)]
            case OneOf(operand, choices):
                return ["in", self.expression(operand), *(literal(c.value) for c in choices)]
            case Not(operand):
                return ["not", self.condition(operand)]
            case Joined(word, operands):
                return [word, *map(self.condition, operands)]


def literal(value: Scalar) -> Json:
    """Return a value, with the kind of a number."""
    if isinstance(value, bool | str):
        return str(value) if isinstance(value, str) else value
    return {"int": str(value)} if isinstance(value, int) else {"double": repr(value)}
