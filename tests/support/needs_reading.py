"""Which programs a test runs, found by reading its code and the code that this calls.

A program counts as run where its name stands first in a list or tuple, the form of a command, or is
passed to ``shutil.which``, as a text or by a constant of the module. What a function refers to is
followed as far as it is code of this repository outside ``src``.
"""

from __future__ import annotations

import ast
import functools
import inspect
from collections.abc import Iterable, Iterator
from pathlib import Path
from types import FunctionType, ModuleType
from typing import Any

import pytest

_PACKAGES = ("tests.", "tools.", "benchmarks.")


class Reader:
    """Reads tests, each piece of code once."""

    def __init__(self, programs: Iterable[str]) -> None:
        """Look for the programs of some names."""
        self._programs = frozenset(programs)
        self._direct: dict[Any, tuple[frozenset[str], tuple[Any, ...]]] = {}
        self._of_tests: dict[tuple[Any, ...], frozenset[str]] = {}

    def programs(self, item: pytest.Function) -> frozenset[str]:
        """Return the programs that a test runs, as far as its code shows."""
        definitions = item._fixtureinfo.name2fixturedefs.values()
        code = (item.function, *(each.func for every in definitions for each in every))
        ours = (*_PACKAGES, item.function.__module__)
        if code not in self._of_tests:  # the same for all values of its parameters
            self._of_tests[code] = self._behind(code, ours)
        values = [*item.callspec.params.values()] if hasattr(item, "callspec") else []
        named = {text for value in values for text in _heads(value)}
        return self._of_tests[code] | (self._programs & named) | self._behind(values, ours)

    def _behind(self, places: Iterable[Any], ours: tuple[str, ...]) -> frozenset[str]:
        """Return the programs that code and values name, and all code that these refer to."""
        todo, found = [*places], set[str]()
        seen: set[int] = set()
        while todo:
            place = todo.pop()
            if id(place) not in seen:
                seen.add(id(place))
                direct, further = self._read(place, ours)
                found |= direct
                todo += further
        return frozenset(found)

    def _read(self, place: Any, ours: tuple[str, ...]) -> tuple[frozenset[str], tuple[Any, ...]]:
        """Return the programs that a piece of code names, and the code that it refers to."""
        if isinstance(place, (list, tuple)):
            return frozenset(), tuple(place)
        code = _function(place)
        if code is not None and code.__module__.startswith(ours):
            if code not in self._direct:
                self._direct[code] = self._read_function(code)
            return self._direct[code]
        if isinstance(place, type) and place.__module__.startswith(ours):
            return frozenset(), (*place.__bases__, *vars(place).values())
        return frozenset(), ()

    def _read_function(self, function: FunctionType) -> tuple[frozenset[str], tuple[Any, ...]]:
        node = _definition(function)
        if node is None:
            return frozenset(), ()
        names = function.__globals__
        found: set[str] = set()
        further: list[Any] = []
        for each in _parts(node):
            if isinstance(each, (ast.List, ast.Tuple)) and each.elts:
                found.update(_texts(each.elts[0], names))
            elif isinstance(each, ast.Call) and _name(each.func).endswith("which"):
                found.update(text for one in each.args[:1] for text in _texts(one, names))
            elif isinstance(each, ast.Name) and each.id in names:
                further.append(names[each.id])
            elif isinstance(each, ast.Attribute) and isinstance(each.value, ast.Name):
                owner = names.get(each.value.id)
                if isinstance(owner, ModuleType) and owner.__name__.startswith(_PACKAGES):
                    further.append(getattr(owner, each.attr, None))
        return self._programs & found, tuple(further)


def _function(place: Any) -> FunctionType | None:
    """Return the Python function behind a method, a property, a wrapper or a partial call."""
    if isinstance(place, property):
        place = place.fget
    if isinstance(place, (functools.partial, functools.cached_property)):
        place = place.func
    if isinstance(place, (classmethod, staticmethod)):
        place = place.__func__
    place = inspect.unwrap(place) if callable(place) else place
    return place if isinstance(place, FunctionType) else None


def _parts(node: ast.AST) -> Iterator[ast.AST]:
    """Yield the nodes of a function's body; what its decorators say is not run by it."""
    assert isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef))
    for statement in node.body:
        yield from ast.walk(statement)


def _name(node: ast.expr) -> str:
    """Return the last name of what is called."""
    return getattr(node, "attr", getattr(node, "id", ""))


def _texts(node: ast.expr, names: dict[str, Any]) -> Iterator[str]:
    if isinstance(node, ast.Starred):
        node = node.value
    value = names.get(node.id) if isinstance(node, ast.Name) else getattr(node, "value", None)
    yield from _heads(value)


def _heads(value: Any) -> Iterator[str]:
    """Yield the texts that a parameter is, or begins with."""
    if isinstance(value, (list, tuple)) and value:
        value = value[0]
    if isinstance(value, str):
        yield value


def _definition(function: FunctionType) -> ast.AST | None:
    code = function.__code__
    return _definitions(code.co_filename).get((code.co_name, code.co_firstlineno))


@functools.cache
def _definitions(file: str) -> dict[tuple[str, int], ast.AST]:
    """Return the functions of a file by name and first line, which is that of the decorators."""
    try:
        tree = ast.parse(Path(file).read_text(encoding="utf-8"))
    except (OSError, SyntaxError, ValueError):
        return {}
    found: dict[tuple[str, int], ast.AST] = {}
    for node in ast.walk(tree):
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
            lines = [node.lineno, *(decorator.lineno for decorator in node.decorator_list)]
            found[node.name, min(lines)] = node
    return found
