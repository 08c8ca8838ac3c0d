"""Zones of random programs, and places of their points: on corners, edges and beside them."""

from __future__ import annotations

import math

from deros.rules.program import ir
from deros.rules.program.zones import Circle, Polygon, Rectangle, zone_formula

ZONES = (
    ir.Zone("box", Rectangle((-1.0, 0.0), (2.0, 1.5)), "m"),
    ir.Zone("pond", Circle((0.5, 0.0), 0.5), "m"),
    ir.Zone("wedge", Polygon(((0.0, 0.0), (1.0, 3.0), (-1.0, 3.0))), "m"),
    ir.Zone("notched", Polygon(((0.0, 0.0), (3.0, 0.0), (3.0, 3.0), (1.5, 0.5), (0.0, 3.0))), "m"),
    ir.Zone(
        "stairs",
        Polygon(((0.0, 0.0), (0.0, 2.0), (1.0, 2.0), (1.0, 1.0), (2.0, 1.0), (2.0, 0.0))),
        "m",
    ),
    # Three corners on one line: rounding puts (3, 1.5) to the right of the edge before.
    ir.Zone("halved", Polygon(((1.2, 0.3), (2.1, 0.9), (3.0, 1.5), (0.0, 3.0))), "m"),
)
"""Of each shape: convex and not, in both directions, with and without slanting edges."""

PLACES = (
    *(-1.0, -0.0, 0.0, 0.1, 1.0 / 3.0, 0.5, 1.0, 1.5, 2.0, 3.0, 3.0, math.nextafter(3.0, 4.0)),
    *(math.nan, math.inf, -math.inf),
)
"""Coordinates of points."""


def inside(zone: ir.Zone, x: ir.Read, y: ir.Read, wording: str) -> ir.Compare:
    """Return the condition that a point is in a zone, as the compiler builds it."""
    computed = ir.Compute(zone_formula(zone.shape), (x, y), wording, zone)
    return ir.Compare(computed, ">", ir.Const(0.0))


def zone_text(zone: ir.Zone) -> str:
    """Return the declaration of a zone."""
    match zone.shape:
        case Polygon(corners=corners):
            shape = f"polygon {' '.join(map(str, corners))}"
        case Circle(centre=centre, radius=radius):
            shape = f"circle {centre} {radius}"
        case Rectangle(least=least, greatest=greatest):
            shape = f"rectangle {greatest} {least}"
    return f"zone {zone.name} = {shape} {zone.unit}"
