"""Timeouts in the rules against the periods of safety nodes, as the systems set them."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from fractions import Fraction

from deros import codes
from deros.diagnostics import Diagnostic, Related, Span, report
from deros.interfaces.durations import NS_PER_S
from deros.models.node import PortKind
from deros.models.rules import Gate
from deros.rules.compiler.build import BuildResult
from deros.rules.program import ir
from deros.systems.flat import FlatNode, FlatSystem
from deros.systems.safety_nodes import (
    FASTEST_DIAGNOSTICS_HZ,
    FASTEST_PUBLISH_HZ,
    HEARTBEAT,
    PUBLISH_HZ,
    is_gate_node,
)
from deros.validators.wiring.system_safety import is_safety_node, is_state

FEWEST_PERIODS = Fraction(5, 2)
"""The number of periods after which a missing message counts as lost."""

_HIGHEST_HZ = {
    "publish_freq": FASTEST_PUBLISH_HZ,
    "diagnostics_freq": FASTEST_DIAGNOSTICS_HZ,
}
_HINTED_NS = 300_000_000


@dataclass(frozen=True, slots=True)
class _Pace:
    """The rate at which a safety node publishes a topic.

    Attributes:
        hertz: the rate.
        node: the full name of the node; empty where no system has one, and the default counts.
        parameter: the parameter that sets it.
        place: where the system sets it, or else the node.
    """

    hertz: Fraction
    node: str = ""
    parameter: str = "publish_freq"
    place: Span | None = None

    @property
    def shortest_ns(self) -> int:
        """The shortest timeout that is long enough."""
        return math.ceil(FEWEST_PERIODS * NS_PER_S / self.hertz)

    @property
    def related(self) -> tuple[Related, ...]:
        """The place for a finding."""
        return (Related(self.place, f"its {self.parameter}"),) if self.place is not None else ()

    @property
    def hz(self) -> str:
        """The rate in the notation of findings."""
        return f"{float(self.hertz):.6g}"


# Gates ------------------------------------------------------------------------------------------


def check_heartbeats(
    gate: ir.Gate, program: ir.Program, systems: Iterable[FlatSystem]
) -> Iterator[Diagnostic]:
    """Yield lines of a gate whose heartbeat timeout is too short."""
    paces = _heartbeats(gate.target, _states_of(program), systems)
    for line in gate.lines:
        if line.lost != "heartbeat" or not line.lost_ns:
            continue
        for pace in paces:
            if line.lost_ns < pace.shortest_ns:
                whose = f" of '{pace.node}'" if pace.node else ""
                yield report(
                    codes.HEARTBEAT_TIMEOUT_TOO_SHORT,
                    f"this is less than {float(FEWEST_PERIODS)} periods of the heartbeat{whose},"
                    f" which is published at {pace.hz} Hz: a late heartbeat would count as lost",
                    line.span,
                    _remedy(pace, line.lost_ns),
                    pace.related,
                )


def heartbeat_hint(gate: Gate, states: set[str], systems: Iterable[FlatSystem]) -> str:
    """Return the line that monitors the heartbeat, with a time that suits the systems."""
    needed = (pace.shortest_ns for pace in _heartbeats(gate.target.text, states, systems))
    return f"add 'lost heartbeat for {_seconds(max(_HINTED_NS, *needed))} sec: zero until reset;'"


def _states_of(program: ir.Program) -> set[str]:
    return {each.binding.topic for each in program.actions if each.binding is not None}


def _heartbeats(target: str, states: set[str], systems: Iterable[FlatSystem]) -> list[_Pace]:
    """Return the heartbeats of the gates to a topic, or else the default.

    Where a system has no such gate yet, its heartbeat will be that of the node that publishes the
    ``states`` of the rules' actions.
    """
    found: list[_Pace] = []
    for flat in systems:
        listened = {
            port.topic
            for node in flat.nodes
            if node.type is not None and is_gate_node(node.type.name, target)
            for port in node.ports
            if port.port.kind is PortKind.SUBSCRIPTION and port.port.name.endswith("/heartbeat")
        }
        wanted = listened or states
        found += [
            _pace(node, "publish_freq")
            for node in filter(is_safety_node, flat.nodes)
            if any(
                port.port.kind is PortKind.PUBLISHER and port.topic in wanted for port in node.ports
            )
        ]
    return found or [_Pace(Fraction(PUBLISH_HZ))]


# Inputs -----------------------------------------------------------------------------------------


def check_input_timeouts(result: BuildResult) -> Iterator[Diagnostic]:
    """Yield inputs whose timeout is shorter than the period of a working safety node."""
    nodes = [node for flat in result.topics.systems for node in flat.nodes if is_safety_node(node)]
    paces = {topic: pace for node in nodes for topic, pace in _paces(node).items()}
    for each in result.program.inputs if result.program is not None else ():
        pace, known = paces.get(each.topic), result.topics.get(each.topic)
        if pace is None or each.timeout_ns is None or each.timeout_ns >= pace.shortest_ns:
            continue
        if known is not None and (known.external or known.untyped or len(known.publishers) > 1):
            continue  # another publisher may fill the gaps
        yield report(
            codes.TIMEOUT_TOO_SHORT,
            f"the timeout of '{each.name}' is less than {float(FEWEST_PERIODS)} periods of"
            f" '{pace.node}', which publishes '{each.topic}' at {pace.hz} Hz",
            each.span,
            _remedy(pace, each.timeout_ns),
            pace.related,
        )


def _paces(node: FlatNode) -> dict[str, _Pace]:
    """Return how often a safety node publishes each of the topics that it repeats."""
    found: dict[str, _Pace] = {}
    for port in node.ports:
        if port.port.kind is not PortKind.PUBLISHER:
            continue
        if port.port.name == HEARTBEAT or is_state(port.port):
            found[port.topic] = _pace(node, "publish_freq")
        elif port.port.name.endswith("/diagnostics"):
            found[port.topic] = _pace(node, "diagnostics_freq")
    return found


# Paces ------------------------------------------------------------------------------------------


def _pace(node: FlatNode, parameter: str) -> _Pace:
    """Return the rate that the system sets, else the default of the node's description."""
    declared = node.type.parameter(parameter) if node.type is not None else None
    value = dict(node.parameters).get(parameter, declared.default if declared else None)
    setting = next((each for each in node.instance.parameters if each.name == parameter), None)
    hertz = Fraction(PUBLISH_HZ)  # a value that no safety node accepts is a separate finding
    if isinstance(value, (int, float)) and not isinstance(value, bool) and 0 < value < math.inf:
        hertz = Fraction(value)
    return _Pace(
        hertz,
        node.full_name,
        parameter,
        setting.span if setting is not None else node.instance.name_span,
    )


def _remedy(pace: _Pace, given_ns: int) -> str:
    hint = f"write {_seconds(pace.shortest_ns)} sec or more"
    needed = FEWEST_PERIODS * NS_PER_S / given_ns
    if needed > _HIGHEST_HZ[pace.parameter]:
        return hint
    whose = f" of '{pace.node}'" if pace.node else " of the safety node"
    return f"{hint}, or set '{pace.parameter}'{whose} to {math.ceil(needed)}.0 in the system"


def _seconds(nanoseconds: int) -> str:
    return f"{math.ceil(nanoseconds / 1_000_000) / 1000:.9g}"
