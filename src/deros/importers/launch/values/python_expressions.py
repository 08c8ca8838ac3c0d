"""What ``$(eval …)`` computes: the part of Python that a system can say, too."""

from __future__ import annotations

import ast
import re
from typing import TYPE_CHECKING

from deros.importers.launch.values.conditions import (
    NOWHERE,
    all_of,
    any_of,
    compared,
    holds,
    literally,
    negated,
    text_of,
    truth,
)
from deros.importers.launch.values.substitutions import InexpressibleError
from deros.models.arguments import (
    Calculation,
    Chosen,
    Compared,
    Condition,
    Expression,
    Interpolation,
    Literally,
    OneOf,
    Opposite,
)
from deros.models.terms import ArithmeticOperator, ComparisonOperator

if TYPE_CHECKING:
    from deros.importers.launch.values.expressions import Marked

_LONGEST = 4000
_NUMBER = re.compile(r"[+-]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d+)?")
_CALCULATED: dict[type[ast.operator], ArithmeticOperator] = {
    ast.Add: "+",
    ast.Sub: "-",
    ast.Mult: "*",
    ast.Div: "/",
}
_COMPARED: dict[type[ast.cmpop], ComparisonOperator] = {
    ast.Lt: "<",
    ast.LtE: "<=",
    ast.Gt: ">",
    ast.GtE: ">=",
}
_CONDITIONS = (ast.Compare, ast.BoolOp)


