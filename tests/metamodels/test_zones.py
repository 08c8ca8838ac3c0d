"""Zones: from source text to syntax tree."""

from __future__ import annotations

from decimal import Decimal

from deros.metamodels.load import Repository
from deros.models.rules import Circle, Mounting, Polygon, Rectangle, Rules, Zone


def _zones(text: str) -> tuple[Zone, ...]:
    loaded = Repository().load_text("a.deros", text)
    assert loaded.diagnostics == ()
    assert isinstance(loaded.model, Rules)
    return loaded.model.zones


def test_shapes_are_read() -> None:
    """Coordinates stay exact, over several lines and with comments between them, too."""
    polygon, circle, rectangle = _zones(
        'zone yard = polygon (0, 0) (+4.0, 0)  // the gate\n  (4, -.5e1) cm "drives here";\n'
        "zone pond = circle (1, -1.5) 0.1 km zone dock = rectangle (3, 0)(4, 1) m"
    )
    assert isinstance(polygon.shape, Polygon)
    places = [(each.x, each.y) for each in polygon.shape.corners]
    assert places == [(0, 0), (Decimal("4.0"), 0), (4, Decimal(-5))]
    assert (polygon.unit, polygon.description) == ("cm", "drives here")
    assert isinstance(circle.shape, Circle)
    assert circle.shape.radius == Decimal("0.1")
    assert circle.shape.radius_span.text == "0.1"
    assert (circle.name.text, circle.unit) == ("pond", "km")
    assert isinstance(rectangle.shape, Rectangle)
    assert rectangle.shape_span.text == "rectangle (3, 0)(4, 1)"
    assert rectangle.shape.opposite.span.text == "(4, 1)"


def test_what_is_missing_is_for_the_compiler_to_say() -> None:
    """Without a unit, and with a condition, it is read: the compiler has better words."""
    (bare,) = _zones("zone a = circle (0, 0) 1\nconst speed = 1")
    assert (bare.unit, bare.unit_span) == (None, None)
    (dependent,) = _zones("zone a = circle (0, 0) 1 m when drive.fast and drive.far")
    assert dependent.when_span is not None
    assert dependent.when_span.text == "when drive.fast and drive.far"


def test_the_words_of_zones_name_other_things_too() -> None:
    """Programs that have an input or a rule of that name go on to be read."""
    loaded = Repository().load_text(
        "a.deros",
        "input zone = topic /a\ninput circle = topic /b\n"
        "entity polygon { rectangle: zone > 1 and circle.missing(); when: zone.inside(zone); }",
    )
    assert loaded.diagnostics == ()


def _mounting(text: str) -> Mounting:
    loaded = Repository().load_text("a.deros", f"input scan = topic /scan {text}")
    assert isinstance(loaded.model, Rules)
    assert loaded.diagnostics == ()
    (found,) = loaded.model.inputs
    assert found.mounting is not None
    return found.mounting


def test_mountings_are_read_as_written() -> None:
    """Height and angle may be absent, and what follows is another option."""
    full = _mounting("mounted (0.25, -.5, 1e-1) cm yaw -90 deg timeout 1 sec")
    assert (full.x, full.y, full.z) == (Decimal("0.25"), Decimal("-0.5"), Decimal("0.1"))
    assert full.unit == "cm"
    assert full.yaw is not None
    assert (full.yaw.value, full.yaw.unit) == (Decimal(-90), "deg")
    assert full.place_span.text == "(0.25, -.5, 1e-1)"
    flat = _mounting("timeout 1 sec mounted (1, 2) m publishers any")
    assert (flat.z, flat.yaw, flat.span.text) == (None, None, "mounted (1, 2) m")
    bare = _mounting("mounted (1, 2, 3) yaw 1 rad")
    assert (bare.unit, bare.unit_span) == (None, None)
    described = _mounting('mounted as "laser_link" in "robot.urdf" timeout 1 sec')
    assert described.described_span is not None
    assert described.described_span.text == 'as "laser_link" in "robot.urdf"'


def test_the_words_of_mountings_name_other_things_too() -> None:
    """An input may be called so, and a rule, and a function is."""
    loaded = Repository().load_text(
        "a.deros",
        "input mounted = topic /a mounted (0, 0) m yaw 1 rad\ninput yaw = topic /b\n"
        "entity e { mounted: mounted.points_in(yaw) > 1 and yaw > 1; yaw: yaw.yaw() > 1; }",
    )
    assert loaded.diagnostics == ()
