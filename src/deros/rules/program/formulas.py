"""Formulas: what a function of the table computes, in a small language that every target prints.

A formula is written in the syntax of Python: assignments, one a line, and an expression as the last
line. There are numbers, names, ``+ - * /``, comparisons, ``and``, ``or``, ``not``, ``a if c else
b`` and calls of the functions in :data:`CALLS` and of the formulas in :data:`SHARED`. Every name is
assigned once. ``unknown`` and ``inf`` are constants.

Numbers are IEEE doubles, and NaN is *unknown*: no comparison with it is true, and arithmetic hands
it on. A formula has a value for all arguments: the parser guards each operation that is not defined
everywhere, so that its result is unknown where Python would raise an exception. What it can see to
be defined, such as the root of a sum of squares, it leaves alone.
"""

from __future__ import annotations

import ast
import math
import operator as operators
from collections.abc import Callable, Iterator, Mapping, MutableMapping
from dataclasses import dataclass
from typing import Literal

Arithmetic = Literal["+", "-", "*", "/"]
Comparison = Literal["<", "<=", ">", ">=", "==", "!="]


@dataclass(frozen=True, slots=True)
class Number:
    """A constant; NaN is *unknown*."""

    value: float


@dataclass(frozen=True, slots=True)
class Name:
    """An argument, a field of the memory, or what was assigned before."""

    name: str


@dataclass(frozen=True, slots=True)
class Negative:
    """A number with the other sign."""

    operand: Expression


@dataclass(frozen=True, slots=True)
class Binary:
    """An operation on two numbers."""

    operator: Arithmetic
    left: Expression
    right: Expression


@dataclass(frozen=True, slots=True)
class Call:
    """A call of a function of numbers; of those in :data:`CALLS` only ``known`` gives a boolean."""

    function: str
    arguments: tuple[Expression, ...]


@dataclass(frozen=True, slots=True)
class Relation:
    """A comparison of two numbers; false if one is unknown, but for ``!=``."""

    operator: Comparison
    left: Expression
    right: Expression


@dataclass(frozen=True, slots=True)
class Logical:
    """A conjunction or a disjunction."""

    operator: Literal["and", "or"]
    operands: tuple[Expression, ...]


@dataclass(frozen=True, slots=True)
class Negation:
    """A condition that holds where its operand does not."""

    operand: Expression


@dataclass(frozen=True, slots=True)
class Choice:
    """One of two numbers, by a condition."""

    condition: Expression
    then: Expression
    otherwise: Expression


Expression = Number | Name | Negative | Binary | Call | Relation | Logical | Negation | Choice


@dataclass(frozen=True, slots=True)
class Formula:
    """Assignments in order, and the result.

    Attributes:
        assignments: pairs of a name and its value.
        result: the value of the formula.
    """

    assignments: tuple[tuple[str, Expression], ...]
    result: Expression

    @property
    def names(self) -> frozenset[str]:
        """The names that occur, assigned ones included."""
        expressions = [value for _, value in self.assignments] + [self.result]
        parts = (part for value in expressions for part in _parts(value))
        read = {part.name for part in parts if isinstance(part, Name)}
        return frozenset(read | {name for name, _ in self.assignments})


CALLS: Mapping[str, int] = {
    "sqrt": 1,
    "sin": 1,
    "cos": 1,
    "tan": 1,
    "asin": 1,
    "atan2": 2,
    "remainder": 2,
    "known": 1,
    "double": 1,
}
"""The functions of the language, and how many arguments each takes.

``known`` tests for a number that is not NaN, ``double`` rounds an integer to a double.
"""

UNKNOWN = Number(math.nan)
_CONSTANTS: Mapping[str, Number] = {"unknown": UNKNOWN, "inf": Number(math.inf)}
_ARITHMETIC: Mapping[type[ast.operator], Arithmetic] = {
    ast.Add: "+",
    ast.Sub: "-",
    ast.Mult: "*",
    ast.Div: "/",
}
_COMPARISONS: Mapping[type[ast.cmpop], Comparison] = {
    ast.Lt: "<",
    ast.LtE: "<=",
    ast.Gt: ">",
    ast.GtE: ">=",
    ast.Eq: "==",
    ast.NotEq: "!=",
}


# Parsing ----------------------------------------------------------------------------------------


def parse(text: str) -> Formula:
    """Return the formula of a text.

    Raises:
        ValueError: the text is not a formula.
    """
    *assignments, last = ast.parse(text.strip()).body
    if not isinstance(last, ast.Expr):
        raise ValueError(f"the last line is not an expression: {ast.unparse(last)}")
    return Formula(tuple(map(_assignment, assignments)), _expression(last.value))


def _assignment(statement: ast.stmt) -> tuple[str, Expression]:
    match statement:
        case ast.Assign(targets=[ast.Name(id=name)], value=value):
            return name, _expression(value)
    raise ValueError(f"not an assignment to a name: {ast.unparse(statement)}")


