"""Zones: areas of the plane, and the formula that says whether a point is in one.

A point on the edge is inside. What a zone is, is written once, as a formula of the point's ``x``
and ``y``, which the reference engine interprets and the targets print; so they agree in every bit.
Coordinates are doubles in the unit of the point's fields. The formula is 1 inside, 0 outside, and
unknown where a coordinate is; a point at an infinite distance is outside.

A polygon is made up of convex parts, whose edges include the diagonals between them. A point is in
a part if it is not to the right of any of its edges, going round counter-clockwise. The side of an
edge that is not along an axis is the sign of a cross product, computed with doubles: it is exact at
both of its corners, and rounded between them. A diagonal is computed once, so that no point is
between the parts. A corner on the line of another edge, where rounding puts it outside, is named.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import pairwise

from deros.diagnostics import Span
from deros.rules.program.formulas import (
    UNKNOWN,
    Binary,
    Call,
    Choice,
    Comparison,
    Expression,
    Formula,
    Logical,
    Name,
    Negation,
    Number,
    Relation,
    evaluate,
)
from deros.rules.program.polygons import convex_parts

Place = tuple[float, float]
"""``x`` and ``y`` in the unit of the point's fields."""


@dataclass(frozen=True, slots=True)
class Polygon:
    """The area between edges that do not meet; it is on either side of the way round."""

    corners: tuple[Place, ...]


@dataclass(frozen=True, slots=True)
class Circle:
    """The points that are no farther from the centre than the radius."""

    centre: Place
    radius: float


@dataclass(frozen=True, slots=True)
class Rectangle:
    """The points between two corners, of which the first has the least coordinates."""

    least: Place
    greatest: Place


Shape = Polygon | Circle | Rectangle


@dataclass(frozen=True, slots=True)
class Zone:
    """A zone as it is held against the points of one field.

    Attributes:
        name: as declared.
        shape: in ``unit``, rounded as the point's fields are.
        unit: of the point's fields.
        description: as declared.
        span: of the declaration.
    """

    name: str
    shape: Shape
    unit: str
    description: str = field(default="", compare=False, repr=False)
    span: Span | None = field(default=None, compare=False, repr=False)


X, Y = Name("x1"), Name("x2")
"""The coordinates of the point, as the names of a :class:`~deros.rules.program.ir.Compute`."""


def zone_formula(shape: Shape) -> Formula:
    """Return the formula of :data:`X` and :data:`Y` that is 1 inside of a shape and 0 outside.

    Raises:
        ValueError: a polygon has no area, or edges that meet.
    """
    is_unknown = Logical("or", tuple(Negation(Call("known", (each,))) for each in (X, Y)))
    named: dict[str, Expression] = {}
    inside = Choice(is_inside(shape, named), Number(1.0), Number(0.0))
    return Formula(tuple(named.items()), Choice(is_unknown, UNKNOWN, inside))


def is_inside(shape: Shape, named: dict[str, Expression]) -> Expression:
    """Return the condition that :data:`X` and :data:`Y` are inside of a shape.

    What it names is put into ``named``.

    Raises:
        ValueError: a polygon has no area, or edges that meet.
    """
    match shape:
        case Rectangle(least=(left, bottom), greatest=(right, top)):
            return _all(
                (
                    Relation(">=", X, Number(left)),
                    Relation("<=", X, Number(right)),
                    Relation(">=", Y, Number(bottom)),
                    Relation("<=", Y, Number(top)),
                )
            )
        case Circle(centre=centre, radius=radius):
            x, y = Name("from_x"), Name("from_y")
            named.update({x.name: _minus(X, centre[0]), y.name: _minus(Y, centre[1])})
            square = Binary("+", Binary("*", x, x), Binary("*", y, y))
            return Relation("<=", square, Number(radius * radius))
        case Polygon(corners=corners):
            exact = [(Fraction(x), Fraction(y)) for x, y in corners]
            sides: dict[str, Expression] = {}
            parts = [_is_in_part(corners, part, sides) for part in convex_parts(exact)]
            value = Formula(tuple(sides.items()), Choice(_any(parts), Number(1.0), Number(0.0)))
            outside = [c for c in corners if not evaluate(value, {X.name: c[0], Y.name: c[1]})]
            named.update(sides)
            return _any((*parts, *(is_inside(Rectangle(each, each), named) for each in outside)))


def _is_in_part(
    corners: tuple[Place, ...], part: tuple[int, ...], named: dict[str, Expression]
) -> Expression:
    edges = pairwise((*part, part[0]))
    return _all(_is_not_right_of(corners, start, end, named) for start, end in edges)


def _is_not_right_of(
    corners: tuple[Place, ...], start: int, end: int, named: dict[str, Expression]
) -> Expression:
    """Return the condition that a point is to the left of an edge, or on its line.

    An edge and the one back have the same cross product, compared with 0 in opposite ways.
    """
    first, last = min(start, end), max(start, end)
    (x, y), (other_x, other_y) = corners[first], corners[last]
    along_x, along_y = other_x - x, other_y - y
    word: Comparison = ">=" if start < end else "<="
    back: Comparison = "<=" if start < end else ">="
    if along_y == 0.0:
        return Relation(word if along_x > 0.0 else back, Y, Number(y))
    if along_x == 0.0:
        return Relation(back if along_y > 0.0 else word, X, Number(x))
    # With corners numbered from 1, as in messages.
    side = Name(f"side_{first + 1}_{last + 1}")
    named[side.name] = Binary(
        "-" if along_y > 0.0 else "+",  # the same in every bit, without a minus twice
        Binary("*", Number(along_x), _minus(Y, y)),
        Binary("*", Number(abs(along_y)), _minus(X, x)),
    )
    return Relation(word, side, Number(0.0))


def _minus(value: Name, number: float) -> Expression:
    """Return a difference that is written without a zero or a double sign."""
    if number == 0.0:
        return value
    if number < 0.0:
        return Binary("+", value, Number(-number))
    return Binary("-", value, Number(number))


def _any(conditions: Sequence[Expression]) -> Expression:
    return conditions[0] if len(conditions) == 1 else Logical("or", tuple(conditions))


def _all(conditions: Iterable[Expression]) -> Expression:
    """Return the conjunction of conditions, each once: edges may be on the same line."""
    unique = tuple(dict.fromkeys(conditions))
    return unique[0] if len(unique) == 1 else Logical("and", unique)
