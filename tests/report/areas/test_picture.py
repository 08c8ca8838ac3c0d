"""Pictures of zones: to scale, the right way round, the same each time, and harmless."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from xml.etree import ElementTree as Xml

import pytest
from playwright.sync_api import Browser

from deros.report.areas.picture import as_html, as_svg
from deros.report.areas.plans import Area, Plan, Scanner
from deros.rules.program.zones import Circle, Polygon, Rectangle
from tests.support.browser import PICTURES, browser
from tests.support.needs import needs

FRONT = Area("front", Rectangle((0.5, -0.5), (2.5, 0.5)), "rectangle", "until it stands", ("e.r",))
AROUND = Area("around", Circle((0.0, 0.0), 0.5), "circle (0, 0) 0.5 m", "", ("e.r", "e.s"))
NOTCHED = Polygon(((0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (2.5, 1.5), (0.0, 3.0)))
ROBOT = Plan("On the robot", False, [FRONT, AROUND], [Scanner("scan", 0.4, 0.1, 0.5)])
MAP = Plan("Where place is", True, [Area("yard", NOTCHED, "polygon", "", ("e.left",))])
OUTLINE = Area("outline", Circle((0.0, 0.0), 0.25), "circle (0, 0) 25 cm")


def parts(svg: str, kind: str) -> dict[str, Xml.Element]:
    """Return the zones or scanners of a picture, by name."""
    root = Xml.fromstring(svg)
    return {name: each for each in root.iter() if (name := each.get(f"data-{kind}")) is not None}


def places(zone: Xml.Element) -> list[tuple[float, float]]:
    """Return the corners of a zone in the picture."""
    pairs = (pair.split(",") for pair in zone.attrib["points"].split())
    return [(float(x), float(y)) for x, y in pairs]


def test_zones_are_to_scale() -> None:
    """All of a plan have one scale: 2 m are twice as long as 1 m, and a radius is its length."""
    drawn = parts(as_svg("r", [ROBOT]), "zone")
    xs, ys = zip(*places(drawn["front"]), strict=True)
    wide, long = max(xs) - min(xs), max(ys) - min(ys)
    assert long == pytest.approx(2.0 * wide, abs=0.05)
    assert float(drawn["around"].attrib["r"]) == pytest.approx(wide / 2.0, abs=0.05)


def test_forward_is_up_on_the_robot_and_x_is_right_on_a_map() -> None:
    """Left of the robot is left; the second corner of the yard is on its right, the last above."""
    drawn = parts(as_svg("r", [ROBOT, MAP]), "zone")
    centre = float(drawn["around"].attrib["cy"])
    assert max(y for _, y in places(drawn["front"])) == pytest.approx(
        centre - float(drawn["around"].attrib["r"]), abs=0.05
    )
    origin, right, *_, above = places(drawn["yard"])
    assert right[1] == origin[1]
    assert right[0] > origin[0]
    assert above[0] == origin[0]
    assert above[1] < origin[1]


def test_scanners_are_turned_counter_clockwise() -> None:
    """In a picture, whose y goes down, that is a negative angle; a scanner on the left is left."""
    svg = as_svg("r", [ROBOT])
    (triangle,) = parts(svg, "scanner")["scan"].findall("{*}polygon")
    turned = re.match(r"rotate\((\S+) (\S+) (\S+)\)", triangle.attrib["transform"])
    assert turned is not None
    assert float(turned[1]) == pytest.approx(-28.65, abs=0.01)
    assert float(turned[2]) < float(parts(svg, "zone")["around"].attrib["cx"])


def test_the_outline_is_drawn_on_the_robot_alone() -> None:
    """Not on a map, on which the robot is anywhere."""
    assert as_svg("r", [ROBOT, MAP], OUTLINE).count('class="outline"') == 1
    assert 'class="outline"' not in as_svg("r", [MAP], OUTLINE)
    assert "dashed: the robot, circle (0, 0) 25 cm" in as_svg("r", [ROBOT], OUTLINE)


def test_pictures_tell_what_zones_are_and_who_asks() -> None:
    """In words below each plan."""
    text = as_svg("r", [ROBOT])
    assert "front: rectangle, until it stands (e.r)" in text
    assert "around: circle (0, 0) 0.5 m (e.r, e.s)" in text
    assert "scan: at (0.4, 0.1) m, yaw 28.6°" in text
    assert text == as_svg("r", [ROBOT])


def test_texts_of_rules_stay_texts() -> None:
    """A description cannot become a part of the picture."""
    evil = Area("front", AROUND.shape, "circle", "</text><script>alert(1)</script>", ("e.r",))
    page = as_html("</title><script>", [Plan("<b>", False, [evil])])
    assert "<script" not in page
    assert "<b>" not in page


@pytest.fixture(scope="module")
def chromium() -> Iterator[Browser]:
    """Start a browser."""
    with browser() as program:
        yield program


@needs("chromium")
@pytest.mark.slow
def test_pictures_are_seen_in_a_browser(chromium: Browser, tmp_path: Path) -> None:
    """What it lays out is to scale, within the page, and no name is where its zone is not."""
    file = tmp_path / "zones.html"
    file.write_text(as_html("robot", [ROBOT, MAP], OUTLINE), encoding="utf-8")
    page = chromium.new_page(viewport={"width": 800, "height": 1600})
    page.goto(file.as_uri())
    PICTURES.mkdir(parents=True, exist_ok=True)
    page.screenshot(path=PICTURES / "zones.png", full_page=True)
    boxes = {}
    for name in ("front", "around", "yard"):
        boxes[name] = page.locator(f"[data-zone={name}]").evaluate(
            "each => { const b = each.getBBox(); return [b.x, b.y, b.width, b.height]; }"
        )
        label = page.get_by_text(name, exact=True).bounding_box()
        zone = page.locator(f"[data-zone={name}]").bounding_box()
        assert label is not None
        assert zone is not None
        middle = label["x"] + label["width"] / 2.0, label["y"] + label["height"] / 2.0
        assert zone["x"] < middle[0] < zone["x"] + zone["width"]
        assert zone["y"] < middle[1] < zone["y"] + zone["height"]
    assert boxes["front"][3] == pytest.approx(2.0 * boxes["front"][2], rel=0.01)
    assert boxes["around"][2] == pytest.approx(boxes["front"][2], rel=0.01)
    assert boxes["yard"][2] / boxes["yard"][3] == pytest.approx(4.0 / 3.0, rel=0.01)
    wide = page.evaluate("document.documentElement.scrollWidth")
    assert wide <= 800
    for text in page.locator("svg text").all():
        box = text.bounding_box()
        assert box is not None
        assert box["x"] >= 0.0
        assert box["x"] + box["width"] <= 800.0
