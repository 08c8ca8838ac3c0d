"""The message definitions that recordings bring along, and which of them a system needs.

Source: MCAP specification, "Well-known schema encodings", ``ros2msg`` and ``ros2idl``.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from deros.generators.text.prose import printable_line
from deros.interfaces.definitions import DefinitionError, parse_definition
from deros.interfaces.nesting import DEEPEST
from deros.interfaces.types import FieldType, InterfaceType, MessageDefinition
from deros.names.names import check_package_name

_TYPE = re.compile(r"([a-z]\w*)/(?:msg/)?([A-Z]\w*)", re.ASCII)
_NEXT = re.compile(r"^={20,}[ \t]*\nMSG:[ \t]*(\S+)[ \t]*(?:\n|\Z)", re.MULTILINE)
_NEXT_IDL = re.compile(r"^={20,}[ \t]*\nIDL:[^\n]*(?:\n|\Z)", re.MULTILINE)
_DIRECTIVE = re.compile(r"^[ \t]*#[^\n]*$", re.MULTILINE)
"""What the preprocessor of IDL is for, such as ``#include``; rosbags reads none of it."""

_LONGEST = 1 << 20
_LONGEST_NAME = 100

_IDL_NAMES = {"octet": "byte"}
"""Primitives that have other names in IDL than in ``.msg``."""


def message_type(text: str) -> InterfaceType | None:
    """Return the message type that ``package/msg/Name`` is, or ``None``."""
    found = _TYPE.fullmatch(text)
    if found is None or check_package_name(found[1]) or len(text) > _LONGEST_NAME:
        return None
    return InterfaceType(found[1], "msg", found[2])


@dataclass(frozen=True, slots=True)
class Unusable:
    """A definition that cannot be used, and why."""

    why: str


Texts = dict[InterfaceType, str | Unusable]
"""Definitions in the language of ``.msg`` files."""


def definitions_in(of: InterfaceType, language: str, text: str) -> Texts:
    """Return the definition of a type, and those of the types in it.

    Args:
        of: the type.
        language: ``msg`` or ``idl``.
        text: all definitions, that of the type first.
    """
    if len(text) > _LONGEST:
        return {of: Unusable(f"is longer than {_LONGEST} characters")}
    text = text.replace("\r\n", "\n")
    texts = dict(_from_msg(of, text)) if language == "msg" else _from_idl(of, text)
    found: Texts = {}
    for each, definition in texts.items():
        found[each] = definition
        if isinstance(definition, str):
            parsed = parse_definition(each, definition)
            if isinstance(parsed, DefinitionError):
                why = f"cannot be used, line {parsed.line}: {printable_line(parsed.message)}"
                found[each] = Unusable(why)
    return found


def _from_msg(of: InterfaceType, text: str) -> Iterator[tuple[InterfaceType, str]]:
    first, *others = _NEXT.split(text)
    yield of, _ended(first)
    for name, definition in zip(others[::2], others[1::2], strict=True):
        each = message_type(name)
        if each is not None:
            yield each, _ended(definition)


def _ended(text: str) -> str:
    text = text.strip("\n")
    return f"{text}\n" if text else ""


def _from_idl(of: InterfaceType, text: str) -> Texts:
    """Return the types of IDL files, each of which has a line with its name before it."""
    texts: Texts = {}
    for file in filter(str.strip, _NEXT_IDL.split(text)):
        found = _from_idl_file(file)
        if isinstance(found, Unusable):
            return {of: found}
        texts.update(found)
    return texts if of in texts else {of: Unusable("is not in its IDL")}


def _from_idl_file(text: str) -> Texts | Unusable:
    from rosbags.typesys import get_types_from_idl

    try:
        described: Mapping[str, Any] = get_types_from_idl(_DIRECTIVE.sub("", text))
        return {
            each: _in_msg(*definition)
            for name, definition in described.items()
            if (each := message_type(name)) is not None
        }
    # IDL that rosbags cannot read ends in more than the error that it documents.
    except Exception:
        # What the error says is mostly the whole text.
        first = printable_line(text.strip().partition("\n")[0])[:60]
        return Unusable(f"is IDL that cannot be converted (the one that begins '{first}')")


