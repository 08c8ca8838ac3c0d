"""Snippets of the monitor in Python: of the same rules as those of the monitor in C.

A snippet shows the methods in which a shape of code appears first. The shapes are those of
statements and expressions, without what comes from the rules and without the parts of each.
"""

from __future__ import annotations

import ast
import copy
import functools
import itertools
import re
from collections.abc import Iterator, Mapping

from deros.generators.monitor.python.interface import EXPLANATION, MONITOR, render_monitor
from deros.rules.functions.function_texts import PYTHON
from tests.support.c_everything import built
from tests.support.c_snippets import SMALLEST, SMALLEST_RULES, SNIPPETS, STOP

_ALIKE = """
comparison connectives timeout unknown failsafe duration times named_rule two_inputs angle vector
scan rate behaviour latched_action reset_by
"""
RULES = {
    "boolean": f"action stop; input v = topic /flag.data entity e {{ r: not v; }} {STOP}",
    **{name: SNIPPETS[name].rules for name in _ALIKE.split()},
    "integer": f"action stop; input v = topic /mode.data entity e {{ r: v = 0 or v >= 3; }} {STOP}",
    "groups": "action stop latched; input v = topic /odom.twist.twist.linear.x timeout 1 sec "
    "input w = topic /imu.orientation timeout 1 sec "
    "entity e { r: v > 1; s: v.rate() > 1 or v.unknown() or w.tilt().unknown() "
    "or v.age() > 1 sec; "
    "failsafe u: (r for 1 sec) and not s; "
    "failsafe y: (u for 1 sec) and not s; } "
    "if e.y then { stop; }; "
    "if e.u or e.s then { stop; }; if not e.r for 1 sec then { stop; };",
    "active": SNIPPETS["active"].rules,
}
"""The rules of each snippet, by its name."""

Node = ast.stmt | ast.expr | ast.arg
_KIND = re.compile(r"^(_?(?:why_not|why|judge|on|forget|take|compute)_)\w+")
_STATE = re.compile(
    r"_(active|base|came|counted|due|heard|known|last|last_t|missing|ran|rises|silent|since)(_\d)?$"
)
_OF_RULES = re.compile(r"_?(?:v|e|data|stop|behaviour)(?:_|$)")


@functools.cache
def texts_of(rules: str) -> dict[str, str]:
    """Return the texts of the monitor of some rules."""
    return render_monitor(built(f'use "robot.system" import Robot\n{rules}', "small"))


def snippets() -> dict[str, str]:
    """Return the smallest monitor, and what each construct adds to the snippets before it."""
    smallest = texts_of(SMALLEST_RULES)
    made = {SMALLEST: smallest[MONITOR], f"{SMALLEST}_explanation": smallest[EXPLANATION]}
    seen = shapes(smallest)
    for name, rules in RULES.items():
        parts = [f"# {rules}"]
        for text, block in _blocks(texts_of(rules)):
            new = [node for node in _nodes(block) if _shape(block, node) not in seen]
            parts += ["\n".join(_shown(text.splitlines(), block, new))] if new else []
            seen |= {_shape(block, node) for node in new}
        made[name] = "\n\n".join(parts) + "\n"
    return made


def shapes(texts: Mapping[str, str]) -> set[tuple[str, str]]:
    """Return the shapes of the code of a monitor, each with the kind of method that has it."""
    return {_shape(block, node) for _, block in _blocks(texts) for node in _nodes(block)}


def _blocks(texts: Mapping[str, str]) -> Iterator[tuple[str, ast.stmt]]:
    """Yield what stands before the class of each module, and its methods, with its text.

    Functions that the monitor has as they are written in the table of functions are left out.
    """
    for text in texts.values():
        *others, monitor = ast.parse(text).body
        assert isinstance(monitor, ast.ClassDef)
        for block in (*others, *monitor.body):
            if ast.dump(block) not in _written():
                yield text, block


@functools.cache
def _written() -> frozenset[str]:
    """Return the functions of the table that are written as Python."""
    return frozenset(ast.dump(each) for text in PYTHON.values() for each in ast.parse(text).body)


