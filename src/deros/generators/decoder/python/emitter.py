"""The way through a message to its wanted fields, as straight lines of Python.

A walk keeps to constant offsets while the data does not matter, and behind strings and sequences to
constant distances from the variable ``at``. It ends at the last wanted field.
"""

from __future__ import annotations

import math

from deros.generators.decoder.python.field_selection import NOTHING, FieldSelection
from deros.generators.decoder.python.module import FORMATS, Parts
from deros.generators.decoder.python.position import LARGEST, Position, moved
from deros.generators.decoder.python.steps import Steps
from deros.generators.decoder.python.writer import Writer
from deros.generators.text.unique_names import UniqueNames
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import STRING_TYPES, FieldType, InterfaceType, MessageDefinition

SMALL = 64
"""The longest array of fixed length that is handed out as a tuple."""


class DecoderEmitter(Steps):
    """Passes over the fields of a message in their order and reads those that are wanted."""

    def __init__(self, store: InterfaceStore, writer: Writer, place: Position) -> None:
        """Begin at ``place``, where the message has its first byte."""
        super().__init__(writer, place)
        self._store = store
        self._counters: list[str] = []
        self._depth = 0

    # Messages and single fields -----------------------------------------------------------------

    def message(
        self, kind: InterfaceType, wanted: FieldSelection, later: bool, path: str = ""
    ) -> None:
        """DecoderEmitter through a message; to its end only if something is wanted ``later``."""
        fields = self._definition(kind).fields
        last = max((i for i, (name, _) in enumerate(fields) if name in wanted.parts), default=-1)
        for number, (name, type_) in enumerate(fields):
            if number > last and not later:
                return
            part = wanted.parts.get(name, NOTHING)
            self._field(type_, part, later or number < last, f"{path}.{name}" if path else name)
        if not fields:
            self.place = self.place.plus(1)  # no structure is without a byte

    def _definition(self, kind: InterfaceType) -> MessageDefinition:
        definition = self._store.message(kind)
        if definition is None:
            raise ValueError(f"the message type {kind.short} is not known")
        return definition

    def _field(self, type_: FieldType, wanted: FieldSelection, later: bool, path: str) -> None:
        if not type_.is_array:
            self._single(type_, wanted, later, path)
        elif type_.array == "fixed":
            self._fixed(type_, wanted, later, path)
        else:
            self._sequence(type_, wanted, later, path)

    def _single(self, type_: FieldType, wanted: FieldSelection, later: bool, path: str) -> None:
        base = type_.base
        if isinstance(base, InterfaceType):
            self.message(base, wanted, later, path)
        elif base in STRING_TYPES:
            self._string(base, wanted, later, path)
        else:
            letter, size = FORMATS[base]
            self.align(size, path)
            if wanted.name is not None:
                self.gather(letter, size, wanted.name, path)
            self.place = self.place.plus(size)

    def _string(self, base: str, wanted: FieldSelection, later: bool, path: str) -> None:
        self.align(4, path)
        if wanted.name is not None:
            self._writer.line(f"{wanted.name} = {self._text(base)}")
        if later:
            self._skip(_CHARACTERS[base], path)

    def _text(self, base: str) -> str:
        return f"{self._writer.parts.helper(base)}(data, {self.place.text()}, order)"

    def _skip(self, size: int, path: str) -> None:
        """Go behind a length, and as many elements of a constant size."""
        known = math.gcd(self.place.plus(4).alignment(), size)
        length = self.one("I")
        self.advance(length if size == 1 else f"{size} * {length}", path and f"past {path}", 4)
        self.place = moved(known)

    # Arrays -------------------------------------------------------------------------------------

    def _fixed(self, type_: FieldType, wanted: FieldSelection, later: bool, path: str) -> None:
        element, length = type_.element, type_.size or 0
        if element.base in FORMATS:
            self._fixed_numbers(element, length, wanted, path)
            return
        if isinstance(element.base, InterfaceType) and wanted.name is not None:
            self._writer.line(f"{wanted.name} = range({length})")
        if self._is_constant(element, length):
            last = max((index for index, _ in wanted.elements), default=-1)
            for index in range(length if later else last + 1):
                part = wanted.parts.get(index, NOTHING)
                self._single(element, part, later or index < last, f"{path}[{index}]")
            return
        if element.base in STRING_TYPES and wanted.name is not None:
            self._strings(element, length, wanted, path)
        else:
            self._elements(element, length, wanted, later, path)

    def _is_constant(self, element: FieldType, length: int) -> bool:
        """Tell whether that many elements from here on stand at places known beforehand."""
        trial = self._trial(self.place)
        for _ in range(length):
            trial._single(element, NOTHING, True, "")
            if self._wrote(trial):
                return False
        return True

    def _fixed_numbers(
        self, element: FieldType, length: int, wanted: FieldSelection, path: str
    ) -> None:
        letter, size = FORMATS[str(element.base)]
        self.align(size, path)
        start = self.place
        if wanted.name is not None and (length <= SMALL or letter == "?"):
            self.gather(f"{length}{letter}", length * size, wanted.name, path)
        elif wanted.name is not None:
            self.view(letter, str(length), wanted.name)
        for index, part in wanted.elements:
            self.place = start.plus(index * size)
            self.gather(letter, size, str(part.name), f"{path}[{index}]")
        self.place = start.plus(length * size)

    def _sequence(self, type_: FieldType, wanted: FieldSelection, later: bool, path: str) -> None:
        element = type_.element
        self.align(4, path)
        first, stride = self._layout(element)
        if wanted is NOTHING and first < LARGEST and stride is not None:
            self._skip(stride, path)
            return
        count = self._counter()
        self._writer.line(f"{count} = {self.one('I')}", path and f"length of {path}")
        self.place = self.place.plus(4)
        self._depth += 1
        is_message = isinstance(element.base, InterfaceType)
        counted = is_message and wanted.name is not None
        if stride is not None:
            self._even(element, (first, stride, count), wanted, later or counted, path)
        elif is_message or wanted.name is None:
            self._elements(element, count, wanted, later or counted, path)
        else:
            self._strings(element, count, wanted, path)
        self._depth -= 1
        if counted:
            helper = self._writer.parts.helper("elements")
            self._writer.line(f"{wanted.name} = {helper}(data, {self.place.text()}, {count})")

    def _counter(self) -> str:
        """Return the variable for the length of a sequence; nested ones have their own."""
        if self._depth == len(self._counters):
            self._counters.append(self._writer.names.new("count"))
        return self._counters[self._depth]

    def _layout(self, element: FieldType) -> tuple[int, int | None]:
        """Return the alignment of an element's first byte, and its size if that is always the same.

        The size is then a multiple of the alignment: elements follow each other at that distance.
        """
        first = self._first(element)
        trial = self._trial(moved(first))
        trial._single(element, NOTHING, True, "")
        size = trial.place.offset
        return first, None if self._wrote(trial) or size % first else size

    def _first(self, type_: FieldType) -> int:
        if type_.array in ("bounded", "unbounded") or type_.base in STRING_TYPES:
            return 4
        if isinstance(type_.base, InterfaceType):
            fields = self._definition(type_.base).fields
            return self._first(fields[0][1]) if fields else 1
        return FORMATS[type_.base][1]

    # Elements at a constant distance ------------------------------------------------------------

    def _even(
        self,
        element: FieldType,
        layout: tuple[int, int, str],
        wanted: FieldSelection,
        later: bool,
        path: str,
    ) -> None:
        first, stride, count = layout
        if first == LARGEST and self.place.aligned(LARGEST) != self.place:
            # A view, even one of nothing, must not begin behind the data.
            self._align_elements(count, later or wanted.name is not None, path)
        start = self.place
        if isinstance(element.base, InterfaceType):
            if first == LARGEST:  # so they are, where there are any
                self.place = Position(start.moving, start.offset, LARGEST, -start.offset % LARGEST)
            self._even_messages(element, stride, count, wanted, path)
        else:
            self._numbers(element, count, wanted)
        self.place = start
        if later:
            known = math.gcd(start.alignment(), stride)
            distance = count if stride == 1 else f"{stride} * {count}"
            self.advance(distance, path and f"past {path}")
            self.place = moved(known)

    def _align_elements(self, count: str, exact: bool, path: str) -> None:
        """Go to the first element; where there is none, there is no padding, either."""
        if not exact:
            self.align(LARGEST, path)
            return
        self.settle("")
        with self._writer.indented(f"if {count}:"):
            self.align(LARGEST, path and f"{path}[0]")
            self.settle("")
        self.place = moved(4)

    def _even_messages(
        self, element: FieldType, stride: int, count: str, wanted: FieldSelection, path: str
    ) -> None:
        start = self.place
        for index, part in wanted.elements:
            self.read_gathered()
            self.default(part)
            with self._writer.indented(f"if {count} > {index}:"):
                self.place = start.plus(index * stride)
                self._single(element, part, False, f"{path}[{index}]")
                self.read_gathered()

    def _numbers(self, element: FieldType, count: str, wanted: FieldSelection) -> None:
        letter, size = FORMATS[str(element.base)]
        if wanted.name is not None and letter == "?":
            value = f"struct.unpack_from(f'{{{count}}}?', data, {self.place.text()})"
            self._writer.line(f"{wanted.name} = {value}")
        elif wanted.name is not None:
            self.view(letter, count, wanted.name)
        for index, part in wanted.elements:
            value = f"{self.one(letter, index * size)} if {count} > {index} else {self.nan()}"
            self._writer.line(f"{part.name} = {value}")

    # Elements whose places depend on those before them ------------------------------------------

    def _strings(
        self, element: FieldType, count: str | int, wanted: FieldSelection, path: str
    ) -> None:
        base = str(element.base)
        self.settle(f"to {path}[0]")
        self._writer.line(f"{wanted.name} = []")
        with self._writer.indented(f"for _ in range({count}):"):
            self.place = moved(1)
            self.align(4, "")
            self._writer.line(f"{wanted.name}.append({self._text(base)})")
            self._skip(_CHARACTERS[base], "")
        self.place = moved(1)
        for index, part in wanted.elements:
            value = f"{wanted.name}[{index}]"
            if isinstance(count, str):
                value += f" if {count} > {index} else {self.nan()}"
            self._writer.line(f"{part.name} = {value}")

    def _elements(
        self, element: FieldType, count: str | int, wanted: FieldSelection, later: bool, path: str
    ) -> None:
        """Go from element to element, into those of which something is wanted."""
        done, parts = 0, wanted.elements
        for number, (index, part) in enumerate(parts):
            more = later or number < len(parts) - 1
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
        if later and done != count:
            self._rest(element, count, done, path)

    def _element(
        self, element: FieldType, part: FieldSelection, more: bool, condition: str, path: str
    ) -> None:
        self.settle("")
        self.default(part)
        before = self.place
        with self._writer.indented(f"if {condition}:"):
            self._single(element, part, more, path)
            self.read_gathered()
            if more:
                self.settle(f"past {path}")
        self.place = before.meet(self.place) if more else before

    def _loop(self, element: FieldType, times: str, path: str) -> None:
        """Pass over elements one by one."""
        self.settle("")
        entry = self.place
        while True:  # what is known of the place must hold at each turn
            trial = self._trial(entry)
            trial._single(element, NOTHING, True, "")
            meet = entry.meet(trial.place.base())
            if meet == entry:
                break
            entry = meet
        with self._writer.indented(
            f"for _ in range({times}):", path and f"past elements of {path}"
        ):
            self.place = entry
            self._single(element, NOTHING, True, "")
            self.settle("")
        self.place = entry

    def _rest(self, element: FieldType, count: str | int, done: int, path: str) -> None:
        """Pass over all elements from one on."""
        trial = self._trial(self.place)
        trial._single(element, NOTHING, True, "")
        if trial._writer.has_lengths:
            self._loop(element, _less(count, done), path)
            return
        # From the second element on, the alignment does not depend on the data: no loop is needed.
        if isinstance(count, int):
            self._single(element, NOTHING, True, f"{path}[{done}]")
            self.place = self.place.plus(self._distance(element) * (count - done - 1))
            return
        self.settle("")
        before = self.place
        with self._writer.indented(f"if {count} > {done}:" if done else f"if {count}:"):
            self._single(element, NOTHING, True, f"{path}[{done}]")
            distance = self._distance(element)
            known = math.gcd(self.place.alignment(), distance)
            self.advance(f"{distance} * ({count} - {done + 1})", path and f"past {path}")
        self.place = before.meet(moved(known))

    def _distance(self, element: FieldType) -> int:
        """Return the size of the element that begins here, which is that of all behind it."""
        trial = self._trial(self.place)
        trial._single(element, NOTHING, True, "")
        assert not self._wrote(trial)
        return trial.place.offset - self.place.offset

    # Trials -------------------------------------------------------------------------------------

    def _trial(self, place: Position) -> DecoderEmitter:
        """Return a walk from ``place`` on whose lines count for nothing."""
        return DecoderEmitter(self._store, Writer(UniqueNames(), Parts(), "", UniqueNames()), place)

    @staticmethod
    def _wrote(trial: DecoderEmitter) -> bool:
        return bool(trial._writer.lines)


_CHARACTERS = {"string": 1, "wstring": 4}
"""The bytes that each unit of a string's length stands for."""


def _less(count: str | int, done: int) -> str:
    if isinstance(count, int):
        return str(count - done)
    return f"{count} - {done}" if done else count
