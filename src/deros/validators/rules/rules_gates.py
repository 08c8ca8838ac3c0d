"""Checks of gates: insufficient lines, and wirings that bypass the gate."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from deros import codes
from deros.diagnostics import Diagnostic, Related, Span, report
from deros.interfaces.durations import NS_PER_S
from deros.interfaces.fields import format_path
from deros.models.common import Name
from deros.models.node import PortKind
from deros.models.rules import Gate, GateLine, GateStop, Rules
from deros.names.graph_names import resolve_name
from deros.names.names import did_you_mean
from deros.names.topic_likeness import likely_topics
from deros.rules.compiler.build import BuildResult
from deros.rules.compiler.scope.topics import KnownTopic, SystemTopics
from deros.rules.program import ir, walk
from deros.systems.flat import FlatNode, FlatPort, FlatSystem
from deros.systems.safety_nodes import gate_node_name, is_gate_node
from deros.validators.deciding import Deciding
from deros.validators.rules.rules_heartbeat import check_heartbeats, heartbeat_hint


def check_gates(rules: Rules, result: BuildResult) -> Iterator[Diagnostic]:
    """Yield the findings about gates, alone and in every system that the rules use."""
    flat = result.topics.systems
    states = {resolve_name(each.binding.topic.text, "/") for each in rules.actions if each.binding}
    for gate in rules.gates:
        yield from _order(gate)
        yield from _weaker_first(gate)
        yield from _watching(gate, heartbeat_hint(gate, states, flat))
        for each in flat:
            yield from _wiring(gate, each, rules)
        if result.topics.complete:
            yield from _ends(gate, rules, result.topics)
    if result.program is not None:
        for built in result.program.gates:
            yield from _resuming(built, rules.gates[built.index], result.program)
            yield from _limits_to_zero(built)
            yield from _ramps(built, rules.gates[built.index])
            yield from _lasting_bounds(built)
            yield from _judged_too_late(built, result.program)
            yield from check_heartbeats(built, result.program, flat)


# Lines ------------------------------------------------------------------------------------------


def _order(gate: Gate) -> Iterator[Diagnostic]:
    """Yield zero lines that an earlier limit overrides in part."""
    if gate.resume is not None:
        return  # then a zero line sets all numbers to zero
    for index, line in enumerate(gate.lines):
        if line.stop is None or line.stop.kind != "zero" or line.until_reset:
            continue
        # The limits of an action do not apply while something is lost.
        earlier = (each for each in gate.lines[:index] if each.limits and not each.is_standing)
        limit = next((each for each in earlier if line.action or not each.action), None)
        if limit is not None:
            fields = ", ".join(f"'{format_path(each.path)}'" for each in limit.limits)
            yield report(
                codes.GATE_LIMIT_OVERRIDES_ZERO,
                f"while the limit for {_condition(limit)} applies, too, it determines {fields}"
                " instead of this zero",
                line.span,
                "earlier lines take precedence: write those with 'zero' first",
                (Related(limit.span, "the limit"),),
            )


def _weaker_first(gate: Gate) -> Iterator[Diagnostic]:
    """Yield stops at once that come after one that lets the robot move on for a while."""
    for index, line in enumerate(gate.lines):
        if line.stop is None or _lets_move(line.stop):
            continue
        earlier = (each for each in gate.lines[:index] if each.stop and _lets_move(each.stop))
        weaker = next(earlier, None)
        if weaker is not None:
            how = weaker.stop.span.text if weaker.stop is not None else ""
            yield report(
                codes.WEAKER_STOP_FIRST,
                f"while {_condition(weaker)} applies, too, '{how}' is done instead of this",
                line.span,
                "earlier lines take precedence: write those that stop at once first",
                (Related(weaker.span, "the line before"),),
            )


def _lets_move(stop: GateStop) -> bool:
    """Return whether the robot may still move, as commanded before, while the gate stops so."""
    return bool(stop.ramps) or stop.kind in ("hold", "silence")


def _ramps(gate: ir.Gate, written: Gate) -> Iterator[Diagnostic]:
    """Yield how long ramps take from the greatest value that limits let pass, or that none do."""
    standing = {
        limit.path: max(map(_farthest, limit.ends))
        for line in gate.lines
        if line.is_standing
        for limit in line.limits
    }
    for line, text in zip(gate.lines, written.lines, strict=True):
        if line.stop is None or text.stop is None:
            continue
        for ramp, at in zip(line.stop.ramps, text.stop.ramps, strict=True):
            name, greatest = format_path(ramp.path), standing.get(ramp.path, math.inf)
            if math.isinf(greatest):
                yield report(
                    codes.UNBOUNDED_RAMP,
                    f"nothing bounds '{name}', so this ramp may take any time to a standstill",
                    at.span,
                    f"add a limit that always holds: 'always: limit {name} to [LEAST, GREATEST];'",
                    subjects=(name,),
                )
                continue
            assert isinstance(ramp.value, float)
            takes_s = greatest / ramp.value + gate.period_ns / NS_PER_S
            yield report(
                codes.TIME_TO_STANDSTILL,
                f"'{name}' is at zero {takes_s:.3g} s after this line begins to decide, at the"
                f" latest: from {greatest:g}, its greatest value, and with one period of the gate",
                at.span,
            )


def _farthest(end: float | ir.InputBound | ir.TunedBound) -> float:
    """Return how far from zero an end of a limit can be."""
    if isinstance(end, ir.InputBound):
        return math.inf
    if isinstance(end, ir.TunedBound):
        return max(abs(end.constant.lower), abs(end.constant.upper)) * abs(end.factor)
    return abs(end)


def _listed(gate: Gate) -> str:
    return " and ".join(f"'{each.topic}'" for each in gate.sources)


def _condition(line: GateLine) -> str:
    return f"'{line.action}'" if line.action else f"a lost {line.lost}"


def _watching(gate: Gate, hint: str) -> Iterator[Diagnostic]:
    lost = {line.lost for line in gate.lines}
    if "heartbeat" not in lost:
        yield report(
            codes.GATE_WITHOUT_HEARTBEAT,
            f"commands to '{gate.target}' still pass unchecked when the safety node dies",
            gate.target.span,
            hint,
            subjects=("heartbeat",),
        )
    if "input" not in lost:
        yield report(
            codes.GATE_WITHOUT_INPUT,
            f"when messages on {_listed(gate)} stop, the last command stays in effect",
            gate.target.span,
            f"add 'lost input{'' if gate.sources[0].duration else ' for 0.5 sec'}: zero;'",
            subjects=("input",),
        )


def _resuming(gate: ir.Gate, written: Gate, program: ir.Program) -> Iterator[Diagnostic]:
    """Yield gates that resume without a person's reset or the controller's zero."""
    if gate.resume_on_zero:
        return
    lines = [
        line
        for line in gate.lines
        if line.stop is not None
        and not line.until_reset
        and not (line.lost == "input" and all(each.from_zero for each in gate.sources))
        and (line.action is None or not program.actions[line.action].latched)
    ]
    ends = [_ended(line, program) for line in lines]
    if not any(line.until_reset for line in gate.lines):
        ends.append("the gate's own start")
    if ends:
        listed = " and ".join([", ".join(ends[:-1]), ends[-1]] if ends[1:] else ends)
        yield report(
            codes.GATE_RESUMES_BY_ITSELF,
            f"commands to '{gate.target}' resume by themselves after {listed}",
            written.target.span,
            "add 'resume on zero command;', or write 'zero until reset' for a loss",
            tuple(Related(line.span, "this zero ends by itself") for line in lines),
        )


def _ended(line: ir.GateLine, program: ir.Program) -> str:
    return (
        f"a lost {line.lost}" if line.action is None else f"'{program.actions[line.action].name}'"
    )


def _lasting_bounds(gate: ir.Gate) -> Iterator[Diagnostic]:
    """Yield ends of limits that stay as they are when their messages stop."""
    for each in gate.inputs:
        if each.timeout_ns is None:
            yield report(
                codes.INPUT_WITHOUT_TIMEOUT,
                f"'{each.name}' has no timeout: when messages on {each.topic} stop, the gate to"
                f" '{gate.target}' still uses the last value as a limit",
                each.span,
                "read it through an input with a timeout: 'input NAME = topic … timeout 0.5 sec'",
            )


def _limits_to_zero(gate: ir.Gate) -> Iterator[Diagnostic]:
    """Yield limits that stop the robot without waiting for a reset or a zero command."""
    for line in gate.lines:
        to_zero = all(limit.ends == (0, 0) for limit in line.limits)
        if line.limits and to_zero and not line.is_standing:
            yield report(
                codes.GATE_LIMIT_TO_ZERO,
                "a limit of 0 stops like a zero, but ends by itself: neither 'until reset' nor"
                " 'resume on zero command' applies to it",
                line.span,
                "write 'zero' if the robot is to stand still",
            )


def _judged_too_late(gate: ir.Gate, program: ir.Program) -> Iterator[Diagnostic]:
    """Yield the rules that judge a gate's commands, to have the gate act on them."""
    read = {each.index: each.topic for each in program.inputs if each.topic in gate.topics}
    # A wait holds the command that its action is about.
    heeded = {line.action for line in gate.lines if line.action is not None and not line.wait_ns}
    told: set[tuple[int, int]] = set()
    deciding = Deciding(program)
    for behaviour in walk.behaviours(program):
        called = {each.action for each in behaviour.body if isinstance(each, ir.Trigger)}
        for action in sorted(called & heeded):
            nodes = deciding.behind(deciding.whole(behaviour))
            for index in sorted(index for kind, index in nodes if kind == "rule"):
                rule = program.rules[index]
                judged = sorted(read.keys() & _values_read(rule, program))
                if (index, action) in told or not judged:
                    continue
                told.add((index, action))
                name = program.actions[action].name
                line = next(e for e in gate.lines if e.action == action and not e.wait_ns)
                yield report(
                    codes.JUDGED_TOO_LATE,
                    f"'{rule.full_name}' judges the commands on '{read[judged[0]]}', which the gate"
                    f" passes: the one that makes it true has passed before '{name}' is active",
                    rule.span,
                    "let the gate limit the command itself, or judge what the robot does",
                    (Related(line.span, f"where the gate heeds '{name}'"),),
                )


