"""Parameters, remappings and variables of programs as elements."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any

from deros.importers.launch.python_files.visit.constructors import given, kind
from deros.importers.launch.python_files.visit.elements import Made, element
from deros.importers.launch.python_files.visit.texts import text

Computed = Callable[[Any], "Mapping[str, Any] | None"]
"""Returns what a parameter file has for a node that is made when it is asked for."""

_TYPES: Mapping[Any, str] = {bool: "bool", int: "int", float: "float", str: "str"}


def parameters(values: Iterable[Any], line: int, computed: Computed) -> Iterator[Made]:
    """Yield the parameter files and the parameters of a node, in their order."""
    for each in values:
        if (found := computed(each)) is not None:
            each = found
        if isinstance(each, Mapping):
            for name, value in each.items():
                yield parameter(name, value, line)
            continue
        what, said = kind(each), given(each) if hasattr(each, "__dict__") else {}
        if what == "Parameter" and "value" in said:
            yield _described(said["name"], said, line)
        elif what == "ParameterFile":
            substitutes = said.get("allow_substs")
            where = {"from": said["param_file"], "allow_substs": substitutes or None}
            yield element("param", line, where)
        else:
            yield element("param", line, {"from": each})


def parameter(name: Any, value: Any, line: int, tag: str = "param") -> Made:
    """Return one parameter; one that is a mapping has others in it."""
    if isinstance(value, Mapping):
        inner = [parameter(each, within, line, tag) for each, within in value.items()]
        return element(tag, line, {"name": name}, inner)
    if kind(value) == "ParameterValue":
        return _described(name, given(value), line, tag)
    if type(value) in _TYPES:
        word = repr(value) if isinstance(value, float) else value
        return element(tag, line, {"name": name, "value": word, "type": _TYPES[type(value)]})
    if isinstance(value, (list, tuple)):
        return _listed(name, value, line, tag)
    return element(tag, line, {"name": name, "value": value})


def _described(name: Any, said: Mapping[str, Any], line: int, tag: str = "param") -> Made:
    """Return a parameter whose value is said with its type."""
    value, of = said["value"], said.get("value_type")
    if of is None:
        found = parameter(name, value, line, tag)
        # Without a type, a text is what YAML makes of it.
        if isinstance(value, str):
            found["attributes"].pop("type", None)
        return found
    items = getattr(of, "__args__", ())
    word = f"list_of_{_TYPES.get(items[0])}" if items else _TYPES.get(of)
    if isinstance(value, (list, tuple)) and items:
        return _items(name, value, word, line, tag)
    return element(tag, line, {"name": name, "value": value, "type": word})


def _listed(name: Any, values: Iterable[Any], line: int, tag: str) -> Made:
    """Return a list, or the one text that a list with substitutions in it is."""
    values = list(values)
    if not values:
        return element(tag, line, {"name": name, "value": "[]"})
    kinds = set(map(type, values))
    if kinds == {int, float}:
        kinds = {float}
    if len(kinds) == 1 and kinds <= _TYPES.keys():
        return _items(name, values, f"list_of_{_TYPES[kinds.pop()]}", line, tag)
    is_text = any(hasattr(each, "perform") for each in values)
    if is_text and all(isinstance(each, str) or hasattr(each, "perform") for each in values):
        return element(tag, line, {"name": name, "value": values})
    return _items(name, values, None, line, tag)


def _items(name: Any, values: Iterable[Any], word: str | None, line: int, tag: str) -> Made:
    items = [
        element("value", line, content=text(repr(e) if isinstance(e, float) else e)) for e in values
    ]
    return element(tag, line, {"name": name, "type": word}, items)


def in_yaml(value: Any) -> Any:
    """Return a value as the text that YAML reads as it."""
    if isinstance(value, (list, tuple)) and all(type(each) in _TYPES for each in value):
        return json.dumps(value, ensure_ascii=False)
    return repr(value) if isinstance(value, float) else value


def remappings(rules: Iterable[Any], line: int) -> Iterator[Made]:
    """Yield remappings, each a source and a target."""
    for source, target in rules:
        yield element("remap", line, {"from": source, "to": target})


def variables(environment: Mapping[Any, Any], line: int) -> Iterator[Made]:
    """Yield variables of the environment."""
    for name, value in environment.items():
        yield element("env", line, {"name": name, "value": value})
