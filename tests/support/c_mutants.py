"""Every single slip of some kinds in an emitted C monitor, each as a text of its own.

The source is parsed (tree-sitter), so that a slip is made in code and never in a comment: contracts
and loop annotations stay as they are.
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterator
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
class _Change:
    kind: str
    node: Node
    text: str


def mutants(source: str, header: str) -> Iterator[Mutant]:
    """Yield every slip in the code of a monitor, in the order of the text.

    Args:
        source: the text of ``robot_monitor.c``.
        header: the text of ``robot_monitor.h``, which names fields and enumerators.
    """
    data = source.encode()
    root = _PARSER.parse(data).root_node
    writer = _Writer(_PARSER.parse(header.encode()).root_node)
    known = {data}
    for function, top in _code(root):
        for change in sorted(writer.changes(top), key=lambda each: each.node.start_byte):
            start, end = change.node.start_byte, change.node.end_byte
            text = data[:start] + change.text.encode() + data[end:]
            if text not in known:
                known.add(text)
                before, after = _told(data, change)
                line = change.node.start_point[0] + 1
                yield Mutant(change.kind, function, before, after, line, text.decode())


def _code(root: Node) -> Iterator[tuple[str, Node]]:
    for node in root.named_children:
        if node.type == "function_definition":
            yield _name_of(node), node
        elif node.type == "declaration" and _all(node, "initializer_list"):
            yield TABLES, node


def _told(data: bytes, change: _Change) -> tuple[str, str]:
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
            names = [_text(e.named_children[0]) for e in each.named_children if e.named_children]
            self._enumerations.update(dict.fromkeys(names, names))

    def changes(self, top: Node) -> Iterator[_Change]:
        """Yield all changes within a function or table."""
        names = _names(top) if top.type == "function_definition" else {}
        body = top.child_by_field_name("body") or top
        for node in _walk(body):
            yield from self._statements(node)
            yield from self._operators(node)
            yield from self._constants(node)
            yield from self._conditions(node)
            yield from self._swaps(node)
            yield from self._exchanges(node, names)

    def _statements(self, node: Node) -> Iterator[_Change]:
        if node.type in _STATEMENTS and not _is_void_of_name(node):
            yield _Change("emission" if _emits(node) else "statement", node, ";")
        if node.type == "init_declarator":
            value = node.child_by_field_name("value")
            if value is not None and value.type == "call_expression" and not _is_literal(value):
                yield _Change("statement", value, "0")
        if node.type == "return_statement" and node.named_children:
            value = node.named_children[0]
            if value.type == "call_expression":
                yield _Change("statement", value, "0")

    def _operators(self, node: Node) -> Iterator[_Change]:
        if node.type == "unary_expression" and _text(node.children[0]) == "-":
            yield _Change("operator", node.children[0], "")
        if node.type != "binary_expression":
            return
        operator = node.child_by_field_name("operator")
        assert operator is not None
        for text in _COMPARISONS.get(_text(operator), ()):
            yield _Change("comparison", operator, text)
        if _text(operator) in _OPERATORS:
            yield _Change("operator", operator, _OPERATORS[_text(operator)])

    def _constants(self, node: Node) -> Iterator[_Change]:
        kind = "emission" if _is_emitted(node) else "constant"
        text = _text(node)
        if node.type == "number_literal":
            match = _NUMBER.fullmatch(text)
            values = [int(match["digits"]) + by for by in (1, -1)] if match else []
            if match is None and re.fullmatch(r"-?\d+\.\d+(e-?\d+)?", text):
                for by in (1.0, -1.0):
                    yield _Change(kind, node, repr(float(text) + by))
                if text.startswith("-"):
                    yield _Change("operator", node, text[1:])
            for value in values:
                assert match is not None
                yield _Change(kind, node, f"{value}{match['suffix'] if value >= 0 else ''}")
        elif node.type in ("true", "false"):
            yield _Change(kind, node, "false" if text == "true" else "true")
        elif node.type == "identifier" and text in self._enumerations:
            for other in _others(self._enumerations[text], text):
                yield _Change(kind, node, other)
        elif node.type == "identifier" and _is_macro(node):
            yield _Change(kind, node, f"({text} + 1)")
            yield _Change(kind, node, f"({text} - 1)")

    def _conditions(self, node: Node) -> Iterator[_Change]:
        if (
            node.type in ("if_statement", "while_statement", "for_statement")
            or node.type == "conditional_expression"
        ):
            yield from self._negated(node.child_by_field_name("condition"))
        elif node.type == "unary_expression" and _text(node.children[0]) == "!":
            yield _Change("condition", node.children[0], "")
        elif node.type == "binary_expression":
            operator = node.child_by_field_name("operator")
            if operator is not None and _text(operator) in ("&&", "||"):
                for side in ("left", "right"):
                    yield from self._negated(node.child_by_field_name(side))

    def _negated(self, condition: Node | None) -> Iterator[_Change]:
        """Yield the negation of a condition, but where a change of its operator is the same."""
        if condition is None:
            return
        inner = condition
        while inner.type == "parenthesized_expression":
            inner = inner.named_children[0]
        operator = inner.child_by_field_name("operator")
        if operator is not None and _text(operator) in ("==", "!=", "!"):
            return
        if condition.type == "parenthesized_expression":
            yield _Change("condition", condition, f"(!{_text(condition)})")
        else:
            yield _Change("condition", condition, f"!({_text(condition)})")

    def _swaps(self, node: Node) -> Iterator[_Change]:
        if node.type == "argument_list":
            arguments = node.named_children
            for i, j in itertools.combinations(range(len(arguments)), 2):
                yield self._swapped(node, arguments[i], arguments[j])
        elif node.type == "binary_expression":
            operator = _text(node.child_by_field_name("operator"))
            left, right = node.child_by_field_name("left"), node.child_by_field_name("right")
            assert left is not None
            assert right is not None
            calls = any(True for _ in _all(node, "call_expression"))
            if operator in _ORDERED or (operator in ("&&", "||") and calls):
                yield self._swapped(node, left, right)

    def _swapped(self, node: Node, first: Node, second: Node) -> _Change:
        data, start = node.text or b"", node.start_byte
        parts = (
            data[: first.start_byte - start],
            second.text or b"",
            data[first.end_byte - start : second.start_byte - start],
            first.text or b"",
            data[second.end_byte - start :],
        )
        kind = "emission" if _is_emitted(first) else "swap"
        return _Change(kind, node, b"".join(parts).decode())

    def _exchanges(self, node: Node, names: dict[str, str]) -> Iterator[_Change]:
        kind = "emission" if _is_emitted(node) else ""
        text = _text(node)
        if node.type == "field_identifier":
            alike = self._by_type.get(self._fields.get(text, ""), [])
            if text in alike:
                yield _Change(kind or "field", node, _next(alike, text))
        elif node.type == "identifier" and text in names:
            if _is_defined(node):
                return
            for other, type_ in names.items():
                if type_ == names[text]:
                    yield _Change(kind or "name", node, other)


def _next(names: list[str], name: str) -> str:
    """Return the name after one; the first after the last."""
    return names[(names.index(name) + 1) % len(names)]


def _others(names: list[str], name: str) -> list[str]:
    """Return what an enumerator is exchanged for: of few all others, of many the next."""
    return names if len(names) <= _FEW else [_next(names, name)]


def _walk(node: Node) -> Iterator[Node]:
    yield node
    for each in node.named_children:
        yield from _walk(each)


def _all(node: Node, type_: str) -> list[Node]:
    return [each for each in _walk(node) if each.type == type_]


def _text(node: Node | None) -> str:
    return (node.text or b"").decode() if node is not None else ""


def _name_of(function: Node) -> str:
    (declarator,) = _all(function, "function_declarator")[:1]
    return _text(declarator.child_by_field_name("declarator"))


def _declared(node: Node) -> tuple[str, str]:
    """Return the name and the type that a declaration of one name gives."""
    declarator = node.child_by_field_name("declarator")
    stars = ""
    while declarator is not None and declarator.child_by_field_name("declarator") is not None:
        stars += "*" if declarator.type == "pointer_declarator" else ""
        declarator = declarator.child_by_field_name("declarator")
    return _text(declarator), _text(node.child_by_field_name("type")) + stars


def _names(function: Node) -> dict[str, str]:
    """Return the types of a function's parameters and local variables."""
    nodes = [*_all(function, "parameter_declaration"), *_all(function, "declaration")]
    return dict(_declared(each) for each in nodes)


def _is_void_of_name(node: Node) -> bool:
    """Tell whether a statement says no more than that a parameter is not used."""
    return bool(re.fullmatch(r"\(void\)\w+;", _text(node)))


def _is_defined(node: Node) -> bool:
    """Tell whether an identifier is the name that its declaration gives."""
    above = node.parent
    if above is None or above.type != "init_declarator":
        return False
    return above.child_by_field_name("declarator") == node


def _is_macro(node: Node) -> bool:
    called = node.parent is not None and node.parent.type == "call_expression"
    return not called and bool(re.fullmatch(r"[A-Z][A-Z0-9_]*_[A-Z0-9_]+", _text(node)))


def _is_literal(call: Node) -> bool:
    return bool(re.fullmatch(r"U?INT\d+_C\(.*\)", _text(call)))


def _emits(statement: Node) -> bool:
    return bool(re.match(r"\w+_emit\(", _text(statement)))


def _is_emitted(node: Node) -> bool:
    """Tell whether a node is within the arguments of an emission."""
    above: Node | None = node
    while above is not None and above.type not in _SIMPLE:
        if above.type == "call_expression" and _emits(above):
            return True
        above = above.parent
    return False
