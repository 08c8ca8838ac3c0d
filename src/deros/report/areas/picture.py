"""Plans drawn to scale, as one SVG or as a page for the browser.

On the robot forward is up and left is left, as somebody sees it who stands behind it. On a map x is
to the right and y is up.
"""

from __future__ import annotations

import html
import itertools
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from textwrap import wrap
from xml.etree import ElementTree as Xml

from deros.report.areas.plans import Area, Plan, Scanner
from deros.rules.program import ir
from deros.rules.program.beams import corners
from deros.rules.program.polygons import convex_parts
from deros.rules.program.zones import Circle, Polygon

SIDE = 560.0
"""The width and the height of a plan, in pixels, without its title and its legend."""

_MARGIN, _TITLE, _LINE = 40.0, 34.0, 20.0
_COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9")
"""Of Okabe and Ito, which are told apart by people who do not see all colours."""

_INK, _GREY = "#1a1a1a", "#b8b8b8"
_HALO = {"paint-order": "stroke", "stroke": "white", "stroke-width": "3"}
_FEWEST_LINES = 4
_LETTERS = 90
"""How many letters of a legend fit into a line."""


@dataclass(frozen=True, slots=True)
class _Scale:
    """From metres to pixels.

    Attributes:
        left: what is at the left end: the greatest y of the robot, the least x of a map.
        top: what is at the upper end: the greatest x of the robot, the greatest y of a map.
        pixels: of a metre.
        offset: of the plan, downwards.
        is_map: whether x is to the right.
    """

    left: float
    top: float
    pixels: float
    offset: float
    is_map: bool

    def place(self, x: float, y: float) -> tuple[float, float]:
        """Return where a place is in the picture."""
        right, up = (x - self.left, y) if self.is_map else (self.left - y, x)
        return (
            _MARGIN + right * self.pixels,
            self.offset + _MARGIN + (self.top - up) * self.pixels,
        )


def as_svg(name: str, plans: Sequence[Plan], outline: Area | None = None) -> str:
    """Return a picture of plans, one below the other.

    Args:
        name: of the rules.
        plans: what is drawn.
        outline: of the robot; it is drawn where zones are measured from the robot.
    """
    width = SIDE + 2.0 * _MARGIN
    offset, drawn = 0.0, []
    for number, plan in enumerate(plans):
        own = outline if plan.is_of_robot else None
        group, height = _plan(plan, own, offset, f"plan{number}")
        drawn.append(group)
        offset += height
    root = Xml.Element(
        "svg",
        {
            "xmlns": "http://www.w3.org/2000/svg",
            "viewBox": f"0 0 {_number(width)} {_number(offset)}",
            "width": _number(width),
            "height": _number(offset),
            "role": "img",
            "font-family": "sans-serif",
            "font-size": "13",
        },
    )
    Xml.SubElement(root, "title").text = f"The zones of {name}"
    root.extend(drawn)
    Xml.indent(root)
    return Xml.tostring(root, encoding="unicode") + "\n"


def as_html(name: str, plans: Sequence[Plan], outline: Area | None = None) -> str:
    """Return the same picture as a page of its own, which asks for nothing else."""
    title = html.escape(f"The zones of {name}")
    picture = as_svg(name, plans, outline)
    return (
        '<!doctype html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f"<title>{title}</title>\n"
        "<style>body { margin: 1em; background: white; } svg { max-width: 100%; height: auto; }"
        f"</style>\n</head>\n<body>\n<h1>{title}</h1>\n{picture}</body>\n</html>\n"
    )


def _plan(plan: Plan, outline: Area | None, offset: float, name: str) -> tuple[Xml.Element, float]:
    """Return the drawing of a plan that begins at an offset, and its height."""
    areas = [*plan.areas, *([outline] if outline is not None else [])]
    bounds = _bounds(areas, plan.scanners)
    scale, height = _fitted(bounds, offset + _TITLE, plan.is_map)
    group = Xml.Element("g", {"class": "plan", "id": name})
    heading = {"x": _number(_MARGIN), "y": _number(offset + 24.0)}
    _text(group, plan.title, {**heading, "font-size": "17", "font-weight": "bold"})
    group.append(_grid(bounds, scale))
    coloured = list(zip(plan.areas, itertools.cycle(_COLOURS)))
    group.extend(_area(area, scale, colour) for area, colour in coloured)
    if outline is not None:
        group.append(_outline(outline, scale))
    for area, colour in coloured:  # on top of all zones
        _name(group, area, scale, colour)
    group.append(_axes(scale))
    group.extend(_scanner(each, scale) for each in plan.scanners)
    bottom = offset + _TITLE + height
    lines = [line for each in _legend(plan, outline) for line in wrap(each, _LETTERS)]
    for number, line in enumerate(lines):
        _text(group, line, {"x": _number(_MARGIN), "y": _number(bottom + number * _LINE)})
    return group, _TITLE + height + _LINE * (len(lines) + 1)


