"""Reading ``.msg``, ``.srv`` and ``.action`` text.

Source: ROS 2 documentation, "Interfaces" (field types, bounds, default values, constants). What a
definition says is returned; what cannot be read is a :class:`DefinitionError`, never an exception.
"""

from __future__ import annotations

import ast
import re
from dataclasses import dataclass

from deros.interfaces.types import (
    FLOAT_TYPES,
    INTEGER_RANGES,
    PRIMITIVES,
    STRING_TYPES,
    Constant,
    FieldType,
    InterfaceType,
    MessageDefinition,
    Primitive,
)

SECTIONS = {
    "msg": ("",),
    "srv": ("_Request", "_Response"),
    "action": ("_Goal", "_Result", "_Feedback"),
}
"""The parts of each kind of file, by the suffix that their message's name has."""

_TYPE = re.compile(
    r"(?:(?P<package>\w+)/(?:msg/)?)?(?P<name>\w+)(?:<=(?P<bound>\d+))?"
    r"(?P<array>\[(?P<upto><=)?(?P<size>\d*)\])?"
)
_CONSTANT = re.compile(r"(?P<name>[A-Za-z]\w*)\s*=\s*(?P<value>.*)")
_FIELD = re.compile(r"(?P<name>[A-Za-z]\w*)(?:\s+(?P<value>.*))?")
_COMMENT = re.compile(r"""((?:[^#"']|"(?:\\.|[^"\\])*"|'(?:\\.|[^'\\])*'|["'])*)(?:\#.*)?""")


@dataclass(frozen=True, slots=True)
class DefinitionError:
    """Why a definition cannot be read, and the line (from 1) where."""

    line: int
    message: str


def parse_definition(
    kind: InterfaceType, text: str
) -> tuple[MessageDefinition, ...] | DefinitionError:
    """Read the definition of ``kind``: one message, or the two or three parts of a file."""
    suffixes = SECTIONS[kind.kind]
    parts: list[_Part] = [_Part(kind.package)]
    for number, line in enumerate(text.splitlines(), start=1):
        if line.strip() == "---":
            parts.append(_Part(kind.package))
            continue
        problem = parts[-1].read(line)
        if problem is not None:
            return DefinitionError(number, problem)
    if len(parts) != len(suffixes):
        return DefinitionError(1, f"has {len(parts)} parts between '---', not {len(suffixes)}")
    return tuple(
        part.definition(InterfaceType(kind.package, kind.kind, kind.name + suffix))
        for part, suffix in zip(parts, suffixes, strict=True)
    )


class _Part:
    """The fields and constants between two separators, as they are read."""

    def __init__(self, package: str) -> None:
        self._package = package
        self._fields: dict[str, FieldType] = {}
        self._constants: list[Constant] = []
        self._defaults: dict[str, Primitive | tuple[Primitive, ...]] = {}

    def definition(self, kind: InterfaceType) -> MessageDefinition:
        fields, constants = tuple(self._fields.items()), tuple(self._constants)
        return MessageDefinition(kind, fields, constants, self._defaults)

    def read(self, line: str) -> str | None:
        """Take one line; return what is wrong with it, if anything is."""
        stripped = without_comment(line).strip()
        if not stripped:
            return None
        type_text, _, rest = stripped.partition(" ")
        if "\t" in type_text:
            type_text, _, rest = stripped.partition("\t")
        kind = parse_field_type(type_text, self._package)
        if kind is None:
            return f"'{type_text}' is no field type"
        rest = rest.strip()
        if constant := _CONSTANT.fullmatch(rest):
            return self._add_constant(kind, constant["name"], constant["value"])
        if found := _FIELD.fullmatch(rest):
            return self._add_field(kind, found["name"], found["value"])
        return f"'{rest}' is no field name"

    def _add_constant(self, kind: FieldType, name: str, text: str) -> str | None:
        if kind.is_array or not isinstance(kind.base, str):
            return f"constant '{name}' is of type {kind}, which is no primitive"
        value = _primitive(kind.base, text)
        if value is None:
            return f"'{text}' is no value of type {kind}"
        self._constants.append(Constant(name, kind.base, value))
        return None

    def _add_field(self, kind: FieldType, name: str, text: str | None) -> str | None:
        if name in self._fields:
            return f"field '{name}' is there twice"
        self._fields[name] = kind
        if text is None:
            return None
        value = _value(kind, text)
        if value is None:
            return f"'{text}' is no value of type {kind}"
        self._defaults[name] = value
        return None


def without_comment(line: str) -> str:
    """Cut a line at its first ``#`` that stands outside quotes."""
    match = _COMMENT.match(line)
    return match[1] if match else line


def parse_field_type(text: str, package: str) -> FieldType | None:
    """Read ``float64[9]``, ``string<=10[<=3]`` or ``geometry_msgs/Point``; ``None`` if it is none.

    A message named without its package is one of ``package``.
    """
    match = _TYPE.fullmatch(text)
    if match is None:
        return None
    base: str | InterfaceType = match["name"]
    bound = int(match["bound"]) if match["bound"] else None
    if match["package"] or base not in PRIMITIVES:
        base = InterfaceType(match["package"] or package, "msg", match["name"])
    if bound is not None and base not in STRING_TYPES:
        return None
    if not match["array"]:
        return FieldType(base, string_bound=bound)
    if not match["size"]:
        return None if match["upto"] else FieldType(base, "unbounded", string_bound=bound)
    return FieldType(base, "bounded" if match["upto"] else "fixed", int(match["size"]), bound)


def _value(kind: FieldType, text: str) -> Primitive | tuple[Primitive, ...] | None:
    if not isinstance(kind.base, str):
        return None
    if not kind.is_array:
        return _primitive(kind.base, text)
    if not (text.startswith("[") and text.endswith("]")):
        return None
    elements: list[Primitive] = []
    for element in _split(text[1:-1]):
        value = _primitive(kind.base, element)
        if value is None:
            return None
        elements.append(value)
    fits = kind.size is None or len(elements) == kind.size or kind.array == "bounded"
    return tuple(elements) if fits else None


def _split(text: str) -> list[str]:
    """Split at the commas outside quotes."""
    return [part.strip() for part in re.findall(r'(?:[^,"\']|"[^"]*"|\'[^\']*\')+', text)]


def _primitive(base: str, text: str) -> Primitive | None:
    text = text.strip()
    if base == "bool":
        return {"true": True, "1": True, "false": False, "0": False}.get(text.lower())
    if base in STRING_TYPES:
        return _unquote(text)
    try:
        if base in FLOAT_TYPES:
            return float(text)
        value = int(text, 0) if not text.lstrip("+-").isdigit() else int(text)
    except ValueError:
        return None
    least, greatest = INTEGER_RANGES[base]
    return value if least <= value <= greatest else None


def _unquote(text: str) -> str | None:
    """Return a string's value; one without quotes, as constants may be, stands for itself."""
    if text[:1] not in ("'", '"'):
        return text
    try:
        value = ast.literal_eval(text)
    except (SyntaxError, ValueError):
        return None
    return value if isinstance(value, str) else None
