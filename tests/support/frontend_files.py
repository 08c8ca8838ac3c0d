"""Launch files in XML and YAML as trees, and what ``launch`` does with those that are generated."""

from __future__ import annotations

import contextlib
import os
import posixpath
import xml.etree.ElementTree as ET
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any
from unittest.mock import patch

import yaml

from deros.generators.api.protocol import Files
from deros.generators.builtin import rossystem_launch_xml, rossystem_launch_yaml
from deros.models.system import System
from deros.names.graph_names import resolve_name
from tests.support.frontends import Frontend, truth
from tests.support.launch import as_ros_reads
from tests.support.systems import CONTEXT

TARGETS = {"xml": rossystem_launch_xml, "yaml": rossystem_launch_yaml}

_NUMBERS = {"respawn_delay": float, "respawn_max_retries": int}
_SCALARS = {"float": float, "int": int, "str": str}


def both(system: System) -> Files:
    """Return the files in both languages."""
    return {path: f for each in TARGETS.values() for path, f in each(system, CONTEXT).items()}


@dataclass
class Tree:
    """An action or a detail of one, with the values of its attributes as launch reads them."""

    tag: str
    attributes: dict[str, Any] = field(default_factory=dict)
    children: list[Tree] = field(default_factory=list)


def tree(text: str, language: str) -> Tree:
    """Return a launch file as ``launch_xml`` or ``launch_yaml`` reads it."""
    if language == "xml":
        return _of_xml(ET.fromstring(text.encode()))
    ((tag, found),) = yaml.safe_load(text).items()
    return _of_yaml(tag, found)


def _of_xml(found: ET.Element) -> Tree:
    read: dict[str, Any] = {
        name: _NUMBERS.get(name, str)(value) for name, value in found.attrib.items()
    }
    if found.tag == "param" and "type" in read:
        as_yaml: Any = yaml.safe_load
        with contextlib.suppress(ValueError):  # of a substitution, it stays a text
            read["value"] = _SCALARS.get(read["type"], as_yaml)(read["value"])
    return Tree(found.tag, read, [_of_xml(each) for each in found])


def _of_yaml(tag: str, found: Any) -> Tree:
    if isinstance(found, list):
        return Tree(tag, {}, [_of_yaml(*one) for each in found for one in each.items()])
    made = Tree(tag)
    for name, value in found.items():
        if name == "children":
            made.children += _of_yaml(tag, value).children
        elif isinstance(value, list) and value and isinstance(value[0], dict):
            made.children += [_of_yaml(name, each) for each in value]
        else:
            made.attributes[name] = value
    return made


@dataclass(frozen=True)
class Started:
    """A process that is started; what it is computed from is not in it."""

    tag: str
    attributes: Mapping[str, str]
    parameters: Mapping[str, Any]
    remappings: Mapping[str, str]
    variables: Mapping[str, str]

    @property
    def full_name(self) -> str:
        """The name of a node in the graph."""
        return resolve_name(self.attributes["name"], self.attributes["namespace"])


def started(
    found: Tree, given: Mapping[str, str], folder: str = "/folder", root: str = "/"
) -> Iterator[Started]:
    """Yield the processes that a launch file starts which is included below a namespace.

    Raises:
        ValueError: what the file, or launch, says of a value that is refused.
    """
    values = dict(given)
    with patch.dict(os.environ):
        for each in found.children:
            yield from _started(each, values, Frontend(values, folder), root)


def _started(
    found: Tree, values: dict[str, str], frontend: Frontend, root: str
) -> Iterator[Started]:
    if not _holds(found, frontend):
        return
    read = {
        name: frontend.performed(value) if isinstance(value, str) else value
        for name, value in found.attributes.items()
        if name not in ("if", "unless") and found.tag != "arg"
    }
    match found.tag:
        case "arg":
            _declare(found, values, frontend)
        case "let":
            values[read["name"]] = read["value"]
        case "set_env":
            os.environ[read["name"]] = read["value"]
        case "group":
            before = dict(values)
            with patch.dict(os.environ):
                for each in found.children:
                    yield from _started(each, values, frontend, root)
            values.clear()
            values |= before
        case tag:
            if "namespace" in read:
                read["namespace"] = posixpath.join(root, read["namespace"])
            yield Started(
                tag,
                read,
                dict(_details(found, "param", "value", frontend)),
                {n: str(v) for n, v in _details(found, "remap", "to", frontend)},
                {n: str(v) for n, v in _details(found, "env", "value", frontend)},
            )


def _holds(found: Tree, frontend: Frontend) -> bool:
    holds = truth(frontend.performed(found.attributes.get("if", "true")))
    return holds and not truth(frontend.performed(found.attributes.get("unless", "false")))


def _declare(found: Tree, values: dict[str, str], frontend: Frontend) -> None:
    name = found.attributes["name"]
    if name not in values:
        if "default" not in found.attributes:
            raise ValueError(f"Required launch argument {name!r} was not provided")
        values[name] = frontend.performed(found.attributes["default"])
    choices = [each.attributes["value"].replace("\\\\", "\\") for each in found.children]
    if choices and values[name] not in choices:
        raise ValueError(f"Argument {name!r} provided value {values[name]!r} is not valid")


def _details(found: Tree, tag: str, value: str, frontend: Frontend) -> Iterator[tuple[str, Any]]:
    for each in found.children:
        if each.tag == tag and value in each.attributes:
            name = each.attributes.get("name", each.attributes.get("from"))
            made = _performed(each.attributes[value], each.attributes.get("type", "str"), frontend)
            is_written = tag == "param" and found.tag != "composable_node"
            yield frontend.performed(str(name)), as_ros_reads(made) if is_written else made


def _performed(value: Any, kind: str, frontend: Frontend) -> Any:
    if isinstance(value, list):
        return [_performed(each, kind.removeprefix("list_of_"), frontend) for each in value]
    if not isinstance(value, str):
        return value
    text = frontend.performed(value)
    return truth(text) if kind == "bool" else _SCALARS[kind](text)
