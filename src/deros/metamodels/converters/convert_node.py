"""From the textX objects of a node description to a :class:`~deros.models.node.NodeType`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from deros import codes
from deros.diagnostics import Span
from deros.interfaces.types import InterfaceKind
from deros.metamodels.converters.convert import Sections
from deros.metamodels.converters.convert_parameters import ParameterConverter
from deros.models.common import Name
from deros.models.node import (
    Frame,
    FrameName,
    NodeType,
    Parameter,
    Port,
    PortKind,
    Timer,
)

if TYPE_CHECKING:
    from deros.metamodels.load import Loading

_INTERFACE_KINDS: dict[PortKind, InterfaceKind] = {
    PortKind.PUBLISHER: "msg",
    PortKind.SUBSCRIPTION: "msg",
    PortKind.SERVICE: "srv",
    PortKind.CLIENT: "srv",
    PortKind.ACTION: "action",
    PortKind.ACTION_CLIENT: "action",
}

_WORDS = {
    "Description": "description",
    "Via": "via",
    "StopsAfter": "stops after",
    "Qos": "qos",
    "FieldUnits": "field units",
    "Frames": "frames",
}


def load_node_type(loading: Loading) -> NodeType:
    """Load a node description."""
    converter = NodeConverter(loading.source)
    result = converter.node_type(loading.parse())
    loading.diagnostics += converter.diagnostics
    return result


class NodeConverter(ParameterConverter):
    """Converts one node description."""

    def node_type(self, model: Any) -> NodeType:
        """Return the node type that the file describes."""
        parameters: list[Parameter] = []
        ports: list[Port] = []
        timers: list[Timer] = []
        executable: str | None = None
        executable_span: Span | None = None
        plugin: Name | None = None
        lifecycle = takes_any = False
        sections = Sections(self)
        for part in model.parts:
            kind = type(part).__name__
            if kind == "Executable":
                if sections.once("executable", self.span(part)):
                    executable = self.text(part.program)
                    executable_span = self.token_span(part.program)
                continue
            if kind == "Component":
                if sections.once("plugin", self.span(part)):
                    plugin = Name(self.text(part.class_name), self.token_span(part.class_name))
                continue
            sections.once(str(part.keyword), self.token_span(part.keyword))
            if kind == "Lifecycle":
                lifecycle = True
            elif kind == "Parameters":
                takes_any |= bool(part.open)
                found = map(self.parameter, part.parameters)
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
            takes_any_parameter=takes_any,
            ports=tuple(ports),
            timers=tuple(timers),
            plugin=plugin,
        )

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
        duration = self.positive_ns(found, what)
        self.check_longest(duration, what, found)
        return duration
