"""Node models of RosTooling (``*.ros2``): packages, what they start, and the interfaces of that.

Source: the grammars Ros2.xtext, Ros.xtext and Basics.xtext of RosTooling.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from deros.diagnostics import SourceFile, Span
from deros.importers import node_text
from deros.importers.formats import loading
from deros.importers.formats.draft import Draft
from deros.importers.formats.names import UniqueNames
from deros.importers.formats.values import UnusableError, plain_value
from deros.importers.results import Missing, Parts
from deros.interfaces.types import InterfaceKind, InterfaceType
from deros.metamodels.yaml_trees.tree import Mapping, NotATreeError, Scalar, Sequence, Tree
from deros.metamodels.yaml_trees.tree import tree_of as yaml_tree
from deros.models.common import QosProfile, Value
from deros.models.node import ParameterType, PortKind, as_double
from deros.names.names import check_package_name, check_program_name
from deros.validators.node.values import type_fault

_SECTIONS: dict[str, tuple[PortKind, InterfaceKind]] = {
    "publishers": (PortKind.PUBLISHER, "msg"),
    "subscribers": (PortKind.SUBSCRIPTION, "msg"),
    "serviceservers": (PortKind.SERVICE, "srv"),
    "serviceclients": (PortKind.CLIENT, "srv"),
    "actionservers": (PortKind.ACTION, "action"),
    "actionclients": (PortKind.ACTION_CLIENT, "action"),
}
_TYPE = re.compile(r"(\w+)[/.](?:(msg|srv|action)[/.])?(\w+)", re.ASCII)
_SCALARS = {
    "Boolean": ParameterType.BOOL,
    "Integer": ParameterType.INTEGER,
    "Double": ParameterType.DOUBLE,
    "String": ParameterType.STRING,
}
_LIST = re.compile(r"(?:Array|List)\s*\[\s*(\w+)\s*(?:,\s*\1\s*)*\]", re.ASCII)
_NAMESPACE = re.compile(r"(Global|Relative|Private)Namespace\s*(?:\[([\w\s,/]*)\])?", re.ASCII)
_PRESETS = {
    "default_qos": None,
    "services_qos": "services",
    "sensor_qos": "sensor_data",
    "parameter_qos": "parameters",
}
_DEPTHS = range(1, 2**31)

# What YAML does not read and RosTooling does: entries without a blank, and lists of members.
_TIGHT = re.compile(r"^( *)-\[", re.MULTILINE)
_MEMBERS = re.compile(r"\[\s*\w+\s*:(?!:)[^\[\]]*\]")


def tree_of(source: SourceFile) -> Mapping:
    """Return the keys of a model of RosTooling, which looks like YAML.

    Raises:
        UnreadableError: if it cannot be read as YAML, or has no keys at its top.
    """
    text = _TIGHT.sub(r"\1- [", source.text)
    text = _MEMBERS.sub(lambda found: "{}" + "\n" * found[0].count("\n"), text)
    return loading.mapping_of(SourceFile(source.path, text))


@dataclass
class ReadNode:
    """A node of a package.

    Attributes:
        package, artifact, name: as the file has them; it may have names that no model can have.
        draft: what is said of it.
        unset: the parameters without a value, whose types are known.
        origin: of the package, for people; empty if it is not said.
    """

    package: str
    artifact: str
    name: str
    draft: Draft
    unset: dict[str, tuple[ParameterType, Span, str]]
    origin: str

    def is_called(self, reference: str) -> bool:
        """Return whether a system means this node: ``package.node``, or with the artifact."""
        names = {
            f"{self.package}.{self.name}",
            f"{self.package}.{self.artifact}",
            f"{self.package}.{self.artifact}.{self.name}",
        }
        return reference in names

    def parts(self) -> Parts:
        """Return the description."""
        node = self.draft.node
        fault = check_program_name(self.artifact)
        program = node.name if fault else self.artifact
        why = f"From {self.origin}" if self.origin else ""
        return self.draft.parts(node_text.head(node.name, node.package, program, why))

    def settle(self, always_set: set[str]) -> None:
        """Declare the parameters without a value that are always set, and leave the others out.

        The models of RosTooling need not say which value a parameter has, while one that is
        declared here without a value has to be set.
        """
        for name, (of_type, span, word) in self.unset.items():
            if name in always_set:
                self.draft.add_parameter(name, of_type, span)
                continue
            self.draft.takes_any_parameter = True
            why = "is left out: it has no value, and a declared one without a value must be set"
            self.draft.lack(f"parameter '{name}' of type {word}", why, span)


def read_nodes(source: SourceFile, names: UniqueNames) -> tuple[list[ReadNode], list[Missing]]:
    """Return the nodes of a file, and what belongs to none of them.

    Raises:
        UnreadableError: if it cannot be read.
    """
    top = tree_of(source)
    missing = list(loading.unused_keys(top))
    nodes: list[ReadNode] = []
    for package, tree in top.entries.items():
        nodes += _package(package, tree, names, missing)
    return nodes, missing


def _package(
    package: str, tree: Tree, names: UniqueNames, missing: list[Missing]
) -> Iterator[ReadNode]:
    what = f"package '{package}'"
    for key, value in entries(tree, what, missing):
        if key == "dependencies":
            why = "has 'dependencies'; here, those of its interfaces are found"
            missing.append(loading.missing(what, why, value.span))
        elif key not in ("fromGitRepo", "artifacts"):
            missing.append(loading.missing(what, f"has '{key}', which is not known", value.span))
    if not isinstance(tree, Mapping):
        return
    found = tree.get("fromGitRepo")
    origin = loading.shown(found.text) if isinstance(found, Scalar) else ""
    artifacts = tree.get("artifacts")
    for artifact, below in entries(artifacts, f"{what} with artifacts", missing):
        assert isinstance(artifacts, Mapping)
        named = below.get("node") if isinstance(below, Mapping) else None
        if not isinstance(below, Mapping) or not isinstance(named, Scalar) or not named.text:
            where = artifacts.keys[artifact]
            missing.append(loading.missing(f"artifact '{artifact}'", "has no node", where))
            continue
        yield _node((package, artifact, named.text), below, named.span, names, origin)


def entries(tree: Tree | None, what: str, missing: list[Missing]) -> list[tuple[str, Tree]]:
    """Return the keys of a tree with their values; none for an empty place."""
    if isinstance(tree, Mapping):
        return list(tree.entries.items())
    if tree is not None and not (isinstance(tree, Scalar) and tree.value is None):
        missing.append(loading.missing(what, "has a value in place of keys", tree.span))
    return []


def _node(
    called: tuple[str, str, str], tree: Mapping, place: Span, names: UniqueNames, origin: str
) -> ReadNode:
    package, artifact, name = called
    fault = check_package_name(package)
    draft = Draft(names.of(name), node_text.UNKNOWN_PACKAGE if fault else package)
    if fault:
        draft.lack(f"package '{package}'", f"is left out: its name {fault}", place)
    if fault := check_program_name(artifact):
        draft.lack(f"artifact '{artifact}'", f"is left out: its name {fault}", place)
    read = ReadNode(package, artifact, name, draft, {}, origin)
    for section, value in tree.entries.items():
        if section == "node":
            continue
        below = tree.keys[section]
        for key, said in entries(value, f"'{section}'", draft.missing):
            assert isinstance(value, Mapping)
            if section == "parameters":
                _parameter(read, key, said, value.keys[key])
            elif section in _SECTIONS:
                _port(draft, section, key, said, value.keys[key])
        if section not in ("parameters", *_SECTIONS):
            draft.lack(f"'{section}'", "is left out: a node has nothing of that name", below)
    return read


# Ports ------------------------------------------------------------------------------------------


def _port(draft: Draft, section: str, name: str, tree: Tree, place: Span) -> None:
    kind, interface = _SECTIONS[section]
    what = f"{kind.word} '{name}'"
    said = dict(entries(tree, what, draft.missing))
    stated = said.pop("type", None)
    found = _TYPE.fullmatch(stated.text) if isinstance(stated, Scalar) else None
    if found is None or found[2] not in (None, interface):
        word = stated.text if isinstance(stated, Scalar) else ""
        draft.lack(what, f"is left out: '{word}' is no type of a {kind.word}", place)
        return
    full = _below(draft, what, name, said.pop("ns", None))
    qos = _qos(draft, what, said.pop("qos", None))
    for key, value in said.items():
        draft.lack(what, f"has '{key}', which is not known", value.span)
    draft.add_port(kind, full, InterfaceType(found[1], interface, found[3]), place, qos)


def _below(draft: Draft, what: str, name: str, tree: Tree | None) -> str:
    """Return a name in the namespace that stands beside it."""
    if tree is None:
        return name
    found = _NAMESPACE.fullmatch(tree.text) if isinstance(tree, Scalar) else None
    if found is None:
        draft.lack(what, "has a namespace that cannot be read", tree.span)
        return name
    parts = [part.strip() for part in (found[2] or "").split(",") if part.strip()]
    start = {"Global": "/", "Relative": "", "Private": "~/"}[found[1]]
    return start + "/".join((*parts, name.removeprefix("/")))


def _qos(draft: Draft, what: str, tree: Tree | None) -> QosProfile | None:
    said = {
        key: (value.value if isinstance(value, Scalar) else None, value.span)
        for key, value in entries(tree, what, draft.missing)
    }
    fields: dict[str, Any] = {}
    for key, (value, span) in said.items():
        if key == "profile" and value in _PRESETS:
            fields["preset"] = _PRESETS[str(value)]
        elif key == "history" and value in ("keep_last", "keep_all"):
            fields["keep_all"] = value == "keep_all"
        elif key == "depth" and type(value) is int and value in _DEPTHS:
            fields["depth"] = value
        elif (key, value) in _WORDS:
            fields[key] = value
        else:
            draft.lack(what, f"has a QoS policy '{key}: {value}' that is not known", span)
    if fields.get("keep_all") and "depth" in fields:
        draft.lack(what, "keeps all messages, so that it has no depth", said["depth"][1])
        del fields["depth"]
    profile = QosProfile(**fields)
    return profile if profile != QosProfile() else None


_WORDS = {
    ("reliability", "reliable"),
    ("reliability", "best_effort"),
    ("durability", "volatile"),
    ("durability", "transient_local"),
}


# Parameters -------------------------------------------------------------------------------------


def parameter_type(word: str) -> ParameterType | None:
    """Return the type that a word of RosTooling is."""
    if found := _LIST.fullmatch(word):
        scalar = _SCALARS.get(found[1])
        return ParameterType(f"{scalar.value}[]") if scalar is not None else None
    return _SCALARS.get(word)


def typed(tree: Tree, of_type: ParameterType) -> Value | None:
    """Return a value as one of a type: texts need no quotes, and doubles no point.

    A list may be in quotes, as it is where RosTooling asked a running node.

    Raises:
        UnusableError: if it is not of the type.
    """
    if of_type.is_array and isinstance(tree, Scalar) and tree.text.startswith("["):
        tree = _list_in(tree)
    plain = plain_value(tree)
    if isinstance(tree, Sequence):
        items = (each for each in tree.items if isinstance(each, Scalar))
        plain = tuple(_scalar(each.value, each.text, of_type) for each in items)
    elif isinstance(tree, Scalar) and plain is not None:
        plain = _scalar(plain, tree.text, of_type)
    if plain is None:
        return None
    if fault := type_fault(of_type, plain):
        raise UnusableError(f"is of another type: {fault}")
    return as_double(plain, of_type)


def _list_in(tree: Scalar) -> Tree:
    try:
        found = yaml_tree(SourceFile("", tree.text))
    except NotATreeError:
        return tree
    return found if found is not None else tree


def _scalar(value: Any, text: str, of_type: ParameterType) -> Any:
    word = of_type.value.removesuffix("[]")
    if word == "string":
        return text
    if word == "double" and isinstance(value, str):
        try:
            return float(value)
        except ValueError:
            return value
    return value


def _parameter(read: ReadNode, name: str, tree: Tree, place: Span) -> None:
    draft = read.draft
    what = f"parameter '{name}'"
    said = dict(entries(tree, what, draft.missing))
    stated = said.pop("type", None)
    word = stated.text if isinstance(stated, Scalar) else ""
    of_type = parameter_type(word)
    if of_type is None:
        draft.lack(what, f"is left out: a parameter of ROS 2 has no type '{word}'", place)
        return
    default, value = said.pop("default", None), said.pop("value", None)
    if default is not None and value is not None:
        draft.lack(what, "has a default, too; its value stands in the model", default.span)
    for key, other in said.items():
        draft.lack(what, f"has '{key}', which a parameter has not", other.span)
    given = value or default
    found: Value | None = None
    if given is not None:
        try:
            found = typed(given, of_type)
        except UnusableError as error:
            draft.lack(what, f"has no value here: it {error}", given.span)
    if found is None:
        read.unset[name] = (of_type, place, word)
    else:
        draft.add_parameter(name, of_type, place, default=found)
