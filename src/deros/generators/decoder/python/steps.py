"""The single steps of a walk: to align, to go on, to read what has been gathered."""

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
    """A field that is to be read: where, as what, and into which variable."""

    offset: int
    letters: str
    size: int
    name: str
    path: str

    @property
    def is_tuple(self) -> bool:
        return len(self.letters) > 1


def _letters(run: Sequence[_Read]) -> str:
    """Return what the struct module calls a format: ``4d72x3d``, with gaps as ``x``."""
    items: list[str] = []
    end = run[0].offset
    for read in run:
        items += ["x"] * (read.offset - end) + [read.letters]
        end = read.offset + read.size
    repeats = ((letter, len(list(group))) for letter, group in groupby(items))
    return "".join(f"{n}{letter}" if n > 1 else letter for letter, n in repeats)


class Steps:
    """Keeps the present place, and the fields to be read at constant distances from its base."""

    def __init__(self, writer: Writer, place: Position) -> None:
        """Begin at ``place``."""
        self.place = place
        self._writer = writer
        self._gathered: list[_Read] = []
        self._defaulted: set[str] = set()

    def align(self, alignment: int, path: str) -> None:
        """Go on to the next multiple of ``alignment``, counted from the first field."""
        aligned = self.place.aligned(alignment)
        if aligned is None:
            self.read_gathered()
            # The first field stands behind the encapsulation, hence at 4 modulo 8.
            ahead = (ENCAPSULATION - self.place.offset) % alignment
            padding = f"({ahead} - at) % {alignment}" if ahead else f"-at % {alignment}"
            self._move(padding, 0, path and f"to {path}, a multiple of {alignment}")
            aligned = moved(alignment)
        self.place = aligned

    def advance(self, distance: str, comment: str, more: int = 0) -> None:
        """Move ``at`` by an expression; what is then known of the place is for the caller."""
        self.read_gathered()
        self._move(distance, more, comment)

    def settle(self, comment: str) -> None:
        """Make ``at`` stand for the present place."""
        self.read_gathered()
        if not self.place.moving or self.place.offset:
            self._move("", 0, comment)
        self.place = self.place.base()

    def _move(self, distance: str, more: int, comment: str) -> None:
        offset = self.place.offset + more
        terms = [str(offset)] if offset else []
        terms += [distance] if distance else []
        self._writer.line(f"at {'+=' if self.place.moving else '='} {' + '.join(terms)}", comment)

    # Values -------------------------------------------------------------------------------------

    def gather(self, letters: str, size: int, name: str, path: str) -> None:
        """Have the field at the present place read, together with others near it."""
        self._gathered.append(_Read(self.place.offset, letters, size, name, path))

    def read_gathered(self) -> None:
        """Write the lines that read what has been gathered."""
        gathered = sorted(self._gathered, key=lambda each: each.offset)
        for read in gathered:
            if read.is_tuple:
                self._read([read])
        if scalars := [read for read in gathered if not read.is_tuple]:
            self._read(scalars)
        self._gathered = []

    def _read(self, run: list[_Read]) -> None:
        place = Position(self.place.moving, run[0].offset, 1, 0).text()
        if len(run) == 1 and not run[0].is_tuple:
            reader = self._writer.parts.reader(run[0].letters)
            self._writer.line(f"{run[0].name} = {reader}[order](data, {place})[0]")
            return
        reader = self._writer.group(_letters(run), [read.path for read in run])
        self._writer.assign([read.name for read in run], f"{reader}[order](data, {place})")

    def one(self, letter: str, more: int = 0) -> str:
        """Return the expression that reads one primitive at the present place, or behind it."""
        return f"{self._writer.parts.reader(letter)}[order](data, {self.place.text(more)})[0]"

    def view(self, letter: str, count: str, name: str) -> None:
        """Write the line that looks at numbers in the data as an array."""
        dtype = self._writer.parts.dtype(letter)
        place = self.place.text()
        self._writer.line(f"{name} = np.frombuffer(data, {dtype}[order], {count}, {place})")

    def nan(self) -> str:
        """Return the name of the value of an element that is not there."""
        return self._writer.parts.helper("NAN")

    def default(self, part: FieldSelection) -> None:
        """Set all values of an element that may not be there to NaN."""
        names = [name for name in part.names() if name not in self._defaulted]
        self._defaulted.update(names)
        if names:
            nan = self.nan()
            each_alone = join(HARDLINE, (f"{name} = {nan}" for name in names))
            together = " = ".join([*names, nan])
            self._writer.add(breakable(together, lambda _: each_alone))
