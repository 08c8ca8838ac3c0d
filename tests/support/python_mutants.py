"""Slips planted in Python code: one structural change at every place that a slip describes.

The code is parsed (``ast``), so that nothing in a comment or a documentation string is changed;
what is changed is replaced in place, so that all else stays as it was written.
"""

from __future__ import annotations

import ast
import itertools
from collections.abc import Iterator, Sequence
from typing import Any

from tests.support.slips import Edit, Slip, edited

_EXCHANGED: dict[str, dict[type[ast.AST], tuple[str, str]]] = {
    "comparison": {
        ast.Lt: ("<", "<="),
        ast.LtE: ("<=", "<"),
        ast.Gt: (">", ">="),
        ast.GtE: (">=", ">"),
        ast.Eq: ("==", "!="),
        ast.NotEq: ("!=", "=="),
        ast.Is: ("is", "is not"),
        ast.IsNot: ("is not", "is"),
        ast.In: ("in", "not in"),
        ast.NotIn: ("not in", "in"),
    },
    "operator": {
        ast.And: ("and", "or"),
        ast.Or: ("or", "and"),
        ast.Add: ("+", "-"),
        ast.Sub: ("-", "+"),
        ast.Mult: ("*", "/"),
        ast.Div: ("/", "*"),
    },
}
"""How each operator is written, and what it is exchanged for."""


def planted(text: str, slips: Sequence[Slip]) -> str | None:
    """Return code with slips made together, or ``None`` if one of them has no place in it."""
    source = _Source(text)
    edits: list[Edit] = []
    for slip in slips:
        made = list(source.edits(slip))
        if not made:
            return None
        edits += made
    return edited(source.data, edits).decode()


class _Source:
    """Parsed code: its functions and methods, and the place of each node in its bytes."""

    def __init__(self, text: str) -> None:
        self.data = text.encode()
        self._lines = [0, *itertools.accumulate(map(len, self.data.splitlines(keepends=True)))]
        top = ast.parse(text).body
        inner = [each for node in top if isinstance(node, ast.ClassDef) for each in node.body]
        self._functions = [each for each in [*top, *inner] if isinstance(each, ast.FunctionDef)]

    def edits(self, slip: Slip) -> Iterator[Edit]:
        """Yield the changes that a slip stands for."""
        for function in self._functions:
            if slip.is_in(function.name):
                for node, above in _walk(function, ()):
                    changes = list(self._changes(node, above[-1], slip))
                    if changes and self._is_at(slip, node, above):
                        yield from changes

    def _is_at(self, slip: Slip, node: ast.AST, above: Sequence[ast.AST]) -> bool:
        start, end = self._place(node)
        places = (self._place(each) for each in reversed(above))
        around = ((self._code(first, start), self._code(end, last)) for first, last in places)
        return slip.is_at(self._code(start, end), around)

    def _changes(self, node: ast.AST, above: ast.AST, slip: Slip) -> Iterator[Edit]:
        start, end = self._place(node)
        match slip.kind, node:
            case "statement", ast.Expr() | ast.Assign() | ast.AugAssign():
                yield Edit(start, end, "pass")
            case ("comparison", ast.Compare()) | ("operator", ast.BoolOp() | ast.BinOp()):
                yield from self._operators(slip, node)
            case "constant", ast.Constant(value=bool() as truth):
                yield Edit(start, end, str(not truth))
            case "value", ast.expr() if not isinstance(getattr(node, "ctx", None), ast.Store):
                yield Edit(start, end, slip.to)
            case "target", ast.expr() if isinstance(above, ast.Assign) and node in above.targets:
                following = [*above.targets, above.value][above.targets.index(node) + 1]
                yield Edit(start, self._place(following)[0], "")
            case "once", ast.Assign(targets=[ast.Attribute() as attribute]):
                value = ast.unparse(node.value)
                again = f"getattr(self, {attribute.attr!r}, {value})"
                yield Edit(*self._place(node.value), again)

    def _operators(self, slip: Slip, node: ast.AST) -> Iterator[Edit]:
        """Yield a change of each operator; they stand in the gaps between the operands."""
        operators: Sequence[ast.AST] = []
        operands: Sequence[ast.expr] = []
        match node:
            case ast.Compare():
                operators, operands = node.ops, [node.left, *node.comparators]
            case ast.BoolOp():
                operators, operands = [node.op] * (len(node.values) - 1), node.values
            case ast.BinOp():
                operators, operands = [node.op], [node.left, node.right]
        gaps = itertools.pairwise(operands)
        for operator, (left, right) in zip(operators, gaps, strict=True):
            written, other = _EXCHANGED[slip.kind].get(type(operator), ("", ""))
            if written and slip.chooses(other):
                first, last = self._place(left)[1], self._place(right)[0]
                start = self.data.index(written.encode(), first, last)
                yield Edit(start, start + len(written), other)

    def _place(self, node: Any) -> tuple[int, int]:
        """Return the first byte of a node, and that after its last."""
        start: int = self._lines[node.lineno - 1] + node.col_offset
        return start, self._lines[node.end_lineno - 1] + node.end_col_offset

    def _code(self, start: int, end: int) -> str:
        return self.data[start:end].decode()


def _walk(
    node: ast.AST, above: tuple[ast.AST, ...]
) -> Iterator[tuple[ast.AST, tuple[ast.AST, ...]]]:
    """Yield each node within a function with those around it that have a place, innermost last."""
    around = (*above, node) if hasattr(node, "lineno") else above  # a comprehension has none
    for each in ast.iter_child_nodes(node):
        if hasattr(each, "lineno"):
            yield each, around
        yield from _walk(each, around)
