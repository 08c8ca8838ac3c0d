"""Every single slip of some kinds in an emitted C monitor, each as a text of its own.

The source is parsed (tree-sitter), so that a slip is made in code and never in a comment: contracts
and loop annotations stay as they are.
"""

from __future__ import annotations

import functools
import itertools
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import tree_sitter_c
from tree_sitter import Language, Node, Parser

_PARSER = Parser(Language(tree_sitter_c.language()))

KINDS = {
    "statement": "a statement removed, or a call whose result is kept",
    "comparison": "a comparison changed",
    "constant": "a constant changed by one, or exchanged for another of its enumeration",
    "operator": "an arithmetic or logical operator changed, or a sign removed",
    "swap": "two arguments, or two operands whose order counts, swapped",
    "condition": "a condition, or a part of it, negated",
    "field": "a field exchanged for the next one of its type",
    "name": "a parameter or local variable exchanged for another one of its type",
    "emission": "another site, kind, time or owner emitted",
}
"""The kinds of slips, and what each is."""

TABLES = "tables"
"""What stands for the function of a slip that is in a constant table."""

_COMPARISONS = {
    "<": ("<=", ">"),
    "<=": ("<", ">="),
    ">": (">=", "<"),
    ">=": (">", "<="),
    "==": ("!=",),
    "!=": ("==",),
}
_OPERATORS = {"&&": "||", "||": "&&", "+": "-", "-": "+", "*": "/", "/": "*"}
_ORDERED = ("-", "/", "%")
_STATEMENTS = ("expression_statement", "if_statement", "while_statement", "for_statement")
_SIMPLE = ("expression_statement", "declaration", "return_statement", "parenthesized_expression")
_FEW = 4
_NUMBER = re.compile(r"(?P<digits>-?\d+)(?P<suffix>[uUlL]*)")


@dataclass(frozen=True)
class Mutant:
    """One slip.

    Attributes:
        kind: a key of :data:`KINDS`.
        function: the function that it is in, or :data:`TABLES`.
        before, after: the statement, or what else is the least to be read, without and with it.
        line: where it is.
        source: the whole text with the slip.
    """

    kind: str
    function: str
    before: str
    after: str
    line: int
    source: str

    @property
    def name(self) -> str:
        """What it is listed by: function and change, whatever the line is."""
        return f"{self.function}: {self.before} -> {self.after}"


@dataclass(frozen=True)
class Change:
    """A node of the code, and the text in its place."""

    kind: str
    node: Node
    text: str


class Source:
    """A parsed monitor, and the changes that can be made in it."""

    def __init__(self, text: str, header: str) -> None:
        """Parse the texts of ``robot_monitor.c`` and of its header."""
        self.data = text.encode()
        self._root = _PARSER.parse(self.data).root_node
        self._writer = _Writer(_PARSER.parse(header.encode()).root_node)

    def code(self) -> Iterator[tuple[str, Node]]:
        """Yield each function and each table with its name, of a table :data:`TABLES`."""
        for node in self._root.named_children:
            if node.type == "function_definition":
                yield _name_of(node), node
            elif node.type == "declaration" and _all(node, "initializer_list"):
                yield TABLES, node

    def changes(self, top: Node, kind: str = "") -> list[Change]:
        """Return every change of a function or table, or those of a kind, in order of the text."""
        made = self._writer.changes(top, kind)
        return sorted(made, key=lambda each: each.node.start_byte)


def mutants(source: str, header: str) -> Iterator[Mutant]:
    """Yield every slip in the code of a monitor, in the order of the text.

    Args:
        source: the text of ``robot_monitor.c``.
        header: the text of ``robot_monitor.h``, which names fields and enumerators.
    """
    parsed = Source(source, header)
    data = parsed.data
    known = {data}
    for function, top in parsed.code():
        for change in parsed.changes(top):
            start, end = change.node.start_byte, change.node.end_byte
            text = data[:start] + change.text.encode() + data[end:]
            if text not in known:
                known.add(text)
                before, after = _told(data, change)
                line = change.node.start_point[0] + 1
                yield Mutant(change.kind, function, before, after, line, text.decode())


def _told(data: bytes, change: Change) -> tuple[str, str]:
    """Return the statement around a change as it was, and as it is, in one line each."""
    around = change.node
    while around.parent is not None and around.type not in _SIMPLE:
        if around.type in ("initializer_list", "if_statement", "while_statement"):
            break
        if around.parent.type == "for_statement":
            break
        around = around.parent
    if change.node.type in _STATEMENTS:
        around = change.node
    while (
        around.type == "parenthesized_expression"
        and around.parent is not None
        and around.parent.type not in ("if_statement", "while_statement", "for_statement")
    ):
        around = around.parent
        while around.parent is not None and around.type not in _SIMPLE:
            around = around.parent
    start, end = around.start_byte, around.end_byte
    changed = data[start : change.node.start_byte] + change.text.encode()
    changed += data[change.node.end_byte : end]
    return _line(data[start:end]), _line(changed)


