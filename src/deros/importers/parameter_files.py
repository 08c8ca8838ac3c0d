"""Parameter files as models: a description of each node that they name, and a system of these."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

from deros.diagnostics import Span
from deros.generators.node.description import parameter_line, quoted_text
from deros.importers.file_names import FileNames, numbered
from deros.importers.node_text import UNKNOWN_PACKAGE, body, head
from deros.importers.readers import Request, UnreadableError, source_of
from deros.importers.results import Imported, Missing, Parts
from deros.metamodels.parameter_files.events import NotReadable, events
from deros.metamodels.parameter_files.reading import Overrides
from deros.models.common import Value
from deros.models.node import BUILT_IN_PARAMETERS, Parameter, ParameterType
from deros.models.parameter_files import FileValue, Section
from deros.models.qos import USUAL_OVERRIDES
from deros.names.names import check_namespace, check_node_name, check_parameter_name, not_text
from deros.systems.parameters.overrides import matches

_WHY = "A parameter file shows no package and no program: write the right ones here."
_TYPES = {
    bool: (ParameterType.BOOL, ParameterType.BOOL_ARRAY),
    int: (ParameterType.INTEGER, ParameterType.INTEGER_ARRAY),
    float: (ParameterType.DOUBLE, ParameterType.DOUBLE_ARRAY),
    str: (ParameterType.STRING, ParameterType.STRING_ARRAY),
}


@dataclass(slots=True)
class _Node:
    """A node that files name, and its parameters by name, each with its value."""

    namespace: str
    name: str
    values: dict[str, FileValue] = field(default_factory=dict)

    @property
    def full_name(self) -> str:
        return f"{self.namespace.rstrip('/')}/{self.name}"


def read_parameter_files(request: Request) -> Imported:
    """Return a description of each node that the files name, and a system that reads them.

    Raises:
        UnreadableError: a file cannot be read, or none of them names a node.
    """
    sections = [(path, section) for path in request.files for section in _sections(path)]
    missing: list[Missing] = []
    nodes = _nodes(sections, missing)
    if not nodes:
        names = ", ".join(map(str, request.files))
        raise UnreadableError(f"{names}: no key is the name of one node")
    for path, section in sections:
        found = [node for node in nodes.values() if matches(section.key, node.full_name)]
        if not found:
            why = "is for none of the nodes that the files name"
            missing.append(Missing(f"key '{section.key}'", why, str(path), section.spans[0].line))
        for node in found:
            _take(node, section, path, missing)
    types = _type_names(nodes.values())
    name = request.name or "robot"
    system = _system(nodes, types, [_path(path, request.output) for path in request.files], name)
    files = {f"nodes/{types[key]}.rnd": _described(node, types[key]) for key, node in nodes.items()}
    return Imported({f"{name}.system": system, **files}, tuple(dict.fromkeys(map(str, missing))))


def _sections(path: Path) -> list[Section]:
    overrides: Overrides[None] = Overrides()
    try:
        overrides.read(events(source_of(path)), None)
    except NotReadable as refused:
        span, message = refused.fault.span, refused.fault.message
        raise UnreadableError(f"{path}:{span.line}:{span.column}: {message}") from refused
    return [slot.section() for slot in overrides.slots]


def _nodes(sections: list[tuple[Path, Section]], missing: list[Missing]) -> dict[str, _Node]:
    """Return the nodes whose full names are keys."""
    nodes: dict[str, _Node] = {}
    for path, section in sections:
        if "*" in section.key:
            continue
        namespace, _, name = f"/{section.key.lstrip('/')}".rpartition("/")
        why = check_node_name(name) or (check_namespace(namespace) if namespace else None)
        if why:
            line = section.spans[0].line
            missing.append(
                Missing(f"key '{section.key}'", f"names no node: it {why}", str(path), line)
            )
            continue
        node = _Node(namespace or "/", name)
        nodes.setdefault(node.full_name, node)
    return nodes


def _take(node: _Node, section: Section, path: Path, missing: list[Missing]) -> None:
    """Add the parameters of a section to those of a node; what comes first decides the type."""
    for value in section.values:
        why = check_parameter_name(value.name)
        if why:
            why = f"is left out of the description: its name {why}"
        elif value.value is None or value.value == ():
            why = "is left out of the description: its value has no type"
        elif any(isinstance(e, str) and not_text(e) for e in _items(value.value)):
            why = "is left out of the description: its value is not a text"
        if why:
            line = value.name_span.line
            missing.append(Missing(f"parameter '{value.name}'", why, str(path), line))
        elif value.name not in (*BUILT_IN_PARAMETERS, *USUAL_OVERRIDES):
            node.values.setdefault(value.name, value)


def _items(value: Value) -> tuple[object, ...]:
    return value if isinstance(value, tuple) else (value,)


def _type_names(nodes: Iterable[_Node]) -> dict[str, str]:
    """Return a name for the type of each node."""
    names = FileNames()
    return {node.full_name: names.first(numbered(node.name)) for node in nodes}


def _path(path: Path, output: Path) -> str:
    return os.path.relpath(path.absolute(), output.absolute()).replace(os.sep, "/")


def _system(nodes: dict[str, _Node], types: dict[str, str], paths: list[str], name: str) -> Parts:
    top = f'system {name}\n\nimports\n  import "nodes/*.rnd"\n'
    files = [f"parameters from {quoted_text(each, always=True)}" for each in paths]
    return Parts(top, "\n".join([*files, "", *_instances(nodes, types)]) + "\n")


def _instances(nodes: dict[str, _Node], types: dict[str, str]) -> Iterator[str]:
    """Yield the nodes, each name that is taken in a group of its own."""
    taken: set[str] = set()
    for key, node in nodes.items():
        space = "" if node.namespace == "/" else f" namespace {node.namespace}"
        if node.name not in taken:
            taken.add(node.name)
            yield f"node {node.name} : {types[key]}{space}"
            continue
        group, number = f"{node.name}_group", 2
        while group in taken:
            group, number = f"{node.name}_group_{number}", number + 1
        taken.add(group)
        yield f"subsystem {group}{space} {{ node {node.name} : {types[key]} }}"


def _described(node: _Node, name: str) -> Parts:
    lines = [f"  {parameter_line(_declared(each))}" for each in node.values.values()]
    notice = "parameters open  // a parameter file need not have all"
    text = body(lifecycle=False, parameters=[notice, *lines], ports=[], left_out=[])
    return Parts(head(name, UNKNOWN_PACKAGE, name, _WHY), text)


def _declared(found: FileValue) -> Parameter:
    assert found.value is not None
    value = found.value
    scalar, array = _TYPES[type(value[0] if isinstance(value, tuple) else value)]
    kind = array if isinstance(value, tuple) else scalar
    nowhere = Span(found.name_span.source, 0, 0)
    return Parameter(found.name, kind, value, nowhere, nowhere)
