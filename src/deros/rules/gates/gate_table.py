"""The table of a gate, as the class plays it that is the same in every gate.

What the lines of a gate mean is stated in
:mod:`deros.generators.runtime.python.deros_runtime.gate_logic`, which generated packages carry.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from deros.generators.runtime.python.deros_runtime.gate_table import (
    Bound,
    Input,
    Line,
    Source,
    Stop,
    Table,
)
from deros.interfaces.fields import FieldPath, format_path
from deros.rules.program import ir
from deros.rules.program.ir import Action, Binding, Gate, GateLine, InputBound, Limit, TunedBound

__all__ = [
    "Bound",
    "Input",
    "Line",
    "Source",
    "StateTopic",
    "Stop",
    "Table",
    "gate_table",
    "numbered_paths",
    "state_topics",
]


@dataclass(frozen=True, slots=True)
class StateTopic:
    """A topic with the states of actions: those that lines name, by their indices."""

    topic: str
    bindings: dict[int, Binding]


def gate_table(gate: Gate, actions: Sequence[Action], shown: Callable[[GateLine], str]) -> Table:
    """Return the table of a gate.

    Args:
        gate: the gate.
        actions: those of the rules that it belongs to, by index.
        shown: returns the text of a line for reports.
    """
    return Table(
        lines=tuple(_line(line, actions, shown(line), gate.inputs) for line in gate.lines),
        actions=tuple(
            actions[index].name for state in state_topics(gate, actions) for index in state.bindings
        ),
        fields=tuple(map(format_path, numbered_paths(gate))),
        period_ns=gate.period_ns,
        resume_on_zero=gate.resume_on_zero,
        sources=tuple(
            Source(each.topic, each.silent_ns, each.from_zero)
            for each in gate.sources
            if each.silent_ns is not None
        ),
        inputs=tuple(Input(each.name, each.timeout_ns or 0) for each in gate.inputs),
    )


def _line(
    line: GateLine, actions: Sequence[Action], text: str, inputs: Sequence[InputBound]
) -> Line:
    return Line(
        text,
        action="" if line.action is None else actions[line.action].name,
        lost=line.lost or "",
        lost_ns=line.lost_ns or 0,
        stop=None if line.stop is None else _stop(line.stop),
        until_reset=line.until_reset,
        wait_ns=line.wait_ns or 0,
        limits={
            format_path(each.path): (each.lower, each.upper)
            for each in line.limits
            if isinstance(each.lower, int | float) and isinstance(each.upper, int | float)
        },
        is_severe=line.lost == "heartbeat",
        bounds={
            format_path(each.path): (
                _bound(each.lower, each, inputs),
                _bound(each.upper, each, inputs),
            )
            for each in line.limits
            if each.is_open
        },
    )


def _bound(
    end: int | float | InputBound | TunedBound, limit: Limit, inputs: Sequence[InputBound]
) -> float | Bound:
    """Return an end of a limit; ``inputs`` are those of the gate."""
    kind = "uint8" if limit.type.base in ("byte", "char") else str(limit.type.base)
    if isinstance(end, InputBound):
        number = next(index for index, each in enumerate(inputs) if each.key == end.key)
        text = f"input {end.text} (unknown: 0)"
        return Bound(text, number=number, factor=end.factor, kind=kind)
    if isinstance(end, TunedBound):
        text = f"constant {end.text}"
        return Bound(text, parameter=end.constant.name, factor=end.factor, kind=kind)
    return end


def _stop(stop: ir.Stop) -> Stop:
    return Stop(
        stop.kind,
        ramps={format_path(each.path): float(each.value or 0) for each in stop.ramps},
        sends={format_path(each.path): each.value for each in stop.sent},
    )


def numbered_paths(gate: Gate) -> tuple[FieldPath, ...]:
    """Return the paths of the fields with limits or ramps, as first named: those of the table."""
    found: dict[FieldPath, None] = {}
    for line in gate.lines:
        found |= dict.fromkeys(limit.path for limit in line.limits)
        found |= dict.fromkeys(each.path for each in (line.stop.ramps if line.stop else ()))
    return tuple(found)


def state_topics(gate: Gate, actions: Sequence[Action]) -> tuple[StateTopic, ...]:
    """Return the topics with the states of the actions that lines name, as first named."""
    topics: dict[str, StateTopic] = {}
    for line in gate.lines:
        if line.action is not None:
            binding = actions[line.action].binding
            assert binding is not None, actions[line.action].name
            topic = topics.setdefault(binding.topic, StateTopic(binding.topic, {}))
            topic.bindings[line.action] = binding
    return tuple(topics.values())