def _bounds(
    areas: Sequence[Area], scanners: Sequence[Scanner]
) -> tuple[float, float, float, float]:
    """Return the least and the greatest x, and the least and the greatest y, with some room."""
    places = [(0.0, 0.0), *((each.x, each.y) for each in scanners)]
    for area in areas:
        places += _extremes(area.shape)
    xs, ys = [x for x, _ in places], [y for _, y in places]
    room = 0.06 * max(max(xs) - min(xs), max(ys) - min(ys))
    return min(xs) - room, max(xs) + room, min(ys) - room, max(ys) + room


def _extremes(shape: ir.Shape) -> Sequence[tuple[float, float]]:
    if isinstance(shape, Circle):
        (x, y), r = shape.centre, shape.radius
        return ((x - r, y - r), (x + r, y + r))
    return corners(shape)


def _fitted(
    bounds: tuple[float, float, float, float], offset: float, is_map: bool
) -> tuple[_Scale, float]:
    """Return the scale with which a plan fills its width or its height, and its height."""
    least_x, greatest_x, least_y, greatest_y = bounds
    along_x, along_y = greatest_x - least_x, greatest_y - least_y
    pixels = SIDE / max(along_x, along_y)
    across, upwards = (along_x, along_y) if is_map else (along_y, along_x)
    spare = (SIDE / pixels - across) / 2.0
    left, top = (least_x - spare, greatest_y) if is_map else (greatest_y + spare, greatest_x)
    return _Scale(left, top, pixels, offset, is_map), upwards * pixels + 2.0 * _MARGIN


def _step(span: float) -> float:
    """Return the distance between lines of a grid: 1, 2 or 5 of some power of ten metres."""
    power = 10.0 ** math.floor(math.log10(span))
    steps = (power * each for each in (1.0, 0.5, 0.2, 0.1))
    return next(each for each in steps if span / each >= _FEWEST_LINES)


def _grid(bounds: tuple[float, float, float, float], scale: _Scale) -> Xml.Element:
    """Return lines with their distances from the origin, in metres."""
    least_x, greatest_x, least_y, greatest_y = bounds
    step = _step(max(greatest_x - least_x, greatest_y - least_y))
    digits = max(0, -math.floor(math.log10(step)))
    group = Xml.Element("g", {"stroke": _GREY, "stroke-width": "0.5", "fill": "#606060"})
    begin_y, end_y = (least_y, greatest_y) if scale.is_map else (greatest_y, least_y)
    for x in _lines(least_x, greatest_x, step):
        _graded(group, f"{x:.{digits}f}", scale.place(x, begin_y), scale.place(x, end_y))
    for y in _lines(least_y, greatest_y, step):
        _graded(group, f"{y:.{digits}f}", scale.place(least_x, y), scale.place(greatest_x, y))
    return group


def _lines(least: float, greatest: float, step: float) -> Iterator[float]:
    for number in range(math.ceil(least / step), math.floor(greatest / step) + 1):
        yield number * step


def _graded(
    group: Xml.Element, text: str, start: tuple[float, float], end: tuple[float, float]
) -> None:
    """Add a line with a text at its start, which is at the left or below."""
    _line(group, start, end)
    across, down = start
    if start[1] == end[1]:
        label = {"x": _number(across - 4.0), "y": _number(down + 4.0), "text-anchor": "end"}
    else:
        label = {"x": _number(across), "y": _number(down + 14.0), "text-anchor": "middle"}
    _text(group, text, {**label, "stroke": "none", "font-size": "11"})


def _area(area: Area, scale: _Scale, colour: str) -> Xml.Element:
    drawn = _shape(area.shape, scale)
    drawn.attrib |= {"class": "zone", "data-zone": area.name}
    drawn.attrib |= {"fill": colour, "fill-opacity": "0.18", "stroke": colour, "stroke-width": "2"}
    Xml.SubElement(drawn, "title").text = f"{area.name}: {area.written}"
    return drawn


def _name(group: Xml.Element, area: Area, scale: _Scale, colour: str) -> None:
    across, down = scale.place(*_inside(area.shape))
    label = {"x": _number(across), "y": _number(down), "text-anchor": "middle", "fill": colour}
    _text(group, area.name, {**label, **_HALO, "font-weight": "bold"})


