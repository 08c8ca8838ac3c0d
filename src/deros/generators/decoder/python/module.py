"""The parts that the decoders of a module share: byte orders, helpers, and readers of groups."""

from __future__ import annotations

from dataclasses import dataclass, field

from deros.generators.text.document import render_lines
from deros.generators.text.prose import paragraph
from deros.generators.text.python import LINE_LENGTH
from deros.interfaces.types import FieldType

FORMATS: dict[str, tuple[str, int]] = {
    "bool": ("?", 1),
    "byte": ("B", 1),
    "char": ("B", 1),
    "int8": ("b", 1),
    "uint8": ("B", 1),
    "int16": ("h", 2),
    "uint16": ("H", 2),
    "int32": ("i", 4),
    "uint32": ("I", 4),
    "int64": ("q", 8),
    "uint64": ("Q", 8),
    "float32": ("f", 4),
    "float64": ("d", 8),
}
"""The format character in the :mod:`struct` module, and the size, of each fixed-size primitive."""

_SMALL = 64
"""The largest length of an array of constant length that is returned as a tuple."""

_DTYPES = {"B": "u1", "b": "i1", "h": "i2", "H": "u2", "i": "i4", "I": "u4"} | {
    "q": "i8",
    "Q": "u8",
    "f": "f4",
    "d": "f8",
}
_SHARED = {
    letter: base.upper() for base, (letter, _) in FORMATS.items() if base not in ("byte", "char")
}


@dataclass(slots=True)
class Parts:
    """The parts of a module that its decoders use.

    Attributes:
        shared: the values of constants for all decoders, by name.
        helpers: the names of the used functions and constants of the template.
    """

    shared: dict[str, str] = field(default_factory=dict)
    helpers: set[str] = field(default_factory=set)

    def reader(self, letter: str) -> str:
        """Return the constant that reads one primitive."""
        name = _SHARED[letter]
        self.shared[name] = f"both('{letter}')"
        self.helpers.add("both")
        return name

    def dtype(self, letter: str) -> str:
        """Return the constant that holds the NumPy types of a primitive."""
        name = f"{_SHARED[letter]}_ARRAY"
        dtype = _DTYPES[letter]
        self.shared[name] = f"np.dtype('>{dtype}'), np.dtype('<{dtype}')"
        self.helpers.add("np")
        return name

    def helper(self, name: str) -> str:
        """Record that a helper of the template is used, and return its name."""
        self.helpers.add(name)
        if name in ("string", "wstring"):
            self.reader("I")
        if name == "find":
            self.helpers.add("NAN")
        return name


def is_view(type_: FieldType) -> bool:
    """Return whether the value of an array is a NumPy view of its numbers."""
    if type_.base not in FORMATS or type_.base == "bool":
        return False
    return type_.is_array and (type_.array != "fixed" or (type_.size or 0) > _SMALL)


def group_lines(name: str, letters: str, fields: list[str]) -> list[str]:
    """Return the lines of the constant that reads a group of fields, with a comment on them."""
    comment = render_lines(paragraph(", ".join(fields), "# ", "#   "), LINE_LENGTH)
    return [*comment, f"{name} = both('{letters}')"]
