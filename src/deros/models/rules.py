"""The typed model of safety rules (``*.deros``): the syntax tree, names not yet resolved.

What the rules mean, with names, fields and units resolved, is :mod:`deros.rules.program.ir`.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from decimal import Decimal

from deros.diagnostics import SourceFile, Span
from deros.models.bindings import Binding, ServiceCall
from deros.models.common import Name
from deros.models.gates import Gate as Gate
from deros.models.gates import GateLimit as GateLimit
from deros.models.gates import GateLine as GateLine
from deros.models.gates import GateSource as GateSource
from deros.models.gates import GateStop as GateStop
from deros.models.gates import StopField as StopField
from deros.models.gates import StopKind as StopKind
from deros.models.node import NodeType
from deros.models.system import System
from deros.models.terms import And as And
from deros.models.terms import Arithmetic as Arithmetic
from deros.models.terms import ArithmeticOperator as ArithmeticOperator
from deros.models.terms import Begins as Begins
from deros.models.terms import Boolean as Boolean
from deros.models.terms import Call as Call
from deros.models.terms import Comparison as Comparison
from deros.models.terms import ComparisonOperator as ComparisonOperator
from deros.models.terms import Condition as Condition
from deros.models.terms import Entries as Entries
from deros.models.terms import EntriesWord as EntriesWord
from deros.models.terms import For as For
from deros.models.terms import Membership as Membership
from deros.models.terms import NamePath as NamePath
from deros.models.terms import Negative as Negative
from deros.models.terms import Not as Not
from deros.models.terms import Number as Number
from deros.models.terms import Once as Once
from deros.models.terms import Or as Or
from deros.models.terms import Since as Since
from deros.models.terms import String as String
from deros.models.terms import Term as Term
from deros.models.terms import Times as Times
from deros.models.terms import TopicPath as TopicPath
from deros.models.terms import Truth as Truth
from deros.models.terms import leaves as leaves
from deros.models.terms import operands as operands

# Declarations -----------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Use:
    """``use "FILE" import NAME``; ``system`` is ``None`` when it could not be loaded."""

    path: str
    system_name: Name
    system: System | None = field(compare=False, repr=False)
    span: Span = field(compare=False, repr=False)
    path_span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class UnitDefinition:
    """``unit knot = 0.514444 m/s``."""

    name: Name
    factor: Number
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Action:
    """A declared action: robot code, unless its state is published or a service is called."""

    name: Name
    parameters: tuple[Name, ...]
    span: Span = field(compare=False, repr=False)
    binding: Binding | None = None
    service: ServiceCall | None = None
    reset_by: Name | None = None
    latched: bool = False
    description: str = ""


@dataclass(frozen=True, slots=True)
class TunableIn:
    """``tunable in [0.1, 1.0] m/s``: a safety node sets the constant within this interval.

    ``unit`` follows the interval and is that of both ends; an end may have its own instead.
    """

    lower: Term
    upper: Term
    closed: bool
    span: Span = field(compare=False, repr=False)
    interval_span: Span = field(compare=False, repr=False)
    unit: str | None = None
    unit_span: Span | None = field(default=None, compare=False, repr=False)
    description: str = ""


@dataclass(frozen=True, slots=True)
class Constant:
    """``const NAME = VALUE``; the value is a number, another constant or a conversion of one.

    Of a ``tunable`` one the value is a number, which applies where a node does not set it.
    """

    name: Name
    value: Term
    span: Span = field(compare=False, repr=False)
    tunable: TunableIn | None = None


@dataclass(frozen=True, slots=True)
class Mounting:
    """``mounted (x, y, z) UNIT yaw ANGLE``: where a sensor is on the robot, and where it looks.

    Attributes:
        x: forward of the robot's origin.
        y: to the left of it.
        z: above it; ``None`` if it is not said.
        unit: of the three, as written; ``None`` if there is none, which is an error.
        yaw: from the robot's forward direction to the sensor's, counter-clockwise; ``None`` if they
            are the same.
        span: of the whole.
        place_span: of the coordinates, without their unit.
        unit_span: of the unit.
        described_span: of a mounting that a robot description is to tell; it is refused.
    """

    x: Decimal
    y: Decimal
    z: Decimal | None
    unit: str | None
    yaw: Number | None
    span: Span = field(compare=False, repr=False)
    place_span: Span = field(compare=False, repr=False)
    unit_span: Span | None = field(default=None, compare=False, repr=False)
    described_span: Span | None = field(default=None, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Input:
    """``input NAME = topic TOPIC.FIELD [UNIT] no_return N publishers any mounted … timeout T``.

    All after the field may be absent. ``no_return`` is the range that a laser scanner reports where
    nothing is there; ``any_publishers``: several nodes are meant to publish the topic;
    ``needs_one_publisher``: it says ``on_second_publisher unknown``.
    """

    name: Name
    term: TopicPath
    span: Span = field(compare=False, repr=False)
    timeout: Number | None = None
    description: str = ""
    unit: str | None = None
    unit_span: Span | None = field(default=None, compare=False, repr=False)
    no_return: Number | None = None
    any_publishers: bool = False
    needs_one_publisher: bool = False
    mounting: Mounting | None = None


# Zones ------------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Point:
    """``(x, y)``, in the unit of the zone."""

    x: Decimal
    y: Decimal
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Polygon:
    """``polygon (0, 0) (4, 0) (4, 3)``: an edge leads from each corner to the next one.

    The last edge leads back to the first corner. The corners go round in either direction.
    """

    corners: tuple[Point, ...]


@dataclass(frozen=True, slots=True)
class Circle:
    """``circle (x, y) RADIUS``; the radius is in the unit of the zone."""

    centre: Point
    radius: Decimal
    radius_span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Rectangle:
    """``rectangle (x, y) (x, y)``: two opposite corners, sides along the axes."""

    corner: Point
    opposite: Point


ZoneShape = Polygon | Circle | Rectangle


@dataclass(frozen=True, slots=True)
class Zone:
    """``zone NAME = SHAPE UNIT``.

    Attributes:
        name: by which rules name it.
        shape: with coordinates in ``unit``.
        unit: as written; ``None`` if there is none, which is an error.
        span: of the whole statement.
        shape_span: of the shape, without its unit.
        unit_span: of the unit.
        description: as written.
        when_span: of a condition on which the zone would depend; it is refused.
    """

    name: Name
    shape: ZoneShape
    unit: str | None
    span: Span = field(compare=False, repr=False)
    shape_span: Span = field(compare=False, repr=False)
    unit_span: Span | None = field(default=None, compare=False, repr=False)
    description: str = ""
    when_span: Span | None = field(default=None, compare=False, repr=False)


# Rules ------------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Rule:
    """``[failsafe] NAME: CONDITION;`` inside an entity.

    A ``failsafe`` one counts as true for the behaviours where it is unknown.
    """

    name: Name
    condition: Condition
    span: Span = field(compare=False, repr=False)
    description: str = ""
    failsafe: bool = False


@dataclass(frozen=True, slots=True)
class Entity:
    """A named group of rules."""

    name: Name
    rules: tuple[Rule, ...]
    span: Span = field(compare=False, repr=False)
    description: str = ""


@dataclass(frozen=True, slots=True)
class ActionCall:
    """``stop;`` or ``log_state("text");`` in the body of a behaviour."""

    action: Name
    arguments: tuple[Term, ...]
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Behaviour:
    """``[optional] [behaviour NAME:] if CONDITION then { … };``, its body in the order written.

    An ``optional`` one, which has a name, can be switched off while the safety node runs.
    """

    condition: Condition
    body: tuple[ActionCall | Behaviour, ...]
    span: Span = field(compare=False, repr=False)
    name: Name | None = None
    optional: bool = False


@dataclass(frozen=True, slots=True)
class Rules:
    """A whole DeRoS program. ``name`` is the stem of its file.

    ``nodes`` are the nodes that it becomes, by target and package: found once, by
    :func:`deros.systems.flatten.nodes_of_rules`.
    """

    name: str
    source: SourceFile = field(compare=False, repr=False)
    uses: tuple[Use, ...] = ()
    units: tuple[UnitDefinition, ...] = ()
    actions: tuple[Action, ...] = ()
    constants: tuple[Constant, ...] = ()
    inputs: tuple[Input, ...] = ()
    zones: tuple[Zone, ...] = ()
    entities: tuple[Entity, ...] = ()
    behaviours: tuple[Behaviour, ...] = ()
    gates: tuple[Gate, ...] = ()
    nodes: dict[tuple[str, str], tuple[NodeType, ...]] = field(
        default_factory=dict, init=False, compare=False, repr=False
    )

    @property
    def own_units(self) -> dict[str, tuple[Decimal, str]]:
        """The units that they define, as a registry takes them: a number of another unit each."""
        return {each.name.text: (each.factor.value, each.factor.unit or "1") for each in self.units}
