"""Node descriptions as text, which the loader reads back as the same model."""

from __future__ import annotations

import re
from collections.abc import Iterator

from deros.models.common import QosProfile, Scalar, Value
from deros.models.node import Frame, NodeType, Parameter, Port, PortKind, Timer

_KEYWORDS = {
    PortKind.PUBLISHER: "topic",
    PortKind.SUBSCRIPTION: "topic",
    PortKind.SERVICE: "service",
    PortKind.CLIENT: "client",
    PortKind.ACTION: "action",
    PortKind.ACTION_CLIENT: "action",
}
_PLAIN = re.compile(r"(?:[A-Za-z_/]|<[\w./-]*>)(?:[\w./-]|<[\w./-]*>)*", re.ASCII)
_ESCAPES = {code: f"\\u{code:04x}" for code in (*range(0x20), 0x7F, 0x85, 0x2028, 0x2029)}
_ESCAPES |= {
    ord("\n"): "\\n",
    ord("\t"): "\\t",
    ord("\r"): "\\r",
    ord('"'): '\\"',
    ord("\\"): r"\\",
}


def node_description(node: NodeType) -> str:
    """Return the ``.rnd`` text of a node type.

    Ports of one kind share a section, so a model whose kinds are interleaved comes back with its
    ports sorted by kind; all else comes back as it was.
    """
    return "\n".join(_lines(node)) + "\n"


def _lines(node: NodeType) -> Iterator[str]:
    yield _joined(f"node {node.name} : {node.package}", quoted_text(node.description))
    if node.executable is not None:
        yield f"executable {quoted_text(node.executable, always=True)}"
    if node.lifecycle:
        yield "lifecycle"
    if node.parameters or node.takes_any_parameter:
        yield "parameters open" if node.takes_any_parameter else "parameters"
        yield from (f"  {parameter_line(parameter)}" for parameter in node.parameters)
    for kind in dict.fromkeys(port.kind for port in node.ports):
        yield kind.value
        yield from (f"  {_port(port)}" for port in node.ports_of(kind))
    if node.timers:
        yield "timers"
        yield from (f"  {_timer(timer)}" for timer in node.timers)


def parameter_line(parameter: Parameter) -> str:
    """Return the line that declares a parameter."""
    head = f"name {parameter_name(parameter.name)} : {parameter.type.value}"
    if parameter.default is not None:
        head += f" = {value_text(parameter.default)}"
    return _joined(
        head,
        f"[{parameter.unit}]" if parameter.unit is not None else "",
        parameter.interval.clause() if parameter.interval is not None else "",
        f"one_of {value_text(parameter.choices)}" if parameter.choices is not None else "",
        f"size {parameter.size}" if parameter.size is not None else "",
        f"min_size {parameter.min_size}" if parameter.min_size is not None else "",
        f"max_size {parameter.max_size}" if parameter.max_size is not None else "",
        "not_empty" if parameter.not_empty else "",
        "unique" if parameter.unique else "",
        *(f"custom {quoted_text(function.text, always=True)}" for function in parameter.custom),
        "read_only" if parameter.read_only else "",
        quoted_text(parameter.description),
    )


def parameter_name(name: str) -> str:
    """Return a parameter's name, in quotes if it would not be read as a name without them."""
    return name if _PLAIN.fullmatch(name) and "//" not in name else quoted_text(name, always=True)


def _port(port: Port) -> str:
    units = " ".join(
        f"{unit.path} [{unit.unit}{' wrapping' * unit.wrapping}]" for unit in port.units
    )
    frames = " ".join(map(_frame, port.frames))
    return _joined(
        f"{_KEYWORDS[port.kind]} {port.name} : {port.type.short}",
        f"{{ {units} }}" if units else "",
        f"{{ {frames} }}" if frames else "",
        f"via {parameter_name(port.via)}" if port.via is not None else "",
        f"stops after {port.stops_after_ns} ns" if port.stops_after_ns is not None else "",
        _qos(port.qos) if port.qos is not None else "",
        quoted_text(port.description),
    )


def _frame(frame: Frame) -> str:
    switch = f" if {parameter_name(frame.switch.text)}" if frame.switch is not None else ""
    return f"frame {frame.parent.text} -> {frame.child.text}{switch}"


def _qos(profile: QosProfile) -> str:
    policies = [
        profile.preset,
        profile.reliability,
        profile.durability,
        "keep_all" if profile.keep_all else None,
        f"depth {profile.depth}" if profile.depth is not None else None,
        f"deadline {profile.deadline_ns} ns" if profile.deadline_ns is not None else None,
        f"lifespan {profile.lifespan_ns} ns" if profile.lifespan_ns is not None else None,
        f"liveliness {profile.liveliness}" if profile.liveliness is not None else None,
        f"lease {profile.lease_ns} ns" if profile.lease_ns is not None else None,
    ]
    stated = [policy for policy in policies if policy is not None]
    return _joined("qos", *stated) if stated else ""


def _timer(timer: Timer) -> str:
    head = f"timer {timer.name} every {timer.period_ns} ns"
    return _joined(head, quoted_text(timer.description))


def value_text(value: Value | tuple[Value, ...]) -> str:
    """Return a value as the languages write it."""
    if isinstance(value, tuple):
        return f"[{', '.join(map(value_text, value))}]"
    return _scalar(value)


def _scalar(value: Scalar) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    return quoted_text(value, always=True) if isinstance(value, str) else repr(value)


def quoted_text(text: str, always: bool = False) -> str:
    """Return a quoted text, and nothing for an empty one unless it is ``always`` needed."""
    return f'"{text.translate(_ESCAPES)}"' if text or always else ""


def _joined(*parts: str) -> str:
    return " ".join(part for part in parts if part)