def _line(text: bytes) -> str:
    return re.sub(r"\s+", " ", re.sub(r"/\*.*?\*/", "", text.decode(), flags=re.DOTALL)).strip()


class _Writer:
    """Yields the changes of a function or a table."""

    def __init__(self, header: Node) -> None:
        self._fields: dict[str, str] = {}
        self._by_type: dict[str, list[str]] = {}
        self._enumerations: dict[str, list[str]] = {}
        for struct in _all(header, "struct_specifier"):
            by_type: dict[str, list[str]] = {}
            for each in _all(struct, "field_declaration"):
                name, type_ = _declared(each)
                by_type.setdefault(type_, []).append(name)
                self._fields[name] = type_
            self._by_type = by_type  # the last one is the monitor
        for each in _all(header, "enumerator_list"):
            names = [code_of(e.named_children[0]) for e in each.named_children if e.named_children]
            self._enumerations.update(dict.fromkeys(names, names))

    def changes(self, top: Node, kind: str) -> Iterator[Change]:
        """Yield all changes within a function or table, or those of a kind."""
        names = _names(top) if top.type == "function_definition" else {}
        ways: tuple[tuple[tuple[str, ...], Callable[[Node], Iterator[Change]]], ...] = (
            (("statement",), self._statements),
            (("comparison", "operator"), self._operators),
            (("constant", "operator"), self._constants),
            (("condition",), self._conditions),
            (("swap",), self._swaps),
            (("field", "name"), functools.partial(self._exchanges, names)),
        )
        chosen = [way for kinds, way in ways if kind in ("", "emission", *kinds)]
        for node in walk(top.child_by_field_name("body") or top):
            for way in chosen:
                yield from (each for each in way(node) if kind in ("", each.kind))

    def _statements(self, node: Node) -> Iterator[Change]:
        if node.type in _STATEMENTS and not _is_void_of_name(node):
            yield Change("emission" if _emits(node) else "statement", node, ";")
        if node.type == "init_declarator":
            value = node.child_by_field_name("value")
            if value is not None and value.type == "call_expression" and not _is_literal(value):
                yield Change("statement", value, "0")
        if node.type == "return_statement" and node.named_children:
            value = node.named_children[0]
            if value.type == "call_expression":
                yield Change("statement", value, "0")

    def _operators(self, node: Node) -> Iterator[Change]:
        if node.type == "unary_expression" and code_of(node.children[0]) == "-":
            yield Change("operator", node.children[0], "")
        if node.type != "binary_expression":
            return
        operator = node.child_by_field_name("operator")
        assert operator is not None
        for text in _COMPARISONS.get(code_of(operator), ()):
            yield Change("comparison", operator, text)
        if code_of(operator) in _OPERATORS:
            yield Change("operator", operator, _OPERATORS[code_of(operator)])

    def _constants(self, node: Node) -> Iterator[Change]:
        kind = "emission" if _is_emitted(node) else "constant"
        text = code_of(node)
        if node.type == "number_literal":
            match = _NUMBER.fullmatch(text)
            values = [int(match["digits"]) + by for by in (1, -1)] if match else []
            if match is None and re.fullmatch(r"-?\d+\.\d+(e-?\d+)?", text):
                for by in (1.0, -1.0):
                    yield Change(kind, node, repr(float(text) + by))
                if text.startswith("-"):
                    yield Change("operator", node, text[1:])
            for value in values:
                assert match is not None
                yield Change(kind, node, f"{value}{match['suffix'] if value >= 0 else ''}")
        elif node.type in ("true", "false"):
            yield Change(kind, node, "false" if text == "true" else "true")
        elif node.type == "identifier" and text in self._enumerations:
            for other in _others(self._enumerations[text], text):
                yield Change(kind, node, other)
        elif node.type == "identifier" and _is_macro(node):
            yield Change(kind, node, f"({text} + 1)")
            yield Change(kind, node, f"({text} - 1)")

    def _conditions(self, node: Node) -> Iterator[Change]:
        if (
            node.type in ("if_statement", "while_statement", "for_statement")
            or node.type == "conditional_expression"
        ):
            yield from self._negated(node.child_by_field_name("condition"))
        elif node.type == "unary_expression" and code_of(node.children[0]) == "!":
            yield Change("condition", node.children[0], "")
        elif node.type == "binary_expression":
            operator = node.child_by_field_name("operator")
            if operator is not None and code_of(operator) in ("&&", "||"):
                for side in ("left", "right"):
                    yield from self._negated(node.child_by_field_name(side))

    def _negated(self, condition: Node | None) -> Iterator[Change]:
        """Yield the negation of a condition, but where a change of its operator is the same."""
        if condition is None:
            return
        inner = condition
        while inner.type == "parenthesized_expression":
            inner = inner.named_children[0]
        operator = inner.child_by_field_name("operator")
        if operator is not None and code_of(operator) in ("==", "!=", "!"):
            return
        if condition.type == "parenthesized_expression":
            yield Change("condition", condition, f"(!{code_of(condition)})")
        else:
            yield Change("condition", condition, f"!({code_of(condition)})")

    def _swaps(self, node: Node) -> Iterator[Change]:
        if node.type == "argument_list":
            arguments = node.named_children
            for i, j in itertools.combinations(range(len(arguments)), 2):
                yield self._swapped(node, arguments[i], arguments[j])
        elif node.type == "binary_expression":
            operator = code_of(node.child_by_field_name("operator"))
            left, right = node.child_by_field_name("left"), node.child_by_field_name("right")
            assert left is not None
            assert right is not None
            calls = any(True for _ in _all(node, "call_expression"))
            if operator in _ORDERED or (operator in ("&&", "||") and calls):
                yield self._swapped(node, left, right)

    def _swapped(self, node: Node, first: Node, second: Node) -> Change:
        data, start = node.text or b"", node.start_byte
        parts = (
            data[: first.start_byte - start],
            second.text or b"",
            data[first.end_byte - start : second.start_byte - start],
            first.text or b"",
            data[second.end_byte - start :],
        )
        kind = "emission" if _is_emitted(first) else "swap"
        return Change(kind, node, b"".join(parts).decode())

    def _exchanges(self, names: dict[str, str], node: Node) -> Iterator[Change]:
        kind = "emission" if _is_emitted(node) else ""
        text = code_of(node)
        if node.type == "field_identifier":
            alike = self._by_type.get(self._fields.get(text, ""), [])
            if text in alike:
                yield Change(kind or "field", node, _next(alike, text))
        elif node.type == "identifier" and text in names:
            if _is_defined(node):
                return
            for other, type_ in names.items():
                if type_ == names[text]:
                    yield Change(kind or "name", node, other)