def _values_read(rule: ir.Rule, program: ir.Program) -> set[int]:
    """Return the inputs of which a rule itself compares values: silence is no command."""
    found: set[int] = set()
    for part in walk.parts(rule.condition):
        if isinstance(part, ir.Unknown):
            continue
        for term in walk.terminals(part):
            leaves = walk.leaves(term)
            found |= {program.leaves[index].input for index in leaves}
    return found


# Wiring -----------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class _End:
    """A publisher or subscription of a system."""

    node: FlatNode
    port: FlatPort

    @property
    def span(self) -> Span:
        """Where it is connected, or its node where it is not."""
        wiring = self.port.wiring
        return wiring.span if wiring is not None else self.node.instance.name_span


def _wiring(gate: Gate, flat: FlatSystem, rules: Rules) -> Iterator[Diagnostic]:
    sources = [resolve_name(each.topic.text, "/") for each in gate.sources]
    target = resolve_name(gate.target.text, "/")
    commanding = list(_at(flat, target, PortKind.PUBLISHER))
    obeying = list(_at(flat, target, PortKind.SUBSCRIPTION))
    for end in commanding:
        if not _is_gate(end.node, target):
            yield report(
                codes.GATE_BYPASSED,
                f"{end.node.full_name} ({end.port.port.name}) bypasses the gate: it publishes"
                f" '{target}' directly",
                end.span,
                f"connect {end.port.port.name} to {' or '.join(sources)}, the input of the gate",
                (Related(gate.span, "the gate"),),
            )
    if target in sources or not (commanding or obeying):
        return
    if any(node.type is None for node in flat.nodes):
        return  # one of them, which another finding is about, may be the gate
    if any(_is_gate(node, target) for node in flat.nodes):
        return  # whether it is connected as the rules say is checked with the system
    name = gate_node_name(target)
    yield report(
        codes.GATE_NOT_IN_SYSTEM,
        f"system '{flat.system.name}' has no gate to '{target}': no node is a '{name}'",
        gate.target.span,
        f"the node type '{name}' is generated with the safety node: import it, and connect"
        f" {', '.join(sources)} and {target}, or write 'safety \"{rules.name}.deros\"'",
        _named(gate.target, flat),
        subjects=(name,),
    )


