"""Emission of the code that reads the selected fields of a message.

The code goes through the fields in their order up to the last selected one. Offsets are constants
as long as they do not depend on the data; after strings and sequences they are relative to the
variable ``at``.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from deros.generators.decoder.python.field_selection import NOTHING, FieldSelection, Pick
from deros.generators.decoder.python.module import FORMATS, Parts, is_view
from deros.generators.decoder.python.position import LARGEST, Position, moved
from deros.generators.decoder.python.steps import Steps
from deros.generators.decoder.python.writer import Writer
from deros.generators.text.python import filled
from deros.generators.text.unique_names import UniqueNames
from deros.interfaces.fields import Key
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import STRING_TYPES, FieldType, InterfaceType, MessageDefinition


class DecoderEmitter(Steps):
    """Emits the code that goes through the fields of a message and reads the selected ones."""

    def __init__(self, store: InterfaceStore, writer: Writer, position: Position) -> None:
        """Start at ``position``, where the message begins."""
        super().__init__(writer, position)
        self._store = store
        self._counters: list[str] = []
        self._depth = 0

    # Messages and single fields -----------------------------------------------------------------

    def message(
        self, kind: InterfaceType, selection: FieldSelection, more_selected: bool, path: str = ""
    ) -> None:
        """Emit the code for a message, up to its last selected field.

        Args:
            kind: the message type.
            selection: the selected fields.
            more_selected: whether a field after the message is selected, so that the code must go
                to the end of the message.
            path: the path of the message, for comments.
        """
        fields = self._definition(kind).fields
        last = max((i for i, (name, _) in enumerate(fields) if name in selection.parts), default=-1)
        for number, (name, type_) in enumerate(fields):
            if number > last and not more_selected:
                break
            part = selection.parts.get(name, NOTHING)
            self._field(
                type_, part, more_selected or number < last, f"{path}.{name}" if path else name
            )
        if not fields:
            self.position = self.position.plus(1)  # an empty structure has one byte
        self._look_up(selection.picks)

    def _definition(self, kind: InterfaceType) -> MessageDefinition:
        definition = self._store.message(kind)
        if definition is None:
            raise ValueError(f"the message type {kind.short} is not known")
        return definition

    def _field(
        self, type_: FieldType, selection: FieldSelection, more_selected: bool, path: str
    ) -> None:
        if not type_.is_array:
            self._single(type_, selection, more_selected, path)
        elif type_.array == "fixed":
            self._fixed(type_, selection, more_selected, path)
        else:
            self._sequence(type_, selection, more_selected, path)

    def _single(
        self, type_: FieldType, selection: FieldSelection, more_selected: bool, path: str
    ) -> None:
        base = type_.base
        if isinstance(base, InterfaceType):
            self.message(base, selection, more_selected, path)
        elif base in STRING_TYPES:
            self._string(base, selection, more_selected, path)
        else:
            letter, size = FORMATS[base]
            self.align(size, path)
            if selection.name is not None:
                self.gather(letter, size, selection.name, path)
            self.position = self.position.plus(size)

    def _string(self, base: str, selection: FieldSelection, more_selected: bool, path: str) -> None:
        self.align(4, path)
        if selection.name is not None:
            self._writer.line(f"{selection.name} = {self._text(base)}")
        if more_selected:
            self._skip(_CHARACTERS[base], path)

    def _text(self, base: str) -> str:
        return f"{self._writer.parts.helper(base)}(data, {self.position.text()}, order)"

    def _skip(self, size: int, path: str) -> None:
        """Skip a length and that many elements of a constant size."""
        known = math.gcd(self.position.plus(4).alignment(), size)
        length = self.one("I")
        self.advance(length if size == 1 else f"{size} * {length}", path and f"past {path}", 4)
        self.position = moved(known)

    # Arrays -------------------------------------------------------------------------------------

    def _fixed(
        self, type_: FieldType, selection: FieldSelection, more_selected: bool, path: str
    ) -> None:
        element, length = type_.element, type_.size or 0
        if element.base in FORMATS:
            self._fixed_numbers(element, length, selection, path)
            return
        if isinstance(element.base, InterfaceType) and selection.name is not None:
            self._writer.line(f"{selection.name} = range({length})")
        if selection.each is not None:
            self._every(element, str(length), selection, selection.each, path)
            return
        if self._is_constant(element, length):
            last = max((index for index, _ in selection.elements), default=-1)
            for index in range(length if more_selected else last + 1):
                part = selection.parts.get(index, NOTHING)
                self._single(element, part, more_selected or index < last, f"{path}[{index}]")
            return
        if element.base in STRING_TYPES and selection.name is not None:
            self._strings(element, length, selection, path)
        else:
            self._elements(element, length, selection, more_selected, path)

    def _is_constant(self, element: FieldType, length: int) -> bool:
        """Return whether the positions of that many elements do not depend on the data."""
        trial = self._trial(self.position)
        for _ in range(length):
            trial._single(element, NOTHING, True, "")
            if self._has_lines(trial):
                return False
        return True

    def _fixed_numbers(
        self, element: FieldType, length: int, selection: FieldSelection, path: str
    ) -> None:
        letter, size = FORMATS[str(element.base)]
        self.align(size, path)
        start = self.position
        if selection.name is not None and is_view(FieldType(element.base, "fixed", length)):
            self.view(letter, str(length), selection.name)
        elif selection.name is not None:
            self.gather(f"{length}{letter}", length * size, selection.name, path)
        for index, part in selection.elements:
            self.position = start.plus(index * size)
            self.gather(letter, size, str(part.name), f"{path}[{index}]")
        self.position = start.plus(length * size)

    def _sequence(
        self, type_: FieldType, selection: FieldSelection, more_selected: bool, path: str
    ) -> None:
        element = type_.element
        self.align(4, path)
        first, stride = self._layout(element)
        if selection is NOTHING and first < LARGEST and stride is not None:
            self._skip(stride, path)
            return
        count = self._counter()
        self._writer.line(f"{count} = {self.one('I')}", path and f"length of {path}")
        self.position = self.position.plus(4)
        self._depth += 1
        is_message = isinstance(element.base, InterfaceType)
        counted = is_message and selection.name is not None
        if selection.each is not None:
            self._every(element, count, selection, selection.each, path)
        elif stride is not None:
            self._even(element, (first, stride, count), selection, more_selected or counted, path)
        elif is_message or selection.name is None:
            self._elements(element, count, selection, more_selected or counted, path)
        else:
            self._strings(element, count, selection, path)
        self._depth -= 1
        if counted:
            helper = self._writer.parts.helper("elements")
            self._writer.line(f"{selection.name} = {helper}(data, {self.position.text()}, {count})")

    def _counter(self) -> str:
        """Return the variable for the length of a sequence, one for each depth of nesting."""
        if self._depth == len(self._counters):
            self._counters.append(self._writer.names.new("count"))
        return self._counters[self._depth]

    def _layout(self, element: FieldType) -> tuple[int, int | None]:
        """Return the alignment of an element's first byte, and its size, or ``None`` if it varies.

        The size is a multiple of the alignment, so it is the distance between elements.
        """
        first = self._first(element)
        trial = self._trial(moved(first))
        trial._single(element, NOTHING, True, "")
        size = trial.position.offset
        return first, None if self._has_lines(trial) or size % first else size

    def _first(self, type_: FieldType) -> int:
        if type_.array in ("bounded", "unbounded") or type_.base in STRING_TYPES:
            return 4
        if isinstance(type_.base, InterfaceType):
            fields = self._definition(type_.base).fields
            return self._first(fields[0][1]) if fields else 1
        return FORMATS[type_.base][1]

    # Elements that are looked up ------------------------------------------------------------------

    def _every(
        self,
        element: FieldType,
        count: str,
        selection: FieldSelection,
        each: FieldSelection,
        path: str,
    ) -> None:
        """Read what is selected of every element into lists, and look up elements in them."""
        self.settle(f"to {path}[0]")
        for collected in selection.lists.values():
            self._writer.line(f"{collected} = []")
        with self._writer.indented(f"for _ in range({count}):"):
            self.position = moved(1)
            self._single(element, each, True, f"{path}[]")
            self.read_gathered()
            for name, collected in selection.lists.items():
                self._writer.line(f"{collected}.append({name})")
            self.settle("")
        self.position = moved(1)
        self._look_up(selection.picks)

    def _look_up(self, picks: Sequence[Pick]) -> None:
        if picks:
            self.read_gathered()
        for each in picks:
            if isinstance(each.step, Key):
                find = self._writer.parts.helper("find")
                arguments = [repr(each.step.value), each.keys, each.values]
                self._writer.add(filled(f"{each.name} = {find}(", arguments, ")"))
            else:
                value = f"{each.values}[{each.step}] if len({each.values}) > {each.step}"
                self._writer.line(f"{each.name} = {value} else {self.nan()}")

    # Elements at a constant distance ------------------------------------------------------------

    def _even(
        self,
        element: FieldType,
        layout: tuple[int, int, str],
        selection: FieldSelection,
        more_selected: bool,
        path: str,
    ) -> None:
        first, stride, count = layout
        if first == LARGEST and self.position.aligned(LARGEST) != self.position:
            # A view, even an empty one, must not start after the end of the data.
            self._align_elements(count, more_selected or selection.name is not None, path)
        start = self.position
        if isinstance(element.base, InterfaceType):
            if first == LARGEST:  # the elements are aligned, if there are any
                self.position = Position(
                    start.moving, start.offset, LARGEST, -start.offset % LARGEST
                )
            self._even_messages(element, stride, count, selection, path)
        else:
            self._numbers(element, count, selection)
        self.position = start
        if more_selected:
            known = math.gcd(start.alignment(), stride)
            distance = count if stride == 1 else f"{stride} * {count}"
            self.advance(distance, path and f"past {path}")
            self.position = moved(known)

    def _align_elements(self, count: str, exact: bool, path: str) -> None:
        """Advance to the first element; an empty sequence has no padding."""
        if not exact:
            self.align(LARGEST, path)
            return
        self.settle("")
        with self._writer.indented(f"if {count}:"):
            self.align(LARGEST, path and f"{path}[0]")
            self.settle("")
        self.position = moved(4)

    def _even_messages(
        self, element: FieldType, stride: int, count: str, selection: FieldSelection, path: str
    ) -> None:
        start = self.position
        for index, part in selection.elements:
            self.read_gathered()
            self.default(part)
            with self._writer.indented(f"if {count} > {index}:"):
                self.position = start.plus(index * stride)
                self._single(element, part, False, f"{path}[{index}]")
                self.read_gathered()

    def _numbers(self, element: FieldType, count: str, selection: FieldSelection) -> None:
        letter, size = FORMATS[str(element.base)]
        if selection.name is not None and letter == "?":
            value = f"struct.unpack_from(f'{{{count}}}?', data, {self.position.text()})"
            self._writer.line(f"{selection.name} = {value}")
        elif selection.name is not None:
            self.view(letter, count, selection.name)
        for index, part in selection.elements:
            value = f"{self.one(letter, index * size)} if {count} > {index} else {self.nan()}"
            self._writer.line(f"{part.name} = {value}")

    # Elements whose positions depend on previous ones --------------------------------------------

    def _strings(
        self, element: FieldType, count: str | int, selection: FieldSelection, path: str
    ) -> None:
        base = str(element.base)
        self.settle(f"to {path}[0]")
        self._writer.line(f"{selection.name} = []")
        with self._writer.indented(f"for _ in range({count}):"):
            self.position = moved(1)
            self.align(4, "")
            self._writer.line(f"{selection.name}.append({self._text(base)})")
            self._skip(_CHARACTERS[base], "")
        self.position = moved(1)
        for index, part in selection.elements:
            value = f"{selection.name}[{index}]"
            if isinstance(count, str):
                value += f" if {count} > {index} else {self.nan()}"
            self._writer.line(f"{part.name} = {value}")

    def _elements(
        self,
        element: FieldType,
        count: str | int,
        selection: FieldSelection,
        more_selected: bool,
        path: str,
    ) -> None:
        """Go from element to element, and read the selected ones."""
        done, parts = 0, selection.elements
        for number, (index, part) in enumerate(parts):
            more = more_selected or number < len(parts) - 1
            if index > done:
                gap = index - done
                self._loop(
                    element,
                    str(gap) if isinstance(count, int) else f"min({_less(count, done)}, {gap})",
                    path,
                )
            if isinstance(count, int):
                self._single(element, part, more, f"{path}[{index}]")
            else:
                self._element(element, part, more, f"{count} > {index}", f"{path}[{index}]")
            done = index + 1
        if more_selected and done != count:
            self._rest(element, count, done, path)

    def _element(
        self, element: FieldType, part: FieldSelection, more: bool, condition: str, path: str
    ) -> None:
        self.settle("")
        self.default(part)
        before = self.position
        with self._writer.indented(f"if {condition}:"):
            self._single(element, part, more, path)
            self.read_gathered()
            if more:
                self.settle(f"past {path}")
        self.position = before.meet(self.position) if more else before

    def _loop(self, element: FieldType, times: str, path: str) -> None:
        """Skip elements in a loop."""
        self.settle("")
        entry = self.position
        while True:  # what is known of the position must hold in each iteration
            trial = self._trial(entry)
            trial._single(element, NOTHING, True, "")
            meet = entry.meet(trial.position.base())
            if meet == entry:
                break
            entry = meet
        with self._writer.indented(
            f"for _ in range({times}):", path and f"past elements of {path}"
        ):
            self.position = entry
            self._single(element, NOTHING, True, "")
            self.settle("")
        self.position = entry

    def _rest(self, element: FieldType, count: str | int, done: int, path: str) -> None:
        """Skip all elements from number ``done`` on."""
        trial = self._trial(self.position)
        trial._single(element, NOTHING, True, "")
        if trial._writer.has_lengths:
            self._loop(element, _less(count, done), path)
            return
        # The alignment from the second element on does not depend on the data: no loop is needed.
        if isinstance(count, int):
            self._single(element, NOTHING, True, f"{path}[{done}]")
            self.position = self.position.plus(self._distance(element) * (count - done - 1))
            return
        self.settle("")
        before = self.position
        with self._writer.indented(f"if {count} > {done}:" if done else f"if {count}:"):
            self._single(element, NOTHING, True, f"{path}[{done}]")
            distance = self._distance(element)
            known = math.gcd(self.position.alignment(), distance)
            self.advance(f"{distance} * ({count} - {done + 1})", path and f"past {path}")
        self.position = before.meet(moved(known))

    def _distance(self, element: FieldType) -> int:
        """Return the size of the element that starts here, and of all further ones."""
        trial = self._trial(self.position)
        trial._single(element, NOTHING, True, "")
        assert not self._has_lines(trial)
        return trial.position.offset - self.position.offset

    # Trials -------------------------------------------------------------------------------------

    def _trial(self, position: Position) -> DecoderEmitter:
        """Return an emitter that starts at ``position`` and whose lines are discarded."""
        return DecoderEmitter(
            self._store, Writer(UniqueNames(), Parts(), "", UniqueNames()), position
        )

    @staticmethod
    def _has_lines(trial: DecoderEmitter) -> bool:
        return bool(trial._writer.lines)


_CHARACTERS = {"string": 1, "wstring": 4}
"""The bytes for each unit of the length of a string."""


def _less(count: str | int, done: int) -> str:
    if isinstance(count, int):
        return str(count - done)
    return f"{count} - {done}" if done else count