class PythonReader:
    """Reads one expression; all of it raises :class:`InexpressibleError`."""

    def __init__(self, marked: Marked) -> None:
        """Read a text in which substitutions are names."""
        self._marked = marked

    def value(self) -> Expression:
        """Return what the expression is."""
        text = self._marked.text.strip()
        if len(text) > _LONGEST:
            raise InexpressibleError("has an expression in Python that is too long")
        try:
            tree = ast.parse(text, mode="eval")
            return self._value(tree.body)
        except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
            raise InexpressibleError("has an expression in Python that cannot be read") from error

    def _value(self, node: ast.expr) -> Expression:
        if isinstance(node, _CONDITIONS) or _is_not(node):
            return truth(self._condition(node), ("True", "False"))
        if isinstance(node, ast.Constant):
            return self._constant(node)
        if isinstance(node, ast.Name | ast.JoinedStr):
            return self._name(node)
        if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub | ast.UAdd):
            operand = self._number(node.operand)
            return operand if isinstance(node.op, ast.UAdd) else Opposite(operand, NOWHERE)
        if isinstance(node, ast.BinOp):
            return self._calculated(node)
        if isinstance(node, ast.IfExp):
            test = self._condition(node.test)
            if isinstance(test, bool):
                return self._value(node.body if test else node.orelse)
            return Chosen(test, self._value(node.body), self._value(node.orelse), NOWHERE)
        if isinstance(node, ast.Call) and _is_conversion(node):
            return self._value(node.args[0])
        raise _refused(node)

    def _constant(self, node: ast.Constant) -> Expression:
        if isinstance(node.value, str):
            return self._marked.expression(node.value)
        if isinstance(node.value, bool | int | float):
            return literally(node.value)
        raise _refused(node)

    def _name(self, node: ast.expr) -> Expression:
        """Return the value of a substitution that stands without quotes."""
        if not isinstance(node, ast.Name) or not self._marked.is_one(node.id):
            raise _refused(node)
        found = self._marked.expression(node.id)
        if isinstance(found, Literally) and isinstance(found.value, str):
            return _as_python(found.value)
        return found

    def _number(self, node: ast.expr) -> Expression:
        found = self._value(node)
        if isinstance(found, Interpolation):
            raise _refused(node)
        if isinstance(found, Literally) and isinstance(found.value, str):
            return _as_python(found.value)
        return found

    def _calculated(self, node: ast.BinOp) -> Expression:
        operator = _CALCULATED.get(type(node.op))
        if operator is None:
            raise _refused(node)
        if operator == "+" and (_is_text(node.left) or _is_text(node.right)):
            return text_of((self._value(node.left), self._value(node.right)))
        left, right = self._number(node.left), self._number(node.right)
        return Calculation(operator, left, right, NOWHERE)

    def _condition(self, node: ast.expr) -> Condition | bool:
        if isinstance(node, ast.BoolOp):
            joined = all_of if isinstance(node.op, ast.And) else any_of
            return joined([self._condition(each) for each in node.values])
        if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.Not):
            return negated(self._condition(node.operand))
        if isinstance(node, ast.Compare):
            before = (node.left, *node.comparators)
            pairs = zip(before, node.ops, node.comparators, strict=False)
            return all_of([self._compared(*each) for each in pairs])
        if _is_text(node):
            return compared("!=", self._value(node), literally(""))  # as Python takes texts
        return holds(self._value(node))

    def _compared(self, left: ast.expr, operator: ast.cmpop, right: ast.expr) -> Condition | bool:
        if isinstance(operator, ast.In | ast.NotIn):
            found = self._one_of(left, right)
            return found if isinstance(operator, ast.In) else negated(found)
        lowered = _lowered(left)
        if lowered is not None and isinstance(right, ast.Constant):
            if right.value not in ("true", "false") or not isinstance(operator, ast.Eq | ast.NotEq):
                raise _refused(left)
            is_so = holds(self._value(lowered))
            is_same = (right.value == "true") == isinstance(operator, ast.Eq)
            return is_so if is_same else negated(is_so)
        if isinstance(operator, ast.Eq | ast.Is):
            return compared("=", self._value(left), self._value(right))
        if isinstance(operator, ast.NotEq | ast.IsNot):
            return compared("!=", self._value(left), self._value(right))
        first, second = self._number(left), self._number(right)
        if isinstance(first, Literally) and isinstance(second, Literally):
            raise _refused(left)
        return Compared(_COMPARED[type(operator)], first, second, NOWHERE)

    def _one_of(self, left: ast.expr, right: ast.expr) -> Condition | bool:
        if not isinstance(right, ast.List | ast.Tuple | ast.Set):
            raise _refused(right)
        value = self._value(left)
        choices = [self._value(each) for each in right.elts]
        literal = tuple(each for each in choices if isinstance(each, Literally))
        if isinstance(value, Literally) or len(literal) != len(choices):
            return any_of([compared("=", value, each) for each in choices])
        return OneOf(value, literal, NOWHERE) if literal else False


def _is_not(node: ast.expr) -> bool:
    return isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.Not)


def _is_conversion(node: ast.Call) -> bool:
    is_one = len(node.args) == 1 and not node.keywords
    names = ("str", "int", "float")
    return is_one and isinstance(node.func, ast.Name) and node.func.id in names


def _is_text(node: ast.expr) -> bool:
    if isinstance(node, ast.BinOp):
        return _is_text(node.left) or _is_text(node.right)
    return isinstance(node, ast.Constant) and isinstance(node.value, str)


def _lowered(node: ast.expr) -> ast.expr | None:
    """Return the text that an expression takes in lower case."""
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and not node.args:
        return node.func.value if node.func.attr == "lower" else None
    return None


def _as_python(text: str) -> Literally:
    """Return the number or truth that a text is in an expression."""
    if text in ("True", "False"):
        return literally(text == "True")
    if not _NUMBER.fullmatch(text):
        raise InexpressibleError(f"has an expression in Python with the name '{text}'")
    return literally(float(text) if re.search("[.eE]", text) else int(text))


def _refused(node: ast.expr) -> InexpressibleError:
    text = ast.unparse(node)
    text = re.sub(r"deros__\d+__sub", "…", text)
    return InexpressibleError(f"computes what a system cannot: {text[:80]}")
