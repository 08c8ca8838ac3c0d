"""From the textX objects of a node description to a :class:`~deros.models.node.NodeType`."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from deros import codes
from deros.diagnostics import Fix, Span, report
from deros.interfaces.types import InterfaceKind
from deros.metamodels.converters.convert import Converter, Sections
from deros.models.common import Interval, Name, Scalar, Value
from deros.models.node import (
    Frame,
    FrameName,
    NodeType,
    Parameter,
    ParameterType,
    Port,
    PortKind,
    Timer,
)
from deros.names.names import did_you_mean, near

if TYPE_CHECKING:
    from deros.metamodels.load import Loading

_PARAMETER_TYPES = {each.value: each for each in ParameterType} | {
    "int": ParameterType.INTEGER,
    "int[]": ParameterType.INTEGER_ARRAY,
    "float": ParameterType.DOUBLE,
    "float[]": ParameterType.DOUBLE_ARRAY,
}
_FOREIGN_TYPES = {
    **dict.fromkeys(("float32", "float64", "real", "number", "decimal"), "double"),
    **dict.fromkeys(("int8", "int16", "int32", "int64", "long", "uint", "unsigned"), "integer"),
    **dict.fromkeys(("uint8", "uint16", "uint32", "uint64", "int_", "integers"), "integer"),
    **dict.fromkeys(("str", "text", "char", "std::string"), "string"),
    **dict.fromkeys(("boolean", "flag"), "bool"),
}
"""The ROS 2 names of parameter types of other languages."""

_INTERFACE_KINDS: dict[PortKind, InterfaceKind] = {
    PortKind.PUBLISHER: "msg",
    PortKind.SUBSCRIPTION: "msg",
    PortKind.SERVICE: "srv",
    PortKind.CLIENT: "srv",
    PortKind.ACTION: "action",
    PortKind.ACTION_CLIENT: "action",
}

_WORDS = {
    "ParameterUnit": "unit",
    "Within": "in",
    "OneOf": "one_of",
    "Size": "size",
    "MinSize": "min_size",
    "MaxSize": "max_size",
    "NotEmpty": "not_empty",
    "Unique": "unique",
    "ReadOnly": "read_only",
    "Description": "description",
    "Via": "via",
    "StopsAfter": "stops after",
    "Qos": "qos",
    "FieldUnits": "field units",
    "Frames": "frames",
}

_UNBOUNDED = Interval(-math.inf, math.inf)


def as_double(value: Value, kind: ParameterType) -> Value:
    """Return an integer value of a double parameter as a double."""
    if kind is ParameterType.DOUBLE and type(value) is int:
        return float(value)
    if kind is ParameterType.DOUBLE_ARRAY and isinstance(value, tuple):
        return tuple(float(item) if type(item) is int else item for item in value)
    return value


def load_node_type(loading: Loading) -> NodeType:
    """Load a node description."""
    converter = NodeConverter(loading.source)
    result = converter.node_type(loading.parse())
    loading.diagnostics += converter.diagnostics
    return result


class NodeConverter(Converter):
    """Converts one node description."""

    def node_type(self, model: Any) -> NodeType:
        """Return the node type that the file describes."""
        parameters: list[Parameter] = []
        ports: list[Port] = []
        timers: list[Timer] = []
        executable: str | None = None
        executable_span: Span | None = None
        lifecycle = False
        sections = Sections(self)
        for part in model.parts:
            kind = type(part).__name__
            if kind == "Executable":
                if sections.once("executable", self.span(part)):
                    executable = self.text(part.program)
                    executable_span = self.token_span(part.program)
                continue
            sections.once(str(part.keyword), self.token_span(part.keyword))
            if kind == "Lifecycle":
                lifecycle = True
            elif kind == "Parameters":
                found = map(self._parameter, part.parameters)
                parameters += (each for each in found if each is not None)
            elif kind == "Timers":
                timers += map(self._timer, part.timers)
            else:
                port_kind = PortKind(str(part.keyword))
                ports += (self._port(port, port_kind) for port in part.ports)
        return NodeType(
            name=str(model.name),
            package=str(model.package),
            source=self.source,
            span=self.span(model),
            name_span=self.token_span(model.name),
            package_span=self.token_span(model.package),
            description=self.text(model.description),
            executable=executable,
            executable_span=executable_span,
            lifecycle=lifecycle,
            parameters=tuple(parameters),
            ports=tuple(ports),
            timers=tuple(timers),
        )

    def _parameter(self, found: Any) -> Parameter | None:
        kind = self._parameter_type(found)
        if kind is None:
            return None
        settings: dict[str, Any] = {}
        if found.default is not None:
            settings["default_span"] = self.value_span(found.default)
        attributes = Sections(self)
        for attribute in found.attributes:
            what = type(attribute).__name__
            if what in ("Within", "Bound"):
                self._bounds(attribute, attributes, settings)
            elif what == "Custom":
                function = Name(self.text(attribute.function), self.token_span(attribute.function))
                settings["custom"] = (*settings.get("custom", ()), function)
            elif attributes.once(_WORDS[what], self.span(attribute)):
                settings |= self._attribute(attribute, kind)
        default = None if found.default is None else as_double(self.value(found.default), kind)
        return Parameter(
            self.written(found.name),
            kind,
            default,
            self.span(found),
            self.token_span(found.name),
            **settings,
        )

    def _attribute(self, attribute: Any, kind: ParameterType) -> dict[str, Any]:
        what = type(attribute).__name__
        if what == "ParameterUnit":
            return {
                "unit": self.unit(attribute.unit),
                "unit_span": self.token_span(attribute.unit),
            }
        if what == "OneOf":
            return {"choices": self._choices(attribute.values, kind)}
        if what in ("Size", "MinSize", "MaxSize"):
            return {_WORDS[what]: self.integer(attribute.size)}
        if what in ("NotEmpty", "Unique", "ReadOnly"):
            return {_WORDS[what]: True}
        return {"description": self.text(attribute.text)}

    def _bounds(self, attribute: Any, given: Sections, settings: dict[str, Any]) -> None:
        """Combine a range or a one-sided bound with another bound."""
        known: Interval = settings.get("interval", _UNBOUNDED)
        span = self.span(attribute)
        if type(attribute).__name__ == "Within":
            span = self.span(attribute.interval)
            if not given.once("lower bound", span) or not given.once("upper bound", span):
                return
            bounds = self.interval(attribute.interval)
        else:
            operator, value = str(attribute.operator), float(self.decimal(attribute.value))
            closed = operator.endswith("=")
            if operator[0] == ">":
                if not given.once("lower bound", span):
                    return
                bounds = Interval(value, known.upper, closed, known.upper_closed)
            else:
                if not given.once("upper bound", span):
                    return
                bounds = Interval(known.lower, value, known.lower_closed, closed)
        first: Span = settings.get("interval_span", span)
        settings["interval"] = bounds
        settings["interval_span"] = Span(self.source, first.start, span.end)

    def _parameter_type(self, found: Any) -> ParameterType | None:
        text = "".join(found.type.split())
        kind = _PARAMETER_TYPES.get(text)
        if kind is None:
            self._unknown_parameter_type(text, self.token_span(found.type))
            self.lose(self.span(found))
        return kind

    def _unknown_parameter_type(self, text: str, span: Span) -> None:
        element, is_array = text.removesuffix("[]").lower(), text.endswith("[]")
        meant = _FOREIGN_TYPES.get(element)
        fix = None
        if meant is not None:
            hint = f"write '{meant}{'[]' * is_array}'"
            fix = Fix(span, f"{meant}{'[]' * is_array}")
        else:
            hint = did_you_mean(near(text, _PARAMETER_TYPES))
            hint = hint or f"the types are {', '.join(_PARAMETER_TYPES)}"
        message = f"unknown parameter type '{text}'"
        self.diagnostics.append(report(codes.SYNTAX_ERROR, message, span, hint, fix=fix))

    def _choices(self, array: Any, kind: ParameterType) -> tuple[Scalar, ...]:
        values = tuple(self.scalar(item) for item in array.items)
        if kind in (ParameterType.DOUBLE, ParameterType.DOUBLE_ARRAY):
            return tuple(float(value) if type(value) is int else value for value in values)
        return values

    def _port(self, found: Any, kind: PortKind) -> Port:
        settings: dict[str, Any] = {}
        attributes = Sections(self)
        for attribute in found.attributes:
            what = type(attribute).__name__
            if not attributes.once(_WORDS[what], self.span(attribute)):
                continue
            if what == "FieldUnits":
                settings["units"] = tuple(map(self.field_unit, attribute.fields))
            elif what == "Frames":
                settings["frames"] = tuple(map(self._frame, attribute.frames))
            elif what == "Via":
                settings |= {
                    "via": self.written(attribute.parameter),
                    "via_span": self.token_span(attribute.parameter),
                }
            elif what == "StopsAfter":
                settings["stops_after_ns"] = self._silence(attribute, kind)
            elif what == "Qos":
                settings["qos"] = self.qos(attribute)
            else:
                settings["description"] = self.text(attribute.text)
        return Port(
            kind,
            str(found.name),
            self.interface(found.type, _INTERFACE_KINDS[kind]),
            self.span(found),
            self.token_span(found.name),
            self.token_span(found.type),
            **settings,
        )

    def _silence(self, found: Any, kind: PortKind) -> int | None:
        """Return the silence of a subscription after which its node has stopped."""
        silence = self._positive_ns(found.silence, "the time of 'stops after'")
        if kind is PortKind.SUBSCRIPTION:
            return silence
        self.report(
            codes.SYNTAX_ERROR,
            f"'stops after' is for subscriptions, and this is a {kind.word.replace('_', ' ')}",
            self.span(found),
            "write it at the subscription whose silence stops the node",
        )
        return None

    def _frame(self, found: Any) -> Frame:
        parent, child = (
            FrameName(str(name), self.token_span(name))
            for name in (found.parent_frame, found.child_frame)
        )
        if found.switch is None:
            return Frame(parent, child)
        return Frame(parent, child, Name(self.written(found.switch), self.token_span(found.switch)))

    def _timer(self, found: Any) -> Timer:
        return Timer(
            str(found.name),
            self._positive_ns(found.period, "a timer's period"),
            self.span(found),
            self.token_span(found.name),
            self.text(found.description),
        )

    def _positive_ns(self, found: Any, what: str) -> int:
        """Return a duration in nanoseconds, and report one that is not positive or too long."""
        before = len(self.diagnostics)
        duration = self.duration_ns(found)
        if duration == 0 and len(self.diagnostics) == before:
            self.report(codes.BAD_DURATION, f"{what} must be positive", self.span(found))
        self.check_longest(duration, what, found)
        return duration
