"""What a picture of zones shows: one plan for each place that zones are measured from."""

from __future__ import annotations

from collections.abc import Container, Mapping
from dataclasses import dataclass, field
from fractions import Fraction

from deros.interfaces.types import FieldType
from deros.interfaces.units import UnitRegistry
from deros.metamodels.load import Repository
from deros.models import rules
from deros.rules.compiler.scope.zones import DeclaredZone
from deros.rules.functions.reads import strip_comments
from deros.rules.program import ir, walk

_DOUBLE = FieldType("float64")
_ON_ROBOT = "On the robot"


@dataclass(frozen=True, slots=True)
class Area:
    """A zone, or the outline of the robot.

    Attributes:
        name: as declared.
        shape: in metres, in the coordinates of its plan.
        written: the shape and its unit, as declared.
        description: as declared.
        rules: the full names of the rules that ask for it.
    """

    name: str
    shape: ir.Shape
    written: str = ""
    description: str = ""
    rules: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Scanner:
    """A laser scanner: its input, where it is in metres, and where it looks, in radians."""

    name: str
    x: float
    y: float
    yaw: float


@dataclass(slots=True)
class Plan:
    """All that is measured from one origin: of a map, or of the robot or a scanner on it.

    Of a robot ``x`` is forward and ``y`` to the left.
    """

    title: str
    is_map: bool
    areas: list[Area] = field(default_factory=list)
    scanners: list[Scanner] = field(default_factory=list)

    @property
    def is_of_robot(self) -> bool:
        """Whether its origin is that of the robot."""
        return self.title == _ON_ROBOT


def plans(model: rules.Rules, program: ir.Program) -> tuple[Plan, ...]:
    """Return a plan for the robot, for each scanner without a mounting, and for each position.

    Args:
        model: the rules as written.
        program: what they were built to, without an error.
    """
    found: dict[str, Plan] = {}
    units = UnitRegistry(model.own_units)
    mounted = {each.name.text: each.mounting for each in model.inputs if each.mounting is not None}
    for zone in model.zones:
        for title, (names, scanners) in _asked(program, zone.name.text, mounted).items():
            shape = _metres(zone, units)
            if shape is None:
                continue
            written = f"{strip_comments(zone.shape_span.text)} {zone.unit}"
            area = Area(zone.name.text, shape, written, zone.description, tuple(names))
            plan = found.setdefault(title, Plan(title, not scanners))
            plan.areas.append(area)
            for name in scanners:
                placed = _placed(name, mounted.get(name), units)
                if placed not in plan.scanners:
                    plan.scanners.append(placed)
    return tuple(found.values())


def outline(text: str) -> Area:
    """Return the outline of the robot, of a text such as ``circle (0, 0) 0.2 m``.

    Raises:
        ValueError: it is no shape with a unit of length, or has no area.
    """
    written = f"zone outline = {text.strip()}"
    loaded = Repository().load_text("outline.deros", written)
    zones = loaded.model.zones if isinstance(loaded.model, rules.Rules) else ()
    if loaded.diagnostics or not zones or zones[0].span.text != written:
        raise ValueError(f"'{text}' is no shape")
    shape = _metres(zones[0], UnitRegistry())
    if shape is None:
        raise ValueError(f"'{text}' is no shape with a unit of length")
    return Area("outline", shape, text)


def _metres(zone: rules.Zone, units: UnitRegistry) -> ir.Shape | None:
    """Return the shape of a zone in metres; nothing if its unit is not one of length."""
    metre = units.parse("m")
    unit = None if zone.unit is None else units.parse(zone.unit)
    if unit is None or metre is None or unit.exponents != metre.exponents:
        return None
    return DeclaredZone(zone, unit).shape(metre, _DOUBLE)


def _asked(
    program: ir.Program, zone: str, mounted: Container[str]
) -> Mapping[str, tuple[dict[str, None], dict[str, None]]]:
    """Return which rules ask for a zone, and which scanners look into it, by the title of a plan.

    Args:
        program: the rules.
        zone: its name.
        mounted: the inputs of which is said where they are on the robot.
    """
    found: dict[str, tuple[dict[str, None], dict[str, None]]] = {}
    for rule in program.rules:
        for value in walk.values(walk.parts(rule.condition)):
            if not isinstance(value, ir.Apply | ir.Compute):
                continue
            if value.zone is None or value.zone.name != zone:
                continue
            title, scanner = _origin(program, value, mounted)
            names, scanners = found.setdefault(title, ({}, {}))
            names[rule.full_name] = None
            scanners.update(dict.fromkeys(scanner))
    return found


def _origin(
    program: ir.Program, value: ir.Apply | ir.Compute, mounted: Container[str]
) -> tuple[str, tuple[str, ...]]:
    """Return the title of the plan with the points of a value, and the scanner that shows them."""
    if isinstance(value, ir.Compute):
        read = value.operands[0]
        assert isinstance(read, ir.Read)
        return f"Where {program.inputs[program.leaves[read.leaf].input].name} is", ()
    scan = program.inputs[value.input]
    title = _ON_ROBOT if scan.name in mounted else f"From the scanner of {scan.topic}"
    return title, (scan.name,)


def _placed(name: str, mounting: rules.Mounting | None, units: UnitRegistry) -> Scanner:
    """Return where a scanner is: without a mounting it is the origin."""
    if mounting is None:
        return Scanner(name, 0.0, 0.0, 0.0)
    unit = units.parse(mounting.unit or "m")
    assert unit is not None
    x, y = (float(Fraction(each) * unit.factor) for each in (mounting.x, mounting.y))
    if mounting.yaw is None:
        return Scanner(name, x, y, 0.0)
    angle = units.parse(mounting.yaw.unit or "rad")
    assert angle is not None
    return Scanner(name, x, y, float(Fraction(mounting.yaw.value) * angle.factor))
