"""Units that fit the dimension of what is written."""

from __future__ import annotations

import re
from collections.abc import Iterator

from deros.interfaces.units import Unit, UnitRegistry
from deros.lsp.completion.fields import locate, rules_of, unit_of
from deros.lsp.completion.offers import Kind, Offer, Place
from deros.models.rules import Number, Rules
from deros.models.system import System

_USUAL = (
    "m", "mm", "cm", "km", "s", "ms", "min", "h", "m/s", "km/h", "m/s^2", "rad", "deg", "rad/s",
    "deg/s", "rad/s^2", "rpm", "Hz", "kg", "g", "N", "Nm", "J", "W", "Wh", "V", "A", "Ah", "ohm",
    "Pa", "bar", "K", "degC", "T", "lx", "%", "m^2", "m^3", "bit/s",
)  # fmt: skip
_LEFT = re.compile(
    r"([/~\w](?:[\w./~]|\[[^\[\]\n]*\])*?)(?:\.\w+\([^()]*\))?\s*"
    r"(?:[<>=!]=?|(?:not\s+)?in\s*[\[(][^\])]*?)\s*[-+]?[\d.]+(?:[eE][-+]?\d+)?\s*$"
)


def units(place: Place) -> Iterator[Offer]:
    """Yield the units that may stand at a place, those of the right dimension if it is known."""
    found = rules_of(place.analysis)
    own = found[0].own_units if found is not None else {}
    registry = UnitRegistry(own)
    wanted = _wanted(place, registry)
    for text in (*own, *_USUAL):
        unit = registry.parse(text)
        if unit is not None and (wanted is None or registry.compatible(unit, wanted)):
            yield Offer(text, Kind.Unit, unit.dimension, rank=0)


def _wanted(place: Place, registry: UnitRegistry) -> Unit | None:
    slot = place.slot
    if slot.rule in ("Duration", "LossDuration"):
        return registry.parse("s")
    if [each.rule for each in slot.around[-2:]] == ["Gate", "Quantity"]:
        return registry.parse("Hz")
    declared = _of_parameter(place)
    if declared is not None:
        return registry.parse(declared)
    found = rules_of(place.analysis)
    left = _LEFT.search(place.before)
    if found is None or left is None:
        return None
    model, built = found
    located = locate(model, built, left[1])
    if located is not None:
        return unit_of(built, located)
    return _of_constant(model, registry, left[1])


def _of_parameter(place: Place) -> str | None:
    """Return the unit of the parameter that a system sets."""
    model, slot = place.analysis.file.model, place.slot
    name = slot.read("Setting", "name")
    if not name or not isinstance(model, System):
        return None
    kind = model.node_types.get(slot.read("NodeInstance", "type"))
    parameter = kind.parameter_for(name) if kind is not None else None
    return parameter.unit if parameter is not None else None


def _of_constant(model: Rules, registry: UnitRegistry, name: str) -> Unit | None:
    for each in model.constants:
        value = each.value
        if each.name.text == name and isinstance(value, Number) and value.unit:
            return registry.parse(value.unit)
    return None
