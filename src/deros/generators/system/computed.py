"""Values and texts of a view that are computed when the system is started."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from deros.models.arguments import Expression, arguments_in
from deros.models.common import Scalar, Value
from deros.models.node import ParameterType


@dataclass(frozen=True, slots=True)
class Computed:
    """A value or a text that is computed when the system is started.

    Attributes:
        pieces: one expression, or the pieces of a text.
        type: of the value; of texts, ``STRING``.
    """

    pieces: tuple[str | Expression, ...]
    type: ParameterType = ParameterType.STRING


Text = str | Computed
Variables = tuple[tuple[str, Text], ...]
Setting = Value | Computed | tuple[Scalar | Computed, ...]


def joined(*texts: Text) -> Text:
    """Return texts one behind the other."""
    if all(isinstance(each, str) for each in texts):
        return "".join(map(str, texts))
    pieces = ((each,) if isinstance(each, str) else each.pieces for each in texts)
    return Computed(tuple(each for found in pieces for each in found if each != ""))


def arguments_of(names: Iterable[Text]) -> set[str]:
    """Return the arguments that some names are made of."""
    return {
        use.name
        for name in names
        if isinstance(name, Computed)
        for piece in name.pieces
        if not isinstance(piece, str)
        for use in arguments_in(piece)
    }


def plain_settings(settings: Iterable[tuple[str, Setting]]) -> Iterator[tuple[str, Value]]:
    """Yield the values of parameters for which nothing is computed."""
    for name, value in settings:
        assert not isinstance(value, Computed)
        if isinstance(value, tuple):
            yield name, tuple(each for each in value if not isinstance(each, Computed))
        else:
            yield name, value