def _in_msg(constants: Any, fields: Any) -> str:
    """Return a ``.msg`` text for what rosbags reads of a structure in IDL."""
    lines = [f"{_base(base)} {name}={_constant(value)}" for name, base, value in constants]
    lines += (f"{_field(described)} {name}" for name, described in fields if name != _PLACEHOLDER)
    return "".join(f"{line}\n" for line in lines)


_PLACEHOLDER = "structure_needs_at_least_one_member"
"""The member of a structure in IDL that stands for none."""


def _field(described: Any) -> str:
    """Return the type of a field: ``(BASE, (name, bound))``, NAME, or ARRAY and SEQUENCE of it."""
    node, argument = described
    if node.name in ("ARRAY", "SEQUENCE"):
        element, size = argument
        least = "<=" if node.name == "SEQUENCE" and size else ""
        return f"{_field(element)}[{least}{size or ''}]"
    if node.name == "NAME":
        return str(argument).replace("/msg/", "/")
    base, bound = argument
    return f"{_base(base)}<={bound}" if bound else _base(base)


def _base(name: str) -> str:
    return _IDL_NAMES.get(name, name)


def _constant(value: Any) -> str:
    return repr(value) if isinstance(value, str) else str(value)


# What is needed ---------------------------------------------------------------------------------


@dataclass
class Needed:
    """The definitions that types need and that are not known here.

    A package has all its definitions in one place. So where one of a package is needed, those of
    its other types are, too.

    Attributes:
        texts: the definitions to write.
        faults: of the types that cannot be used, why.
    """

    types: Iterable[InterfaceType]
    recorded: Texts
    is_known: Callable[[InterfaceType], bool]
    texts: dict[InterfaceType, str] = field(default_factory=dict)
    faults: dict[InterfaceType, str] = field(default_factory=dict)
    _packages: set[str] = field(default_factory=set)

    def __post_init__(self) -> None:
        before = -1
        while len(self._packages) > before:
            before = len(self._packages)
            self.texts, self.faults = {}, {}
            for each in self.types:
                taken = dict(self.texts)
                if fault := self._take(each, taken, ()):
                    self.faults[each] = fault
                else:
                    self.texts = taken
                    self._packages |= {other.package for other in taken}

    def _take(
        self,
        each: InterfaceType,
        taken: dict[InterfaceType, str],
        around: tuple[InterfaceType, ...],
    ) -> str | None:
        """Add the definitions that a type needs; return why it cannot be used."""
        if each in around:
            return "it holds itself"
        if each in taken or (each.package not in self._packages and self.is_known(each)):
            return None
        text = self.recorded.get(each)
        if text is None:
            return f"there is no definition of {each.short} here or in the recording"
        if isinstance(text, Unusable):
            return f"the recorded definition of {each.short} {text.why}"
        if len(around) >= DEEPEST:
            return f"messages are nested more than {DEEPEST} levels deep in it"
        for other in _nested(each, text):
            if fault := self._take(other, taken, (*around, each)):
                return fault
        taken[each] = text
        return None


def _nested(of: InterfaceType, text: str) -> list[InterfaceType]:
    parsed = parse_definition(of, text)
    assert not isinstance(parsed, DefinitionError)
    bases = (kind.base for _, kind in parsed[0].fields)
    return list(dict.fromkeys(each for each in bases if isinstance(each, InterfaceType)))


# Comparison -------------------------------------------------------------------------------------

_OCTETS = ("byte", "char")


def differs(of: InterfaceType, text: str | Unusable, known: MessageDefinition) -> bool:
    """Return whether messages of a recorded definition have other fields than those known here."""
    if isinstance(text, Unusable):
        return False
    parsed = parse_definition(of, text)
    assert not isinstance(parsed, DefinitionError)
    return _shape(parsed[0]) != _shape(known)


def _shape(definition: MessageDefinition) -> list[tuple[str, FieldType]]:
    """Return the fields; ``byte`` and ``char`` are spelled in several ways, and mean one thing."""
    return [
        (name, FieldType("uint8", kind.array, kind.size) if kind.base in _OCTETS else kind)
        for name, kind in definition.fields
    ]
