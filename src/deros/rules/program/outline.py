"""What of a program its nodes follow from: states, inputs, switches and gates."""

from __future__ import annotations

from deros.diagnostics import Span
from deros.rules.program import walk
from deros.rules.program.ir import Action, Gate, InputBound, Program
from deros.systems.outlines import (
    GateOutline,
    InputOutline,
    LineOutline,
    Outline,
    ServiceOutline,
    StateOutline,
)


def program_outline(program: Program, start: Span) -> Outline:
    """Return what of a program its nodes follow from; ``start`` is the beginning of the rules."""
    spans = {each.topic: each.span for each in reversed(program.inputs)}
    return Outline(
        program.name,
        start,
        states=tuple(state for each in program.actions if (state := _state(each, start))),
        services=tuple(call for each in program.actions if (call := _service(each, start))),
        latched=any(action.latched for action in program.actions),
        inputs=tuple(
            InputOutline(topic, kind, spans[topic]) for topic, kind in program.topics.items()
        ),
        optional=tuple(each.name for each in walk.behaviours(program) if each.optional),
        gates=tuple(_gate(gate, program) for gate in program.gates),
        tunables=program.tunables,
    )


def _state(action: Action, start: Span) -> StateOutline | None:
    binding = action.binding
    if binding is None:
        return None
    return StateOutline(action.name, binding.topic, binding.type, action.span or start)


def _service(action: Action, start: Span) -> ServiceOutline | None:
    call = action.service
    if call is None:
        return None
    return ServiceOutline(action.name, call.service, call.type, action.span or start)


def _gate(gate: Gate, program: Program) -> GateOutline:
    lines = tuple(
        LineOutline(
            _state(program.actions[line.action], line.span) if line.action is not None else None,
            line.lost == "heartbeat",
            line.span,
            tuple(
                InputOutline(end.topic, end.type, end.span)
                for limit in line.limits
                for end in limit.ends
                if isinstance(end, InputBound)
            ),
        )
        for line in gate.lines
    )
    return GateOutline(
        gate.topics,
        gate.target,
        gate.type,
        lines,
        gate.span,
        gate.description,
        gate.is_latching,
        gate.tunables,
    )