def _inside(shape: ir.Shape) -> tuple[float, float]:
    """Return where the name of a zone stands: well inside, of a circle beside its middle."""
    if isinstance(shape, Circle):
        x, y = shape.centre
        return x - 0.6 * shape.radius, y
    places = corners(shape)
    exact = [(Fraction(x), Fraction(y)) for x, y in places]
    parts = convex_parts(exact) if isinstance(shape, Polygon) else [tuple(range(len(places)))]
    part = max(parts, key=lambda each: _size([places[index] for index in each]))
    xs, ys = ([places[index][axis] for index in part] for axis in (0, 1))
    return sum(xs) / len(xs), sum(ys) / len(ys)


def _size(places: Sequence[tuple[float, float]]) -> float:
    """Return twice the area between places."""
    edges = itertools.pairwise((*places, places[0]))
    return abs(sum(x * other_y - y * other_x for (x, y), (other_x, other_y) in edges))


def _outline(outline: Area, scale: _Scale) -> Xml.Element:
    drawn = _shape(outline.shape, scale)
    drawn.attrib |= {"class": "outline", "fill": "none", "stroke": _INK, "stroke-dasharray": "6 4"}
    return drawn


def _shape(shape: ir.Shape, scale: _Scale) -> Xml.Element:
    if isinstance(shape, Circle):
        across, down = scale.place(*shape.centre)
        radius = _number(shape.radius * scale.pixels)
        return Xml.Element("circle", {"cx": _number(across), "cy": _number(down), "r": radius})
    return Xml.Element("polygon", {"points": _points(corners(shape), scale)})


def _points(places: Sequence[tuple[float, float]], scale: _Scale) -> str:
    return " ".join(",".join(map(_number, scale.place(*each))) for each in places)


def _axes(scale: _Scale) -> Xml.Element:
    """Return the origin, and which way x and y go."""
    group = Xml.Element("g", {"class": "axes", "stroke": _INK, "fill": _INK, "stroke-width": "1.5"})
    across, down = scale.place(0.0, 0.0)
    directions = {"x": (0.0, -1.0), "y": (-1.0, 0.0)}
    if scale.is_map:
        directions = {"x": (1.0, 0.0), "y": (0.0, -1.0)}
    for name, (right, below) in directions.items():
        _line(group, (across, down), (across + 32.0 * right, down + 32.0 * below))
        label = {"x": _number(across + 42.0 * right), "y": _number(down + 42.0 * below + 4.0)}
        _text(group, name, {**label, "text-anchor": "middle", "stroke": "none"})
    at = {"cx": _number(across), "cy": _number(down), "r": "2.5"}
    Xml.SubElement(group, "circle", at)
    return group


def _scanner(scanner: Scanner, scale: _Scale) -> Xml.Element:
    """Return a scanner as a triangle, whose tip is where it looks."""
    group = Xml.Element("g", {"class": "scanner", "data-scanner": scanner.name})
    across, down = scale.place(scanner.x, scanner.y)
    tip, side = 14.0, 7.0
    # Up is forward, so that a turn to the left is counter-clockwise in the picture.
    turned = f"rotate({_number(-math.degrees(scanner.yaw))} {_number(across)} {_number(down)})"
    corners_ = ((0.0, -tip), (side, side), (-side, side))
    points = " ".join(f"{_number(across + x)},{_number(down + y)}" for x, y in corners_)
    drawn = {"points": points, "transform": turned, "fill": _INK, "fill-opacity": "0.75"}
    Xml.SubElement(group, "polygon", drawn)
    label = {"x": _number(across + 12.0), "y": _number(down + 18.0), "font-style": "italic"}
    _text(group, scanner.name, {**label, **_HALO})
    return group


def _legend(plan: Plan, outline: Area | None) -> Iterator[str]:
    """Yield the lines below a plan: what each zone is, and who asks for it."""
    for area in plan.areas:
        said = f", {area.description}" if area.description else ""
        yield f"{area.name}: {area.written}{said} ({', '.join(area.rules)})"
    for scanner in plan.scanners:
        degrees = f"{round(math.degrees(scanner.yaw), 1):.6g}"
        yield f"{scanner.name}: at ({scanner.x:.6g}, {scanner.y:.6g}) m, yaw {degrees}°"
    if outline is not None:
        yield f"dashed: the robot, {outline.written}"


def _line(group: Xml.Element, start: tuple[float, float], end: tuple[float, float]) -> None:
    (x1, y1), (x2, y2) = start, end
    places = {"x1": x1, "y1": y1, "x2": x2, "y2": y2}
    Xml.SubElement(group, "line", {name: _number(place) for name, place in places.items()})


def _text(group: Xml.Element, text: str, attributes: dict[str, str]) -> None:
    Xml.SubElement(group, "text", attributes).text = text


def _number(value: float) -> str:
    """Return pixels, the same on every machine."""
    return f"{round(value, 2) + 0.0:.6g}"
