"""From the textX objects of zones, and of where sensors are, to their models."""

from __future__ import annotations

from collections.abc import Callable
from decimal import Decimal
from typing import Any

from deros.metamodels.converters.convert import Converter
from deros.models.rules import Circle, Mounting, Number, Point, Polygon, Rectangle, Zone, ZoneShape


def convert_zone(converter: Converter, found: Any) -> Zone:
    """Return a zone as written; what is wrong with it is for the compiler to say."""
    return Zone(
        converter.name(found.name),
        _shape(converter, found.shape),
        converter.unit(found.unit),
        converter.span(found),
        converter.span(found.shape),
        None if found.unit is None else converter.token_span(found.unit),
        converter.text(found.description),
        None if found.when is None else converter.span(found.when),
    )


def convert_mounting(converter: Converter, found: Any, number: Callable[[Any], Number]) -> Mounting:
    """Return a mounting as written; ``number`` converts a number with its unit."""
    whole = converter.span(found)
    at = found.at
    if at is None:
        place = converter.span(found.described)
        return Mounting(Decimal(0), Decimal(0), None, None, None, whole, place, None, place)
    place = at.place
    return Mounting(
        converter.decimal(place.x),
        converter.decimal(place.y),
        None if place.z is None else converter.decimal(place.z),
        converter.unit(at.unit),
        None if at.yaw is None else number(at.yaw),
        whole,
        converter.span(place),
        None if at.unit is None else converter.token_span(at.unit),
    )


def _shape(converter: Converter, found: Any) -> ZoneShape:
    match type(found).__name__:
        case "Polygon":
            return Polygon(tuple(_point(converter, each) for each in found.corners))
        case "Circle":
            radius = converter.decimal(found.radius)
            return Circle(
                _point(converter, found.centre), radius, converter.token_span(found.radius)
            )
    return Rectangle(_point(converter, found.corner), _point(converter, found.opposite))


def _point(converter: Converter, found: Any) -> Point:
    x, y = converter.decimal(found.x), converter.decimal(found.y)
    return Point(x, y, converter.span(found))
