"""Reading ``.msg``, ``.srv`` and ``.action`` text.

Source: ROS 2 documentation, "Interfaces" (field types, bounds, default values, constants). What a
definition says is returned; what cannot be read is a :class:`DefinitionError`, never an exception.
"""

from __future__ import annotations

import ast
import math
import re
from dataclasses import dataclass

from deros.interfaces.types import (
    FLOAT32_MAX,
    FLOAT_TYPES,
    INTEGER_RANGES,
    MOST_DIGITS,
    PRIMITIVES,
    STRING_TYPES,
    Constant,
    FieldType,
    InterfaceType,
    MessageDefinition,
    Primitive,
)
from deros.names.keywords import CPP, PYTHON
from deros.names.names import not_text

SECTIONS = {
    "msg": ("",),
    "srv": ("_Request", "_Response"),
    "action": ("_Goal", "_Result", "_Feedback"),
}
"""The parts of each kind of file, by the suffix that their message's name has."""

_TYPE = re.compile(
    r"(?:(?P<package>\w+)/(?:msg/)?)?(?P<name>\w+)(?:<=(?P<bound>\d+))?"
    r"(?P<array>\[(?P<upto><=)?(?P<size>\d*)\])?",
    re.ASCII,
)
_CONSTANT = re.compile(r"(?P<name>[A-Za-z]\w*)\s*=\s*(?P<value>.*)", re.ASCII)
_FIELD = re.compile(r"(?P<name>[A-Za-z]\w*)(?:\s+(?P<value>.*))?", re.ASCII)
# Each part takes as much as there is: a repetition of single characters would need memory for each.
_TEXT = r"""[^#"']+|"[^"\\]*(?:\\.[^"\\]*)*"|'[^'\\]*(?:\\.[^'\\]*)*'|["']"""
_COMMENT = re.compile(rf"((?:{_TEXT})*)(?:\#.*)?")
_LINE_END = re.compile(r"\r\n|\n|\r")
_INTEGER = re.compile(r"[+-]?\d+", re.ASCII)
_NOT_FINITE = re.compile(r"[+-]?(?:inf(?:inity)?|nan)", re.IGNORECASE)
_SIZE_LIMIT = 2**32
_LONGEST_NAME = 255
_LONGEST_TEXT = 1 << 20

_RESERVED = CPP | PYTHON  # no generator of ROS 2 could make a field of that name either


@dataclass(frozen=True, slots=True)
class DefinitionError:
    """The reason why a definition cannot be read, and its line, from 1."""

    line: int
    message: str


def parse_definition(
    kind: InterfaceType, text: str
) -> tuple[MessageDefinition, ...] | DefinitionError:
    """Read the definition of ``kind``: one message, or the two or three parts of a file."""
    if len(text) > _LONGEST_TEXT:
        return DefinitionError(1, f"is longer than {_LONGEST_TEXT} characters")
    suffixes = SECTIONS[kind.kind]
    parts: list[_Part] = [_Part(kind.package)]
    for number, line in enumerate(_LINE_END.split(text), start=1):
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
        """Parse one line; return the reason if it is invalid."""
        stripped = without_comment(line).strip()
        if not stripped:
            return None
        if found := not_text(stripped):
            return f"the line contains the character U+{ord(found[0]):04X}"
        type_text, *more = stripped.split(maxsplit=1)
        kind = parse_field_type(type_text, self._package)
        if kind is None:
            return f"'{type_text}' is not a field type"
        rest = more[0] if more else ""
        if constant := _CONSTANT.fullmatch(rest):
            return self._add_constant(kind, constant["name"], constant["value"])
        if field := _FIELD.fullmatch(rest):
            return self._add_field(kind, field["name"], field["value"])
        return f"'{rest}' is not a field name"

    def _add_constant(self, kind: FieldType, name: str, text: str) -> str | None:
        if len(name) > _LONGEST_NAME:
            return f"a name has at most {_LONGEST_NAME} characters"
        if kind.is_array or not isinstance(kind.base, str):
            return f"constant '{name}' is of type {kind}, which is not a primitive type"
        value = _primitive(kind.base, text)
        if value is None:
            return f"'{text}' is not a value of type {kind}"
        self._constants.append(Constant(name, kind.base, value))
        return None

    def _add_field(self, kind: FieldType, name: str, text: str | None) -> str | None:
        if len(name) > _LONGEST_NAME:
            return f"a name has at most {_LONGEST_NAME} characters"
        if name in self._fields:
            return f"field '{name}' is declared twice"
        if name in _RESERVED:
            return f"field '{name}' has the name of a keyword of Python or C++"
        self._fields[name] = kind
        if text is None:
            return None
        value = _value(kind, text)
        if value is None:
            return f"'{text}' is not a value of type {kind}"
        self._defaults[name] = value
        return None


def without_comment(line: str) -> str:
    """Cut a line at its first ``#`` outside quotes."""
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
    bound, size = _count(match["bound"]), _count(match["size"])
    if bound == _SIZE_LIMIT or size == _SIZE_LIMIT or len(match["name"]) > _LONGEST_NAME:
        return None
    if match["package"] or base not in PRIMITIVES:
        base = InterfaceType(match["package"] or package, "msg", match["name"])
    if bound is not None and base not in STRING_TYPES:
        return None
    if not match["array"]:
        return FieldType(base, string_bound=bound)
    if size is None:
        return None if match["upto"] else FieldType(base, "unbounded", string_bound=bound)
    return FieldType(base, "bounded" if match["upto"] else "fixed", size, bound)


def _count(digits: str | None) -> int | None:
    """Return a size or bound, which stays below 2 ** 32; anything greater is that limit."""
    if not digits:
        return None
    digits = digits.lstrip("0") or "0"
    return int(digits) if len(digits) <= 10 and int(digits) < _SIZE_LIMIT else _SIZE_LIMIT


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
    if len(text) > MOST_DIGITS or not text.isascii() or "_" in text:
        return None
    try:
        if base in FLOAT_TYPES:
            return _float(base, text)
        value = int(text) if _INTEGER.fullmatch(text) else int(text, 0)
    except ValueError:
        return None
    least, greatest = INTEGER_RANGES[base]
    return value if least <= value <= greatest else None


def _float(base: str, text: str) -> float | None:
    """Return a number, or ``None`` for one beyond the greatest of its type."""
    value = float(text)
    if _NOT_FINITE.fullmatch(text):
        return value
    fits = math.isfinite(value) and (base == "float64" or abs(value) <= FLOAT32_MAX)
    return value if fits else None


def _unquote(text: str) -> str | None:
    """Return a string's value; one without quotes, as constants may be, stands for itself."""
    if text[:1] not in ("'", '"'):
        return text
    try:
        value = ast.literal_eval(text)
    except (SyntaxError, ValueError, MemoryError, RecursionError):
        return None
    if not isinstance(value, str) or not_text(value):
        return None
    return value
