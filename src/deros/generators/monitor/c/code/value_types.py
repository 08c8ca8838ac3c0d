"""What conditions compare, which inputs it is read from, and the types of C that hold it."""

from __future__ import annotations

from deros.interfaces.types import FLOAT_TYPES, INTEGER_RANGES, STRING_TYPES, FieldType
from deros.rules.functions.functions import FUNCTIONS, Result
from deros.rules.program.ir import (
    Apply,
    Compare,
    Compute,
    Condition,
    Const,
    Program,
    Read,
    Scale,
    Truth,
    Tuned,
    Unknown,
    ValueExpression,
    Within,
)

ELEMENTS = {
    **{base: f"{base}_t" for base in INTEGER_RANGES},
    "byte": "uint8_t",
    "char": "uint8_t",
    "float32": "float",
    "float64": "double",
    "bool": "bool",
}
"""The C type of an array's element, by the primitive type of ROS 2."""


def compared(condition: Condition) -> list[ValueExpression]:
    """Return the values, constants left out, that a condition itself (no part) compares."""
    match condition:
        case Truth(operand=operand):
            found = [operand]
        case Compare(left=left, right=right):
            found = [left, right]
        case Within(operand=operand, lower=lower, upper=upper):
            found = [operand, lower, upper]
        case Unknown(operand=Apply() as function):
            found = [function]
        case _:
            found = []
    return [value for value in found if not isinstance(value, Const)]


def inputs_of(program: Program, value: ValueExpression) -> frozenset[int]:
    """Return the inputs that a value is read from."""
    match value:
        case Apply():
            return frozenset({value.input})
        case Scale():
            return inputs_of(program, value.operand)
        case Read():
            return frozenset({program.leaves[value.leaf].input})
        case Compute():
            return frozenset().union(*(inputs_of(program, each) for each in value.operands))
        case Tuned():
            return frozenset()
        case Const():
            raise AssertionError("a constant is read from no input")


def type_of(program: Program, value: ValueExpression) -> str:
    """Return the C type of a value; ``text`` for one."""
    match value:
        case Const():
            return _type_of_constant(value.value)
        case Scale() | Compute() | Tuned():
            return "double"
        case Read():
            return c_type(program.leaves[value.leaf].type)
        case Apply():
            row = FUNCTIONS[value.function]
            if row.result is Result.INTEGER:
                return "int64_t"
            return (
                type_of(program, value.arguments[0]) if row.result is Result.ELEMENT else "double"
            )


def c_type(kind: FieldType) -> str:
    """Return the C type that holds an element of a leaf; ``text`` for one."""
    base = kind.base
    if base == "bool":
        return "bool"
    if base in FLOAT_TYPES:
        return "double"
    if base in STRING_TYPES:
        return "text"
    return "uint64_t" if base == "uint64" else "int64_t"


def _type_of_constant(value: object) -> str:
    if isinstance(value, bool):
        return "bool"
    if isinstance(value, str):
        return "text"
    return "int64_t" if isinstance(value, int) else "double"
