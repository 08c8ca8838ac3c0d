"""Parameter files, read in the very steps of ROS 2's own reader.

:class:`Overrides` is the structure that ``rcl_parse_yaml_file`` fills: several files may be read
into it one after the other, and that is how ROS 2 merges them. Keys keep the place of their first
mention, and so do parameters; which of two wins is decided when a node goes through them. The state
of the reader and its quirks are those of ``parse_file_events`` in
``rcl_yaml_param_parser/src/parse.c`` (Jazzy): what looks odd here is so there.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Generic, TypeVar

from deros.diagnostics import Span
from deros.metamodels.parameter_files.events import NotReadable
from deros.metamodels.parameter_files.scalars import value_of
from deros.models.common import Scalar, Value
from deros.models.parameter_files import MARK, Event, Fault, FileValue, Section

_ORDER = (bool, int, float, str)
"""The types in the order in which a node looks for a value; lists come after scalars."""

_NODES, _PARAMETERS = 1, 2
_WORD = re.compile(r"\*\*?|[A-Za-z_][A-Za-z0-9_]*", re.ASCII)
_LONGEST = 255

Giver = TypeVar("Giver")
_Kind = tuple[bool, type]


@dataclass(slots=True)
class Entry(Generic[Giver]):
    """A parameter of a section; ``values`` has one for each type that it was given in."""

    name: str
    name_span: Span
    giver: Giver
    values: dict[_Kind, tuple[Value, Span]] = field(default_factory=dict)

    def value(self) -> FileValue:
        """Return what a node reads: of values of several types, not the last one."""
        for is_list in (False, True):
            for kind in _ORDER:
                if (is_list, kind) in self.values:
                    value, span = self.values[is_list, kind]
                    return FileValue(self.name, value, self.name_span, span)
        return FileValue(self.name, None, self.name_span, self.name_span)


@dataclass(slots=True)
class Slot(Generic[Giver]):
    """The parameters under one key."""

    key: str
    spans: list[Span] = field(default_factory=list)
    entries: list[Entry[Giver]] = field(default_factory=list)

    def section(self) -> Section:
        """Return it as one of a document."""
        return Section(self.key, tuple(self.spans), tuple(each.value() for each in self.entries))


class Overrides(Generic[Giver]):
    """What one or several files, each read for a *giver*, set for all nodes."""

    def __init__(self) -> None:
        """Start with nothing."""
        self.slots: list[Slot[Giver]] = []

    def read(self, events: Iterable[Event], giver: Giver) -> None:
        """Read a file.

        Raises:
            NotReadable: ROS 2 refuses it.
        """
        _Reader(self, giver).read(events)

    def slot(self, key: str) -> Slot[Giver]:
        """Return the section of a key, which is the last one if it is new."""
        for each in self.slots:
            if each.key == key:
                return each
        self.slots.append(Slot(key))
        return self.slots[-1]


class _Namespace:
    """Names that are joined while the reader goes down, and cut again as it comes up."""

    def __init__(self, separator: str) -> None:
        self._separator = separator
        self.text: str | None = None
        self.count = 0

    def add(self, name: str) -> None:
        if self.count == 0 or self.text is None:
            self.text = name
        else:
            between = "" if self.text.endswith(self._separator) else self._separator
            self.text += between + name
        self.count += 1

    def remove(self) -> None:
        if self.count == 0:
            return
        self.count -= 1
        if self.count == 0:
            self.text = None
        elif self.text is not None and self._separator in self.text:
            self.text = self.text.rpartition(self._separator)[0]


class _Reader(Generic[Giver]):
    """Reads one file."""

    def __init__(self, overrides: Overrides[Giver], giver: Giver) -> None:
        self._overrides = overrides
        self._giver = giver
        self._level = _NODES
        self._depth = 0
        self._nodes, self._parameters = _Namespace("/"), _Namespace(".")
        self._is_key, self._is_list, self._is_new = True, False, False
        self._list_kind: type | None = None
        self._slot: Slot[Giver] | None = None
        self._at = 0
        """The position of the entry in the section: as in ROS 2, it outlives the section."""
        self._spans: list[Span] = []

    def read(self, events: Iterable[Event]) -> None:
        for event in events:
            if event.is_in_braces and not event.is_quoted and ":" in event.text:
                what = "inside of [] and {}, it takes ':' for the end of a key"
                raise _refused(what, event, "put the text in quotes")
            match event.kind:
                case "scalar" if self._is_key:
                    self._key(event)
                    self._is_key = False
                case "scalar":
                    self._value(event)
                    self._is_key = not self._is_list
                case "list":
                    self._list(event)
                case "end of list":
                    self._is_list, self._is_key = False, True
                case "mapping":
                    self._mapping()
                case _:
                    self._end_of_mapping()

    # Structure -----------------------------------------------------------------------------------

    def _mapping(self) -> None:
        self._depth += 1
        self._is_new = self._is_key = True
        if self._level == _PARAMETERS and self._depth - (self._nodes.count + 1) == 2:
            self._is_new = False

    def _end_of_mapping(self) -> None:
        if self._level == _PARAMETERS:
            if self._parameters.count > 0:
                self._parameters.remove()
            else:
                self._level = _NODES
        elif self._depth == self._nodes.count + 1:
            self._nodes.remove()
            del self._spans[self._nodes.count :]
        self._depth -= 1

    def _list(self, event: Event) -> None:
        if self._is_key:
            raise _refused("a list is no name, and none may follow a value", event)
        if self._level != _PARAMETERS:
            raise _refused(f"a list stands only below '{MARK}'", event)
        self._is_list, self._list_kind = True, None

    # Names ---------------------------------------------------------------------------------------

    def _key(self, event: Event) -> None:
        if not event.text:
            raise _refused("a name is missing", event)
        if self._level == _PARAMETERS:
            self._parameter(event)
        elif event.text.startswith(MARK):
            self._marked(event)
        else:
            self._nodes.add(event.text)
            self._spans.append(event.span)

    def _marked(self, event: Event) -> None:
        """Enter the parameters of the node whose name has been read."""
        if self._nodes.count == 0 or self._nodes.text is None:
            hint = f"put the node's name above it, or '/**' for all: '/**: {{{MARK}: …}}'"
            raise _refused(f"'{MARK}' stands below the name of a node", event, hint)
        name, span = self._nodes.text, self._spans[-1]
        if not _is_name(name):
            hint = "a key is the full name of a node, '/**', '/**/NAME' or '/NAMESPACE/*'"
            fault = Fault(f"ROS 2 does not read the key '{name}'", span, hint)
            raise NotReadable(fault)
        self._slot = self._overrides.slot(name)
        self._slot.spans.append(span)
        self._nodes.remove()
        del self._spans[self._nodes.count :]
        self._level = _PARAMETERS

    def _parameter(self, event: Event) -> None:
        slot = self._slot
        assert slot is not None  # the level says so
        if self._is_new:
            if self._at >= len(slot.entries):
                raise _refused("there is no name that these parameters could be below", event)
            self._parameters.text = slot.entries[self._at].name
            self._parameters.count += 1
            self._is_new = False
        above = self._parameters.text
        self._find(slot, event.text if above is None else above, event.span)
        if above is not None:
            found = slot.entries[self._at]
            found.name, found.name_span = f"{above}.{event.text}", event.span

    def _find(self, slot: Slot[Giver], name: str, span: Span) -> None:
        for position, each in enumerate(slot.entries):
            if each.name == name:
                self._at, each.name_span, each.giver = position, span, self._giver
                return
        self._at = len(slot.entries)
        slot.entries.append(Entry(name, span, self._giver))

    # Values --------------------------------------------------------------------------------------

    def _value(self, event: Event) -> None:
        slot = self._slot
        if self._level != _PARAMETERS or slot is None or not slot.entries:
            hint = (
                f"parameters stand below '{MARK}', and that below the name of their node; if this"
                " is a file of parameters alone, write 'plain' behind its path"
            )
            raise _refused(f"there is a value before '{MARK}'", event, hint)
        if not event.text and not event.is_quoted:
            raise _refused("the value is missing", event, 'write ""  for the empty text')
        value = value_of(event.text, is_text=event.is_text)
        if self._at >= len(slot.entries):
            return  # where nobody reads it
        entry = slot.entries[self._at]
        if not self._is_list:
            entry.values[False, type(value)] = value, event.span
        else:
            self._item(entry, value, event)

    def _item(self, entry: Entry[Giver], value: Scalar, event: Event) -> None:
        kind = type(value)
        if self._list_kind is None:
            self._list_kind = kind
            entry.values[True, kind] = (value,), event.span
            return
        if kind is not self._list_kind:
            hint = "write all of them alike: doubles with a point, texts in quotes"
            words = f"{_WORDS[kind]}, the elements before it {_PLURALS[self._list_kind]}"
            raise _refused(f"a list has elements of one type: this is {words}", event, hint)
        present, span = entry.values[True, kind]
        assert isinstance(present, tuple)
        whole = Span(span.source, span.start, event.span.end)
        entry.values[True, kind] = (*present, value), whole


_WORDS = {bool: "a bool", int: "an integer", float: "a double", str: "a text"}
_PLURALS = {bool: "bools", int: "integers", float: "doubles", str: "texts"}


def _refused(what: str, event: Event, hint: str = "") -> NotReadable:
    return NotReadable(Fault(f"ROS 2 refuses this file: {what}", event.span, hint))


def _is_name(key: str) -> bool:
    """Return whether ROS 2 reads a key: names with ``*`` and ``**`` for one and for any number."""
    namespace, slash, name = key.rpartition("/")
    if _WORD.fullmatch(name) is None or len(name) > _LONGEST:
        return False
    absolute = namespace if namespace.startswith("/") else f"/{namespace}"
    return not slash or not namespace or all(map(_WORD.fullmatch, absolute[1:].split("/")))
