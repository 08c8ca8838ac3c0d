"""The steps of a decoder: align, advance, and read collected fields."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby

from deros.generators.decoder.python.field_selection import FieldSelection
from deros.generators.decoder.python.position import ENCAPSULATION, Position, moved
from deros.generators.decoder.python.writer import Writer
from deros.generators.text.document import HARDLINE, breakable, join


@dataclass(frozen=True, slots=True)
class _Read:
    """A field to be read: its position, its format, and its variable."""

    offset: int
    letters: str
    size: int
    name: str
    path: str

    @property
    def is_tuple(self) -> bool:
        return len(self.letters) > 1


def _letters(run: Sequence[_Read]) -> str:
    """Return the format string of the struct module: ``4d72x3d``, with gaps as ``x``."""
    items: list[str] = []
    end = run[0].offset
    for read in run:
        items += ["x"] * (read.offset - end) + [read.letters]
        end = read.offset + read.size
    repeats = ((letter, len(list(group))) for letter, group in groupby(items))
    return "".join(f"{n}{letter}" if n > 1 else letter for letter, n in repeats)


class Steps:
    """Tracks the current position and collects fields at constant distances from its base."""

    def __init__(self, writer: Writer, position: Position) -> None:
        """Start at ``position``."""
        self.position = position
        self._writer = writer
        self._gathered: list[_Read] = []
        self._defaulted: set[str] = set()

    def align(self, alignment: int, path: str) -> None:
        """Advance to the next multiple of ``alignment``, relative to the first field."""
        aligned = self.position.aligned(alignment)
        if aligned is None:
            self.read_gathered()
            # The first field follows the encapsulation header, so its offset is 4 modulo 8.
            ahead = (ENCAPSULATION - self.position.offset) % alignment
            padding = f"({ahead} - at) % {alignment}" if ahead else f"-at % {alignment}"
            self._move(padding, 0, path and f"to {path}, a multiple of {alignment}")
            aligned = moved(alignment)
        self.position = aligned

    def advance(self, distance: str, comment: str, more: int = 0) -> None:
        """Advance ``at`` by an expression; the caller sets the position afterwards."""
        self.read_gathered()
        self._move(distance, more, comment)

    def settle(self, comment: str) -> None:
        """Set ``at`` to the current position."""
        self.read_gathered()
        if not self.position.moving or self.position.offset:
            self._move("", 0, comment)
        self.position = self.position.base()

    def _move(self, distance: str, more: int, comment: str) -> None:
        offset = self.position.offset + more
        terms = [str(offset)] if offset else []
        terms += [distance] if distance else []
        self._writer.line(
            f"at {'+=' if self.position.moving else '='} {' + '.join(terms)}", comment
        )

    # Values -------------------------------------------------------------------------------------

    def gather(self, letters: str, size: int, name: str, path: str) -> None:
        """Collect the field at the current position, to be read together with others near it."""
        self._gathered.append(_Read(self.position.offset, letters, size, name, path))

    def read_gathered(self) -> None:
        """Write the lines that read the collected fields."""
        gathered = sorted(self._gathered, key=lambda read: read.offset)
        for read in gathered:
            if read.is_tuple:
                self._read([read])
        if scalars := [read for read in gathered if not read.is_tuple]:
            self._read(scalars)
        self._gathered = []

    def _read(self, run: list[_Read]) -> None:
        offset = Position(self.position.moving, run[0].offset, 1, 0).text()
        if len(run) == 1 and not run[0].is_tuple:
            reader = self._writer.parts.reader(run[0].letters)
            self._writer.line(f"{run[0].name} = {reader}[order](data, {offset})[0]")
            return
        reader = self._writer.group(_letters(run), [read.path for read in run])
        self._writer.assign([read.name for read in run], f"{reader}[order](data, {offset})")

    def one(self, letter: str, more: int = 0) -> str:
        """Return the expression for a primitive ``more`` bytes after the current position."""
        return f"{self._writer.parts.reader(letter)}[order](data, {self.position.text(more)})[0]"

    def view(self, letter: str, count: str, name: str) -> None:
        """Write the line that creates a NumPy view of numbers in the data."""
        dtype = self._writer.parts.dtype(letter)
        offset = self.position.text()
        self._writer.line(f"{name} = np.frombuffer(data, {dtype}[order], {count}, {offset})")

    def nan(self) -> str:
        """Return the constant for the value of a missing element."""
        return self._writer.parts.helper("NAN")

    def default(self, part: FieldSelection) -> None:
        """Set all values of an element that may be missing to NaN."""
        names = [name for name in part.names() if name not in self._defaulted]
        self._defaulted.update(names)
        if names:
            nan = self.nan()
            each_alone = join(HARDLINE, (f"{name} = {nan}" for name in names))
            together = " = ".join([*names, nan])
            self._writer.add(breakable(together, lambda _: each_alone))