def _expression(node: ast.expr) -> Expression:
    match node:
        case ast.Constant(value=int() | float() as value) if not isinstance(value, bool):
            return Number(float(value))
        case ast.Name(id=name):
            return _CONSTANTS.get(name) or Name(name)
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            inner = _expression(operand)
            return Number(-inner.value) if isinstance(inner, Number) else Negative(inner)
        case ast.UnaryOp(op=ast.Not(), operand=operand):
            return Negation(_expression(operand))
        case ast.BinOp(left=left, op=op, right=right) if type(op) in _ARITHMETIC:
            found = Binary(_ARITHMETIC[type(op)], _expression(left), _expression(right))
            return guarded_division(found)
        case ast.BoolOp(op=op, values=values):
            word: Literal["and", "or"] = "and" if isinstance(op, ast.And) else "or"
            return Logical(word, tuple(map(_expression, values)))
        case ast.Compare(left=left, ops=ops, comparators=comparators):
            return _comparison([left, *comparators], ops)
        case ast.IfExp(test=test, body=body, orelse=orelse):
            return Choice(_expression(test), _expression(body), _expression(orelse))
        case ast.Call(func=ast.Name(id=name), args=arguments, keywords=[]):
            return guarded_call(name, tuple(map(_expression, arguments)))
    raise ValueError(f"a formula cannot say {ast.unparse(node)!r}")


def _comparison(operands: list[ast.expr], ops: list[ast.cmpop]) -> Expression:
    values = list(map(_expression, operands))
    relations = tuple(
        Relation(_COMPARISONS[type(op)], *values[place : place + 2]) for place, op in enumerate(ops)
    )
    return relations[0] if len(relations) == 1 else Logical("and", relations)


def guarded_call(name: str, arguments: tuple[Expression, ...]) -> Expression:
    """Return a call of a function; unknown where the function is not defined.

    Raises:
        ValueError: there is no such function, or it takes another number of arguments.
    """
    taken = CALLS.get(name, len(SHARED[name][0]) if name in SHARED else 0)
    if not taken or len(arguments) != taken:
        raise ValueError(f"a formula cannot call {name}() with {len(arguments)} arguments")
    found = Call(name, arguments)
    first = arguments[0]
    zero, one = Number(0.0), Number(1.0)
    match name:
        case "sqrt" if not _is_never_negative(first):
            return Choice(Relation(">=", first, zero), found, UNKNOWN)
        case "asin" if not (isinstance(first, Call) and first.function == "clamped"):
            inside = (Relation(">=", first, Number(-1.0)), Relation("<=", first, one))
            return Choice(Logical("and", inside), found, UNKNOWN)
        case "sin" | "cos" | "tan":
            return Choice(Logical("and", _is_finite(first)), found, UNKNOWN)
        case "remainder":
            turn = arguments[1]
            known = () if _is_other_than_zero(turn) else (Relation("!=", turn, zero),)
            return Choice(Logical("and", (*_is_finite(first), *known)), found, UNKNOWN)
    return found


def _is_finite(value: Expression) -> tuple[Relation, Relation]:
    return Relation(">", value, Number(-math.inf)), Relation("<", value, Number(math.inf))


def guarded_division(found: Binary) -> Expression:
    """Return an operation; a quotient, such that it is unknown where its divisor is zero."""
    if found.operator != "/" or _is_other_than_zero(found.right):
        return found
    return Choice(Relation("!=", found.right, Number(0.0)), found, UNKNOWN)


def _is_other_than_zero(value: Expression) -> bool:
    return isinstance(value, Number) and value.value != 0.0


def _is_never_negative(value: Expression) -> bool:
    """Return whether a number is seen to be at least 0, if it is known."""
    match value:
        case Number():
            return value.value >= 0.0
        case Binary(operator="*", left=left, right=right) if left == right:
            return True
        case Binary(operator="+" | "*", left=left, right=right):
            return _is_never_negative(left) and _is_never_negative(right)
        case Call(function="sqrt"):
            return True
    return False


def _parts(value: Expression) -> Iterator[Expression]:
    yield value
    match value:
        case Negative(operand=operand) | Negation(operand=operand):
            yield from _parts(operand)
        case Binary(left=left, right=right) | Relation(left=left, right=right):
            yield from _parts(left)
            yield from _parts(right)
        case Call(arguments=operands) | Logical(operands=operands):
            for operand in operands:
                yield from _parts(operand)
        case Choice(condition=condition, then=then, otherwise=otherwise):
            for operand in (condition, then, otherwise):
                yield from _parts(operand)


def has_choices(formula: Formula) -> bool:
    """Return whether a formula asks for a condition, and so might not hand on what is unknown."""
    return choices(formula) > 0