def _next(names: list[str], name: str) -> str:
    """Return the name after one; the first after the last."""
    return names[(names.index(name) + 1) % len(names)]


def _others(names: list[str], name: str) -> list[str]:
    """Return what an enumerator is exchanged for: of few all others, of many the next."""
    return names if len(names) <= _FEW else [_next(names, name)]


def walk(node: Node) -> Iterator[Node]:
    """Yield a node and all within it, in the order of the text."""
    todo = [node]
    while todo:
        yield (each := todo.pop())
        todo += reversed(each.named_children)


def _all(node: Node, type_: str) -> list[Node]:
    return [each for each in walk(node) if each.type == type_]


def code_of(node: Node | None) -> str:
    """Return the code of a node; of none, nothing."""
    return (node.text or b"").decode() if node is not None else ""


def _name_of(function: Node) -> str:
    return next(code_of(each) for each in walk(function) if each.type == "identifier")


def _declared(node: Node) -> tuple[str, str]:
    """Return the name and the type that a declaration of one name gives."""
    declarator = node.child_by_field_name("declarator")
    stars = ""
    while declarator is not None and declarator.child_by_field_name("declarator") is not None:
        stars += "*" if declarator.type == "pointer_declarator" else ""
        declarator = declarator.child_by_field_name("declarator")
    return code_of(declarator), code_of(node.child_by_field_name("type")) + stars


def _names(function: Node) -> dict[str, str]:
    """Return the types of a function's parameters and local variables."""
    nodes = [*_all(function, "parameter_declaration"), *_all(function, "declaration")]
    return dict(_declared(each) for each in nodes)


def _is_void_of_name(node: Node) -> bool:
    """Tell whether a statement says no more than that a parameter is not used."""
    return bool(re.fullmatch(r"\(void\)\w+;", code_of(node)))


def _is_defined(node: Node) -> bool:
    """Tell whether an identifier is the name that its declaration gives."""
    above = node.parent
    if above is None or above.type != "init_declarator":
        return False
    return above.child_by_field_name("declarator") == node


def _is_macro(node: Node) -> bool:
    called = node.parent is not None and node.parent.type == "call_expression"
    return not called and bool(re.fullmatch(r"[A-Z][A-Z0-9_]*_[A-Z0-9_]+", code_of(node)))


def _is_literal(call: Node) -> bool:
    return bool(re.fullmatch(r"U?INT\d+_C\(.*\)", code_of(call)))


def _emits(statement: Node) -> bool:
    return bool(re.match(r"\w+_emit\(", code_of(statement)))


def _is_emitted(node: Node) -> bool:
    """Tell whether a node is within the arguments of an emission."""
    above: Node | None = node
    while above is not None and above.type not in _SIMPLE:
        if above.type == "call_expression" and _emits(above):
            return True
        above = above.parent
    return False
