"""Resolves ``inside()`` and ``points_in()``: points that are held against a zone."""

from __future__ import annotations

from collections.abc import Mapping

from deros import codes
from deros.diagnostics import Related, Span
from deros.interfaces.types import FieldType
from deros.interfaces.units import Unit, is_same
from deros.models import rules
from deros.names.names import did_you_mean, near
from deros.rules.compiler.scope import shapes
from deros.rules.compiler.scope.lengths import LENGTH
from deros.rules.compiler.scope.mentions import Mention
from deros.rules.compiler.scope.resolved import DeclaredInput, InsideOf, Mounted, Part
from deros.rules.compiler.scope.scope import Scope
from deros.rules.compiler.scope.zones import DeclaredZone
from deros.rules.functions.reads import strip_comments
from deros.rules.program import ir
from deros.rules.program.zones import zone_formula

_POSITIONS = "the origin of a position"
_ROBOT = "the robot's origin"


class ZoneTerms:
    """Resolves what rules ask of zones. ``None`` means that a fault has been reported."""

    def __init__(self, scope: Scope, declared: Mapping[str, DeclaredZone | None]) -> None:
        """Resolve within a scope; a declared zone that is ``None`` has been reported."""
        self._scope = scope
        self._declared = declared
        self._origins: dict[str, tuple[str, Span]] = {}

    @property
    def names(self) -> tuple[str, ...]:
        """The names of the zones."""
        return tuple(self._declared)

    def inside(self, call: rules.Call, point: Part, leaves: tuple[str, ...]) -> InsideOf | None:
        """Return whether a point is in the zone that a call names.

        Args:
            call: ``POINT.inside(ZONE)``.
            point: what it is applied to.
            leaves: the names of the point's coordinates.
        """
        zone = self._zone(call, _POSITIONS)
        if zone is None:
            return None
        units = self._scope.field_units
        owner, kind = point.input, FieldType("float64")
        reads: list[ir.Read] = []
        found: list[Unit | None] = []
        for name in leaves:
            leaf = shapes.leaf_type(self._scope.store, point.type, name)
            assert leaf is not None, "a point has coordinates"
            kind = leaf
            path = (*point.path, name)
            reads.append(self._scope.read(owner, path, leaf))
            found.append(units.unit_of(owner.topic, owner.type, path))
        unit = found[0]
        if not self._fit(call, zone, found):
            return None
        if unit is None:  # then they are in that of the zone, in the whole program
            keys = tuple((owner.topic, (*point.path, name)) for name in leaves)
            units.use(keys, zone.unit, call.arguments[0].span)
        shape = self._shape(call, zone, unit, kind)
        if shape is None:
            return None
        written = zone.written
        held = ir.Zone(
            written.name.text,
            shape,
            str(unit if unit is not None else zone.unit),
            written.description,
            written.span,
        )
        wording = strip_comments(call.span.text)
        computed = ir.Compute(zone_formula(shape), tuple(reads), wording, held)
        return InsideOf(owner, ir.Compare(computed, ">", ir.Const(0.0)))

    def seen(self, call: rules.Call, owner: DeclaredInput) -> ir.Zone | None:
        """Return the zone that a call names, in metres, in the coordinates of a laser scanner.

        Args:
            call: ``SCAN.points_in(ZONE)``.
            owner: the input of the scan.
        """
        origin = f"the scanner of '{owner.topic}' itself" if owner.mounted is None else _ROBOT
        zone = self._zone(call, origin)
        if zone is None:
            return None
        metre = self._scope.units.parse("m")
        shape = self._shape(call, zone, metre, FieldType("float64"), owner.mounted)
        if shape is None:
            return None
        written = zone.written
        return ir.Zone(written.name.text, shape, "m", written.description, written.span)

    def _zone(self, call: rules.Call, origin: str) -> DeclaredZone | None:
        """Return the zone that a call names, whose points are measured from an origin."""
        argument = call.arguments[0] if len(call.arguments) == 1 else None
        if not isinstance(argument, rules.NamePath) or argument.path:
            known = next(iter(self._declared), "ZONE")
            message = f"'{call.function}()' takes the name of a zone"
            hint = f"write '{call.function}({known})'"
            if not self._declared:
                hint = "declare one: 'zone ZONE = polygon (0, 0) (4, 0) (4, 3) (0, 3) m'"
            self._scope.fault(codes.WRONG_FUNCTION_ARGUMENT, message, call.span, hint)
            return None
        name = argument.name.text
        if name in self._declared:
            self._scope.mentions.append(Mention("zone", name, argument.name.span))
            self._measured(name, origin, call.span)
            return self._declared[name]
        hint = did_you_mean(near(name, self._declared))
        if not self._declared:
            hint = f"declare it: 'zone {name} = polygon (0, 0) (4, 0) (4, 3) (0, 3) m'"
        message = f"there is no zone '{name}'"
        self._scope.fault(codes.UNKNOWN_NAME, message, argument.name.span, hint)
        return None

    def _measured(self, name: str, origin: str, span: Span) -> None:
        """Report a zone whose points are measured from one place here, from another elsewhere."""
        first, elsewhere = self._origins.setdefault(name, (origin, span))
        if first == origin:
            return
        message = f"zone '{name}' is measured from {origin} here, and from {first} elsewhere"
        hint = "declare a zone for each"
        if _POSITIONS not in (first, origin):
            hint = "say of each scanner where it is: 'mounted (0.25, 0, 0.1) m'"
        related = (Related(elsewhere, f"here from {first}"),)
        self._scope.fault(codes.ZONE_SEEN_TWICE, message, span, hint, related)

    def _fit(self, call: rules.Call, zone: DeclaredZone, found: list[Unit | None]) -> bool:
        """Return whether coordinates in some units are lengths in one unit; report others."""
        assert call.receiver is not None
        receiver = call.receiver.span
        first, *others = found
        if any((each is None) != (first is None) for each in others) or not all(
            each is None or is_same(each, first) for each in others
        ):
            message = f"the coordinates of '{receiver.text}' are in different units"
            self._scope.fault(codes.INCOMPATIBLE_UNITS, message, receiver)
            return False
        if first is not None and first.exponents != LENGTH:
            message = (
                f"'{receiver.text}' is in {first} ({first.dimension}), the points of zone"
                f" '{zone.written.name}' are in {zone.unit} ({zone.unit.dimension})"
            )
            self._scope.fault(codes.INCOMPATIBLE_UNITS, message, receiver)
            return False
        return True

    def _shape(
        self,
        call: rules.Call,
        zone: DeclaredZone,
        unit: Unit | None,
        kind: FieldType,
        mounted: Mounted | None = None,
    ) -> ir.Shape | None:
        try:
            return zone.shape(unit, kind, mounted)
        except ValueError:
            name = zone.written.name
            message = f"zone '{name}' is too small for the coordinates of this point, in {kind}"
            self._scope.fault(codes.ZONE_WITHOUT_AREA, message, call.arguments[0].span)
            return None