def choices(formula: Formula) -> int:
    """Return how many choices a formula has."""
    values = [value for _, value in formula.assignments] + [formula.result]
    return sum(isinstance(each, Choice) for value in values for each in _parts(value))


def calls(formula: Formula) -> tuple[str, ...]:
    """Return the names of the functions that a formula calls, each once."""
    values = [value for _, value in formula.assignments] + [formula.result]
    found = [each for value in values for each in _parts(value) if isinstance(each, Call)]
    return tuple(dict.fromkeys(each.function for each in found))


def renamed(formula: Formula, names: Mapping[str, str]) -> Formula:
    """Return a formula with some of its names replaced."""

    def new(value: Expression) -> Expression:
        match value:
            case Number():
                return value
            case Name():
                return Name(names.get(value.name, value.name))
            case Negative():
                return Negative(new(value.operand))
            case Binary():
                return Binary(value.operator, new(value.left), new(value.right))
            case Call():
                return Call(value.function, tuple(map(new, value.arguments)))
            case Relation():
                return Relation(value.operator, new(value.left), new(value.right))
            case Logical():
                return Logical(value.operator, tuple(map(new, value.operands)))
            case Negation():
                return Negation(new(value.operand))
            case Choice():
                return Choice(new(value.condition), new(value.then), new(value.otherwise))

    assignments = ((names.get(name, name), new(value)) for name, value in formula.assignments)
    return Formula(tuple(assignments), new(formula.result))


# Interpreting -----------------------------------------------------------------------------------

_OPERATORS: Mapping[str, Callable[[float, float], float]] = {
    "+": operators.add,
    "-": operators.sub,
    "*": operators.mul,
    "/": operators.truediv,
}
_TESTS: Mapping[str, Callable[[float, float], bool]] = {
    "<": operators.lt,
    "<=": operators.le,
    ">": operators.gt,
    ">=": operators.ge,
    "==": operators.eq,
    "!=": operators.ne,
}
_MATHEMATICS: Mapping[str, Callable[..., float]] = {
    "sqrt": math.sqrt,
    "sin": math.sin,
    "cos": math.cos,
    "tan": math.tan,
    "asin": math.asin,
    "atan2": math.atan2,
    "remainder": math.remainder,
    "double": float,
}


def evaluate(formula: Formula, names: MutableMapping[str, float]) -> float:
    """Return the value of a formula; what it assigns is stored in ``names``."""
    for name, value in formula.assignments:
        names[name] = number(value, names)
    return number(formula.result, names)


def number(value: Expression, names: Mapping[str, float]) -> float:
    """Return the value of an expression that is a number."""
    match value:
        case Number():
            return value.value
        case Name():
            return names[value.name]
        case Negative():
            return -number(value.operand, names)
        case Binary():
            left, right = number(value.left, names), number(value.right, names)
            return _OPERATORS[value.operator](left, right)
        case Choice():
            chosen = value.then if holds(value.condition, names) else value.otherwise
            return number(chosen, names)
        case Call() if value.function in _MATHEMATICS:
            arguments = [number(each, names) for each in value.arguments]
            return _MATHEMATICS[value.function](*arguments)
        case Call() if value.function in SHARED:
            parameters, shared = SHARED[value.function]
            arguments = [number(each, names) for each in value.arguments]
            return evaluate(shared, dict(zip(parameters, arguments, strict=True)))
    raise AssertionError(f"{value} is not a number")


def holds(condition: Expression, names: Mapping[str, float]) -> bool:
    """Return whether a condition holds."""
    match condition:
        case Relation():
            left, right = number(condition.left, names), number(condition.right, names)
            return _TESTS[condition.operator](left, right)
        case Logical(operator="and"):
            return all(holds(each, names) for each in condition.operands)
        case Logical():
            return any(holds(each, names) for each in condition.operands)
        case Negation():
            return not holds(condition.operand, names)
        case Call(function="known"):
            return not math.isnan(number(condition.arguments[0], names))
        case Name():
            return bool(names[condition.name])
    raise AssertionError(f"{condition} is not a condition")


SHARED: dict[str, tuple[tuple[str, ...], Formula]] = {}
"""Formulas that others call by name: their parameters, and what they compute."""

SHARED["clamped"] = (
    ("sine",),
    parse("1.0 if sine > 1.0 else (-1.0 if sine < -1.0 else sine)"),
)
# Of zeros the one with the sign minus is the lesser, as in IEEE 754-2019, minimum and maximum.
SHARED["least"] = (
    ("a", "b"),
    parse(
        "a if a < b else (b if b < a else (unknown if a != b else (a if a != 0.0 else -(-a - b))))"
    ),
)
SHARED["greatest"] = (
    ("a", "b"),
    parse("a if a > b else (b if b > a else (unknown if a != b else (a if a != 0.0 else a + b)))"),
)
