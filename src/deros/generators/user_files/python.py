"""Reads the classes of the user's Python files from their syntax trees."""

from __future__ import annotations

import ast
import functools
import re
from collections.abc import Iterator, Mapping

from deros.diagnostics import SourceFile, Span
from deros.generators.api.protocol import Files, Owner
from deros.generators.user_files.classes import Base, Name, Written

_MARKS = {
    "abstractmethod": "the node ends with a TypeError at its start",
    "not_filled_in": "the node logs an error whenever it should act",
}
_OF_ROS = frozenset({"ABC", "Node", "LifecycleNode", "ManagedNode", "object"})


def python_classes(
    files: Files, present: Mapping[str, SourceFile]
) -> Iterator[tuple[Base, Written]]:
    """Yield the generated base class and the user's class of each Python file of the user.

    Args:
        files: what a generator returned.
        present: the user's files as they are.
    """
    generated: dict[str, tuple[ast.ClassDef, ast.Module]] = {}
    for path, file in files.items():
        if path.endswith(".py") and file.owner is Owner.GENERATOR:
            tree = ast.parse(file.text)
            generated |= {c.name: (c, tree) for c in tree.body if isinstance(c, ast.ClassDef)}
    for path, source in present.items():
        if not path.endswith(".py"):
            continue
        try:
            tree = ast.parse(source.text)
        except (SyntaxError, ValueError, RecursionError, MemoryError):
            continue  # Python itself says so, and better
        wanted = ast.parse(files[path].text)
        yield _functions(path, wanted, tree, source)
        for stub in wanted.body:
            if isinstance(stub, ast.ClassDef):
                for name in filter(generated.__contains__, map(_name, stub.bases)):
                    written = _written(name, stub.name, tree, source)
                    if written is not None:
                        yield _base(name, generated), written


def _functions(
    path: str, wanted: ast.Module, tree: ast.Module, source: SourceFile
) -> tuple[Base, Written]:
    """Return the functions that a module requires, main() among them, and those it defines."""
    name = path.rpartition("/")[2]
    required = tuple(each.name for each in wanted.body if isinstance(each, ast.FunctionDef))
    known: set[str] = set()
    complete = True
    for node in tree.body:
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)):
            known.add(node.name)
        for each in ast.walk(node):
            if isinstance(each, (ast.Import, ast.ImportFrom)):
                known |= {alias.asname or alias.name for alias in each.names}
                complete = complete and "*" not in known
            elif isinstance(each, ast.Name) and isinstance(each.ctx, ast.Store):
                known.add(each.id)
    base = Base(name, required, frozenset(required), None, "the node does not start", "function")
    place = Name(name, Span(source, 0, 0))
    return base, Written(place, (), frozenset(known), (), (), complete)


def _base(name: str, generated: Mapping[str, tuple[ast.ClassDef, ast.Module]]) -> Base:
    required: list[str] = []
    offered: set[str] = set()
    parameters: frozenset[str] | None = None
    fatal = ""
    waiting = [name]
    while waiting:
        each = waiting.pop()
        if each not in generated:
            continue
        definition, module = generated[each]
        waiting += map(_name, definition.bases)
        offered |= _attributes(definition)
        for method in _methods(definition):
            for mark in filter(_MARKS.__contains__, map(_name, method.decorator_list)):
                required.append(method.name)
                fatal = _MARKS[mark]
        if each == name:
            structs = (c for c in module.body if isinstance(c, ast.ClassDef))
            struct = next((c for c in structs if c.name == "Parameters"), None)
            parameters = frozenset(_attributes(struct)) if struct is not None else None
    return Base(name, tuple(required), frozenset(offered), parameters, fatal)


