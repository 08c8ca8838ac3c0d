"""Changes of node types (``*.rnd``), and of parameters, which systems have as arguments."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

from deros.diff.changes import Aspect, Change, PartKind, breaking, changed, compare
from deros.diff.qos import asks_for_more, either_way, offers_less, qos_aspects
from deros.diff.texts import Meant, joined, value_text, yes_or_no
from deros.interfaces.durations import duration_text
from deros.interfaces.units import Unit, UnitRegistry
from deros.models.common import Interval
from deros.models.node import FieldUnit, NodeType, Parameter, Port, PortKind, Timer
from deros.models.qos import Policies, policies

_UNITS = UnitRegistry()

# Parameters -------------------------------------------------------------------------------------


def unit_of(text: str | None) -> Any:
    """Return what a unit means, so that ``m/s`` and ``m*s^-1`` are one."""
    if text is None:
        return None
    unit: Unit | None = _UNITS.parse(text)
    return text if unit is None else Meant(text, (unit.exponents, unit.factor, unit.offset))


def _refuses_more(old: Interval | None, new: Interval | None) -> str:
    if new is None or (old is not None and _contains(new, old)):
        return ""
    return "values that were allowed are refused"


def _contains(outer: Interval, inner: Interval) -> bool:
    below = inner.lower > outer.lower or (
        inner.lower == outer.lower and (outer.lower_closed or not inner.lower_closed)
    )
    above = inner.upper < outer.upper or (
        inner.upper == outer.upper and (outer.upper_closed or not inner.upper_closed)
    )
    return below and above


def _fewer(old: tuple[Any, ...] | None, new: tuple[Any, ...] | None) -> str:
    if new is None or (old is not None and set(old) <= set(new)):
        return ""
    return "values that were allowed are refused"


def _size_is_narrower(old: tuple[int, float], new: tuple[int, float]) -> str:
    narrower = new[0] > old[0] or new[1] < old[1]
    return "values that were allowed are refused" if narrower else ""


def _sizes(parameter: Parameter) -> tuple[int, float]:
    most = [each for each in (parameter.size, parameter.max_size) if each is not None]
    return parameter.least_size, min(most, default=float("inf"))


def _size_text(sizes: tuple[int, float]) -> str:
    least, most = sizes
    if least == most:
        return f"size {least}"
    return f"at least {least}" + ("" if most == float("inf") else f", at most {most}")


def _switched_on(why: str) -> Any:
    return lambda old, new: why if new and not old else ""


def _default(parameter: Parameter) -> Any:
    if parameter.default_from is not None:
        return (parameter.default_from,)
    return None if parameter.default is None else (type(parameter.default), parameter.default)


def _default_text(value: Any) -> str:
    from deros.diff.expressions import expression_text

    return expression_text(value[0]) if len(value) == 1 else value_text(value[1])


def parameter_aspects() -> tuple[Aspect[Parameter], ...]:
    """Return the aspects of parameters and arguments."""
    refused = "values that were allowed are refused"
    return (
        Aspect(
            "type",
            lambda p: p.type.value,
            breaking("whoever sets it passes a value of another type"),
        ),
        Aspect(
            "default",
            _default,
            lambda _old, new: "it has to be set now" if new is None else "",
            _default_text,
        ),
        Aspect(
            "unit",
            lambda p: unit_of(p.unit),
            breaking("numbers that others set mean something else"),
        ),
        Aspect("range", lambda p: p.interval, _refuses_more, Interval.spelled),
        Aspect(
            "choices",
            lambda p: None if p.choices is None else tuple(sorted(p.choices, key=repr)),
            _fewer,
            value_text,
        ),
        Aspect("number of elements", _sizes, _size_is_narrower, _size_text),
        Aspect("unique", lambda p: p.unique, _switched_on(refused), yes_or_no),
        Aspect(
            "custom checks",
            lambda p: tuple(sorted(each.text for each in p.custom)),
            lambda old, new: (
                "" if set(new) <= set(old) else "values that were allowed may be refused"
            ),
            joined,
        ),
        Aspect(
            "read_only",
            lambda p: p.read_only,
            _switched_on("it cannot be set any more while the node runs"),
            yes_or_no,
        ),
        Aspect("description", lambda p: p.description, say=value_text),
    )


def parameter_text(parameter: Parameter) -> str:
    """Return the type, default and unit of a parameter as descriptions write them."""
    text = parameter.type.value
    default = _default(parameter)
    if default is not None:
        text += f" = {_default_text(default)}"
    return text + ("" if parameter.unit is None else f" [{parameter.unit}]")


PARAMETER: PartKind[Parameter] = PartKind(
    "parameter",
    lambda p: p.name,
    lambda p: p.name_span,
    parameter_aspects(),
    parameter_text,
    removed=lambda _: "whoever sets it sets a parameter that is not declared",
    added=lambda p: "" if p.has_default else "it has to be set, and nobody does so yet",
)

# Ports ------------------------------------------------------------------------------------------

_USERS = {
    PortKind.PUBLISHER: "those who subscribe",
    PortKind.SUBSCRIPTION: "those who publish for it",
    PortKind.SERVICE: "its clients",
    PortKind.CLIENT: "its server",
    PortKind.ACTION: "its clients",
    PortKind.ACTION_CLIENT: "its server",
}
_VERDICTS = {PortKind.PUBLISHER: offers_less, PortKind.SUBSCRIPTION: asks_for_more}


def _policies(port: Port) -> Policies:
    return policies(port.qos)


def field_units(units: Iterable[FieldUnit]) -> tuple[tuple[str, Any, bool], ...]:
    """Return the unit of each field, by its path, and whether it is an angle that wraps."""
    found = ((".".join(u.field_path), unit_of(u.unit), u.wrapping) for u in units)
    return tuple(sorted(found, key=lambda each: each[0]))


def units_text(units: tuple[tuple[str, Any, bool], ...]) -> str:
    """Return units of fields as descriptions write them."""
    return joined(f"{path} [{unit}{' wrapping' * wraps}]" for path, unit, wraps in units)


def units_break(old: tuple[Any, ...], new: tuple[Any, ...]) -> str:
    """Return whom other units of fields break; a unit that is stated now breaks nobody."""
    before, after = ({path: rest for path, *rest in units} for units in (old, new))
    if any(before[path] != after[path] for path in before.keys() & after.keys()):
        return "numbers in the messages mean something else"
    return "" if before.keys() <= after.keys() else "the unit of a field is not stated any more"


def _frames(port: Port) -> tuple[str, ...]:
    return tuple(
        sorted(
            f"{f.parent.text} -> {f.child.text}" + (f" if {f.switch}" if f.switch else "")
            for f in port.frames
        )
    )


def _silence_breaks(old: int | None, new: int | None) -> str:
    if new is None or (old is not None and new >= old):
        return ""
    return "the node stops after a silence that was accepted: those who publish for it"


def _port_aspects(kind: PortKind) -> tuple[Aspect[Port], ...]:
    return (
        Aspect(
            "type",
            lambda p: p.type.short,
            breaking(f"{_USERS[kind]} use another type and are not connected any more"),
        ),
        *qos_aspects(_policies, _VERDICTS.get(kind, either_way)),
        Aspect(
            "via",
            lambda p: p.via,
            breaking("another parameter sets its name: systems that set the old one"),
        ),
        Aspect("units", lambda p: field_units(p.units), units_break, units_text),
        Aspect(
            "frames",
            _frames,
            lambda old, new: (
                "" if set(old) <= set(new) else "a transform that others look up is not sent"
            ),
            joined,
        ),
        Aspect("stops after", lambda p: p.stops_after_ns, _silence_breaks, duration_text),
        Aspect("description", lambda p: p.description, say=value_text),
    )


def _port_kind(kind: PortKind) -> PartKind[Port]:
    return PartKind(
        kind.word.replace("_", " "),
        lambda p: p.name,
        lambda p: p.name_span,
        _port_aspects(kind),
        lambda p: p.type.short,
        removed=lambda _: f"{_USERS[kind]} find nothing to connect to",
    )


PORTS = {kind: _port_kind(kind) for kind in PortKind}

# Node types -------------------------------------------------------------------------------------

_STARTED = "launch files and systems that start it by package and executable"

TIMER: PartKind[Timer] = PartKind(
    "timer",
    lambda t: t.name,
    lambda t: t.name_span,
    (
        Aspect("period", lambda t: t.period_ns, say=duration_text),
        Aspect("description", lambda t: t.description, say=value_text),
    ),
    lambda t: f"every {duration_text(t.period_ns)}",
)

NODE_TYPE: PartKind[NodeType] = PartKind(
    "node type",
    lambda n: n.name,
    lambda n: n.name_span,
    (
        Aspect("name", lambda n: n.name, breaking("systems that name the type")),
        Aspect("package", lambda n: n.package, breaking(_STARTED)),
        Aspect("executable", lambda n: n.executable_name, breaking(_STARTED)),
        Aspect(
            "plugin",
            lambda n: None if n.plugin is None else n.plugin.text,
            lambda old, _: "" if old is None else "containers that load it by that class",
        ),
        Aspect(
            "lifecycle",
            lambda n: n.lifecycle,
            lambda _, new: (
                "it does nothing until it is activated"
                if new
                else "those who configure and activate it find no such services"
            ),
            yes_or_no,
        ),
        Aspect(
            "takes any parameter",
            lambda n: n.takes_any_parameter,
            lambda _, new: "" if new else "whoever sets a parameter that is not declared",
            yes_or_no,
        ),
        Aspect("description", lambda n: n.description, say=value_text),
    ),
    lambda n: f"{n.package}/{n.executable_name}",
    removed=lambda _: "systems that use the type",
)


def compare_node_types(old: NodeType, new: NodeType) -> Iterator[Change]:
    """Yield the changes from one version of a node type to another."""
    yield from changed(NODE_TYPE, old, new)
    yield from compare(PARAMETER, old.parameters, new.parameters)
    for kind, table in PORTS.items():
        yield from compare(table, tuple(old.ports_of(kind)), tuple(new.ports_of(kind)))
    yield from compare(TIMER, old.timers, new.timers)