def _at(flat: FlatSystem, topic: str, kind: PortKind) -> Iterator[_End]:
    for node in flat.nodes:
        for port in node.ports:
            if port.port.kind is kind and port.topic == topic:
                yield _End(node, port)


def _is_gate(node: FlatNode, target: str) -> bool:
    return node.type is not None and is_gate_node(node.type.name, target)


def _named(target: Name, flat: FlatSystem) -> tuple[Related, ...]:
    topic = flat.topic(resolve_name(target.text, "/"))
    return (Related(topic.declaration.name_span, "the topic"),) if topic is not None else ()


# Ends -------------------------------------------------------------------------------------------


def _ends(gate: Gate, rules: Rules, topics: SystemTopics) -> Iterator[Diagnostic]:
    """Yield sources without a publisher and a target without a subscriber; gates count."""
    for each in gate.sources:
        yield from _source_end(each.topic, rules, topics)
    target = resolve_name(gate.target.text, "/")
    read = {resolve_name(e.topic.text, "/") for each in rules.gates for e in each.sources}
    known = topics.get(target)
    if target in read or (known is not None and (_open(known) or known.subscriptions)):
        return
    subscribed = [each.name for each in topics if each.subscriptions or _open(each)]
    yield report(
        codes.GATE_UNREAD,
        f"no node in the system subscribes to '{target}'",
        gate.target.span,
        did_you_mean(likely_topics(target, subscribed), gate.target.text, target)
        or f"if it is read outside the model, declare 'external topic {target}'",
        (Related(known.place, "the topic"),) if known is not None else (),
    )


def _source_end(name: Name, rules: Rules, topics: SystemTopics) -> Iterator[Diagnostic]:
    source = resolve_name(name.text, "/")
    fed = {resolve_name(each.target.text, "/") for each in rules.gates}
    known = topics.get(source)
    if known is None:
        hint = did_you_mean(likely_topics(source, topics.names), name.text, source)
        message = f"no used system has a topic '{source}'"
        if not rules.uses:
            hint = "'use \"FILE.system\" import NAME' names the system that has it"
        yield report(codes.RULE_TOPIC_NOT_IN_SYSTEM, message, name.span, hint)
    elif source not in fed and not _open(known) and not known.publishers:
        yield report(
            codes.RULE_TOPIC_NOT_PUBLISHED,
            f"no node in the system publishes '{source}'",
            name.span,
            f"if it is published outside the model, declare 'external topic {source}'",
            (Related(known.place, "the topic"),),
        )


def _open(topic: KnownTopic) -> bool:
    """Return whether the topic has, or may have, ends outside the model."""
    return bool(topic.external or topic.untyped)