def _written(base: str, name: str, tree: ast.Module, source: SourceFile) -> Written | None:
    classes = {c.name: c for c in ast.walk(tree) if isinstance(c, ast.ClassDef)}
    own = classes.get(name)
    if own is None or base not in map(_name, own.bases):
        derived = (c for c in classes.values() if base in map(_name, c.bases))
        own = next(derived, None)
    if own is None:
        return None
    known: set[str] = set()
    complete = True
    waiting = [_name(each) for each in own.bases]
    while waiting:
        each = waiting.pop()
        if each in classes:
            definition = classes.pop(each)
            known |= _attributes(definition)
            waiting += map(_name, definition.bases)
        elif each != base and each not in _OF_ROS:
            complete = False
    methods = list(_methods(own))
    declared = {m.name for m in methods}
    known |= _attributes(own) - declared
    used: list[Name] = []
    parameters: list[Name] = []
    for node in ast.walk(own):
        if isinstance(node, ast.Attribute):
            if _name(node.value) == "self" and isinstance(node.value, ast.Name):
                used.append(_place(node, source))
            elif _is_parameters(node.value):
                parameters.append(_place(node, source))
    # What the code calls itself is not waiting for the model to call it.
    attributes = [n.attr for n in ast.walk(tree) if isinstance(n, ast.Attribute)]
    known |= declared.intersection(attributes)
    if any(_sets_attributes(node) for node in ast.walk(tree)):
        complete = False
    actions = base.endswith("ActionsBase")
    public = [m for m in methods if not m.name.startswith("_") and _is_plain(m)]
    return Written(
        Name(own.name, _after("class", own, own.name, source)),
        tuple(Name(m.name, _after("def", m, m.name, source)) for m in public),
        frozenset(known),
        tuple(used),
        tuple(parameters),
        complete,
        actions,
    )


def _methods(definition: ast.ClassDef) -> Iterator[ast.FunctionDef | ast.AsyncFunctionDef]:
    for each in definition.body:
        if isinstance(each, (ast.FunctionDef, ast.AsyncFunctionDef)):
            yield each


def _is_plain(method: ast.FunctionDef | ast.AsyncFunctionDef) -> bool:
    """Return whether a method can be a handler: it is neither a property nor static."""
    return all(_name(each) in ("not_filled_in", "override") for each in method.decorator_list)


def _attributes(definition: ast.ClassDef) -> set[str]:
    """Return the names that a class has: methods, class attributes, and what is set on self."""
    names = {method.name for method in _methods(definition)}
    for node in ast.walk(definition):
        if isinstance(node, (ast.Assign, ast.AnnAssign)):
            for target in node.targets if isinstance(node, ast.Assign) else [node.target]:
                for each in ast.walk(target):
                    if isinstance(each, ast.Name):
                        names.add(each.id)
                    elif isinstance(each, ast.Attribute) and _name(each.value) == "self":
                        names.add(each.attr)
    return names


def _is_parameters(node: ast.expr) -> bool:
    """Return whether an expression is ``self.parameters``."""
    if not isinstance(node, ast.Attribute) or node.attr != "parameters":
        return False
    return isinstance(node.value, ast.Name) and node.value.id == "self"


def _sets_attributes(node: ast.AST) -> bool:
    return isinstance(node, ast.Name) and node.id in ("setattr", "__getattr__", "exec")


def _name(node: ast.expr) -> str:
    """Return the last part of a name: ``NodeBase`` of ``package.NodeBase``."""
    if isinstance(node, ast.Attribute):
        return node.attr
    if isinstance(node, ast.Call):
        return _name(node.func)
    return node.id if isinstance(node, ast.Name) else ""


def _place(node: ast.Attribute, source: SourceFile) -> Name:
    end = _offset(node.end_lineno or node.lineno, node.end_col_offset or 0, source)
    return Name(node.attr, Span(source, max(0, end - len(node.attr)), end))


def _after(keyword: str, node: ast.stmt, name: str, source: SourceFile) -> Span:
    start = _offset(node.lineno, node.col_offset, source)
    found = re.compile(rf"{keyword}\s+({re.escape(name)})").search(source.text, start)
    return Span(source, *found.span(1)) if found else Span(source, start, start)


def _offset(line: int, column: int, source: SourceFile) -> int:
    """Return the offset of a place of ``ast``, which counts columns in bytes."""
    starts = _line_starts(source)
    start = starts[min(line, len(starts)) - 1]
    # Of the line no more than it takes: each character has at least one byte.
    before = source.text[start : start + column].encode(errors="replace")[:column]
    return start + len(before.decode(errors="ignore"))


@functools.lru_cache(maxsize=8)
def _line_starts(source: SourceFile) -> list[int]:
    return [0, *(found.end() for found in re.finditer("\n", source.text))]