def _nodes(block: ast.stmt) -> list[Node]:
    return [each for each in ast.walk(block) if isinstance(each, ast.stmt | ast.expr | ast.arg)]


def _shown(lines: list[str], block: ast.stmt, new: list[Node]) -> Iterator[str]:
    """Yield the first line of a block and the statements with new shapes; others are counted.

    A compound statement is shown whole if what stands above its body is new.
    """
    begins = [each.lineno for each in (block, *getattr(block, "decorator_list", ()))]
    changed = {each.lineno for each in new}
    chosen = {block.lineno, *changed.intersection(begins)}
    for statement in (each for each in ast.walk(block) if isinstance(each, ast.stmt)):
        ends = (statement.end_lineno or 0) + 1
        if body := getattr(statement, "body", None):
            head = range(statement.lineno, max(body[0].lineno, statement.lineno + 1))
        else:
            head = range(statement.lineno, ends)
        if changed.intersection(head):
            chosen.update(head if statement is block else range(statement.lineno, ends))
    numbers = range(min(begins), (block.end_lineno or 0) + 1)
    for is_shown, run in itertools.groupby(numbers, lambda each: each in chosen):
        hidden = [*run]
        alone = is_shown or len(hidden) == 1
        yield from (lines[n - 1] for n in hidden) if alone else [f"    # {len(hidden)} lines"]


def _shape(block: ast.stmt, node: Node) -> tuple[str, str]:
    return _KIND.sub(r"\1", getattr(block, "name", "")), ast.unparse(_shallow(node))


def _shallow(node: ast.AST) -> ast.AST:
    """Return a statement or an expression with ``x`` in place of each part that has parts."""
    shape = copy.copy(node)
    for name, value in ast.iter_fields(node):
        if isinstance(value, list):
            parts = {ast.dump(part): part for part in (_part(each, node) for each in value)}
            setattr(shape, name, [*parts.values()])
        elif isinstance(value, ast.AST):
            setattr(shape, name, _part(value, node))
        elif name in ("arg", "name") and isinstance(value, str):
            setattr(shape, name, _word(value))
    return _leaf(shape)


def _part(part: ast.AST, whole: ast.AST) -> ast.AST:
    if isinstance(part, ast.stmt):
        return ast.Pass()
    if isinstance(part, ast.expr):
        leaf = _leaf(part)
        is_alike = isinstance(whole, ast.BoolOp | ast.Tuple | ast.Dict)
        is_leaf = isinstance(leaf, ast.Name | ast.Constant) and not is_alike
        return leaf if is_leaf else ast.Name("x")
    return _shallow(part) if isinstance(part, ast.arguments | ast.arg | ast.keyword) else part


def _leaf(node: ast.AST) -> ast.AST:
    """Return what takes the place of a name or of a literal; anything else as it is."""
    if isinstance(node, ast.JoinedStr):
        return ast.Constant("")
    if isinstance(node, ast.UnaryOp) and isinstance(node.operand, ast.Constant):
        return _leaf(node.operand)
    if isinstance(node, ast.Constant):
        kept = node.value is None or isinstance(node.value, bool)
        return node if kept else ast.Constant("" if isinstance(node.value, str) else 0)
    if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
        is_own = node.value.id == "self"
        return ast.Name(f"self.{_word(node.attr)}" if is_own else ast.unparse(node))
    return ast.Name(_word(node.id)) if isinstance(node, ast.Name) else node


def _word(name: str) -> str:
    if _KIND.search(name):
        return _KIND.sub(r"\1", name)
    if state := _STATE.search(name):
        return f"x_{state[1]}"
    return name if name in _words() else "x"


@functools.cache
def _words() -> set[str]:
    """Return the names that are in every monitor, and those of functions."""
    trees = map(ast.parse, texts_of(SMALLEST_RULES).values())
    return {
        name
        for tree in trees
        for each in ast.walk(tree)
        for name in (getattr(each, key, "") for key in ("id", "attr", "arg", "name"))
        if isinstance(name, str) and not _OF_RULES.match(name)
    }
