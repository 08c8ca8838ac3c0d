"""What a recording shows, and nothing else: delays, and whether the rules explain the events.

A recording is the folder of a run. Its delays are taken from the recorder's file, whose times are
of the machine's steady clock; where the run is simulated, the recorded ``/clock`` says which
simulated time that was. The rules are played over the messages that the safety node took, at the
times at which it took them, by the player of ``deros simulate``; its events have to be those that
the node has published, each at the same nanosecond.

Where nothing says when the node took which message (in C++), the rules are played over the times at
which the recorder has received them. Then the events have to be the same in the same order, and the
analysis tells how far they are apart.
"""

from __future__ import annotations

import json
from bisect import bisect_right
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path
from typing import Any

from deros.diagnostics import SourceFile
from deros.models.rules import Rules
from deros.pipeline.workspace import Workspace, load
from deros.rules.engine.engine import Engine
from deros.rules.program.ir import Program
from deros.simulation.simulate import Explained, play, seconds
from deros.simulation.trace import read_trace

from .recording import MONITOR, NODE, RECORDER, Recorded, RecordingError, decode, read
from .robots import GRACE_NS, Experiment, Robot

TRACE = "trace.jsonl"
"""The file of a run with what the safety node took, for ``deros simulate``."""

_KINDS = ("trigger", "reset", "refused", "clock_step")
_CLOCK = "/clock"
APART = 50_000_000
"""By how many ns the receipts of the recorder and of the safety node may differ, at most."""

_SOON = 500_000_000
"""Nanoseconds after the end of a fault in which its action may still come."""


@dataclass(frozen=True, slots=True)
class Happening:
    """An event, of the safety node or of the player: at which ns, what, and by which behaviour."""

    at: int
    kind: str
    action: str
    behaviour: str
    arguments: str

    def __str__(self) -> str:
        """Return it as one line."""
        by = f" by {self.behaviour}" if self.behaviour else ""
        arguments = f"({self.arguments})" if self.arguments else ""
        return f"{seconds(self.at)} {self.kind} {self.action}{arguments}{by}"


@dataclass(frozen=True, slots=True)
class Series:
    """The times of an experiment, from the fulfilled condition to the action, in seconds.

    ``lost`` tells how many times the action has not come.
    """

    experiment: Experiment
    times: tuple[float, ...]
    lost: int


@dataclass(frozen=True, slots=True)
class Analysis:
    """What a recording shows.

    Attributes:
        series: one for each experiment of the robot.
        events: how many events the safety node and the player have in common.
        differences: what one of them has and the other has not, in words; there should be none.
        apart: by how many ns an event of both differs in time, at most; ``None`` where the times
            have to be the same.
    """

    series: tuple[Series, ...]
    events: int
    differences: tuple[str, ...]
    apart: int | None = None


def analyse(robot: Robot, rules: Path, folder: Path, is_watched: bool = True) -> Analysis:
    """Return what the recording in a folder shows; write what ``deros simulate`` plays beside it.

    Args:
        robot: whose experiments were recorded.
        rules: its rules.
        folder: that of the run.
        is_watched: whether the safety node has noted when it took which message.

    Raises:
        RecordingError: if it cannot be read, or the rules cannot be played over it.
    """
    recorded = read(folder / RECORDER)
    clock = _Clock(recorded)
    of_node = _reported(recorded, robot.node)
    program, workspace = _load(rules)
    latched = {each.name for each in program.actions if each.latched}
    if is_watched:
        taken = read(folder / NODE)
    else:
        taken = _as_received(robot, recorded, [e for e in of_node if e.action in latched], clock)
    last = max(each.received for each in taken)
    of_node = [each for each in of_node if each.at <= last]
    of_player = _played(program, workspace, taken, folder / TRACE)
    series = tuple(_series(each, recorded, clock) for each in robot.experiments)
    apart = None
    if not is_watched:
        of_node, apart = _aligned(of_node, of_player)
    common = (Counter(of_node) & Counter(of_player)).total()
    return Analysis(series, common, tuple(_differences(of_node, of_player)), apart)


def _as_received(
    robot: Robot, recorded: Iterable[Recorded], of_latched: Iterable[Happening], clock: _Clock
) -> list[Recorded]:
    """Return what the safety node took, as if it had done so when the recorder did.

    Its rules begin with the first message. What no topic shows, when the operator has asked for a
    reset, is taken from what the node has answered: the events of latched actions. Others are
    reset by their rules.
    """
    topics = {each.topic for each in robot.sensors}
    messages = sorted((each for each in recorded if each.topic in topics), key=_received)
    taken = [replace(each, received=clock.at(each.received)) for each in messages]
    if not taken:
        raise RecordingError(f"{RECORDER}: has no message of a sensor")
    start = json.dumps({"start": True, "grace_ns": GRACE_NS, "latched": []}).encode()
    reset = json.dumps({"reset": True}).encode()
    began = taken[0].received
    # All that one reset has led to has one time.
    asked = dict.fromkeys(each.at for each in of_latched if each.kind in ("reset", "refused"))
    taken += [Recorded(MONITOR, "", at, at, reset) for at in asked]
    return [Recorded(MONITOR, "", began, began, start), *sorted(taken, key=_received)]


def _received(message: Recorded) -> int:
    return message.received


def _aligned(
    of_node: Sequence[Happening], of_player: Sequence[Happening]
) -> tuple[list[Happening], int]:
    """Return the events of the node with the times of the player's, and how far they were apart.

    An event that is further apart than :data:`APART`, or is another one, keeps its time.
    """
    aligned, apart = [], 0
    for position, each in enumerate(of_node):
        other = of_player[position] if position < len(of_player) else None
        if other is not None and each == replace(other, at=each.at):
            distance = abs(each.at - other.at)
            if distance <= APART:
                apart = max(apart, distance)
                each = other
        aligned.append(each)
    return aligned, apart


# The rules, played over what the node took -------------------------------------------------------


def _played(
    program: Program, workspace: Workspace, taken: Sequence[Recorded], trace: Path
) -> list[Happening]:
    start, grace = _begin(taken)
    text = "".join(f"{json.dumps(each)}\n" for each in _lines(taken, program, start))
    trace.write_text(text, encoding="utf-8")
    lines = read_trace(SourceFile(str(trace), text), program, workspace.store)
    if lines.diagnostics:
        raise RecordingError(f"{trace}: {lines.diagnostics[0].message}")
    events = [
        each.event
        for each in play(Engine(program, grace_ns=grace), lines.lines)
        if isinstance(each, Explained)
    ]
    return [
        Happening(
            start + each.t_ns,
            each.kind,
            each.action,
            each.behaviour or "",
            ", ".join(map(repr, each.arguments)),
        )
        for each in events
    ]


def _load(rules: Path) -> tuple[Program, Workspace]:
    workspace = load([str(rules)])
    model = workspace.files[0].model
    program = workspace.builds.of(model).program if isinstance(model, Rules) else None
    if program is None:
        raise RecordingError(f"{rules}: these rules cannot be played")
    return program, workspace


def _begin(taken: Sequence[Recorded]) -> tuple[int, int]:
    """Return when the rules began, and by how much later their timeouts did, in ns."""
    for each in taken:
        if each.topic == MONITOR and (told := json.loads(each.data)).get("start"):
            if told["latched"]:
                raise RecordingError("an action was latched from before the recording")
            return each.received, int(told["grace_ns"])
    raise RecordingError(f"{NODE}: does not say when the rules began")


def _lines(taken: Sequence[Recorded], program: Program, start: int) -> Iterator[dict[str, Any]]:
    """Yield the lines of a trace, which begins with the rules at 0."""
    wanted: dict[str, set[str]] = {topic: set() for topic in program.topics}
    for leaf in program.leaves:
        first = leaf.path[0] if leaf.path else None
        if isinstance(first, str):
            wanted[program.inputs[leaf.input].topic].add(first)
    for each in taken:
        at = seconds(each.received - start)
        if each.topic != MONITOR:
            message = decode(each)
            data = {name: _plain(getattr(message, name)) for name in sorted(wanted[each.topic])}
            yield {"t": at, "topic": each.topic, "data": data}
        elif json.loads(each.data).get("reset"):
            yield {"t": at, "reset": True}


def _plain(value: Any) -> Any:
    """Return a value as JSON has it; not-a-number and infinity are texts."""
    if hasattr(value, "__dataclass_fields__"):
        names = [each for each in value.__dataclass_fields__ if not each.startswith("__")]
        return {each: _plain(getattr(value, each)) for each in names}
    if hasattr(value, "tolist"):  # an array
        value = value.tolist()
    if isinstance(value, list):
        return [_plain(each) for each in value]
    if isinstance(value, float) and not float("-inf") < value < float("inf"):
        return {"nan": "NaN", "inf": "Infinity", "-inf": "-Infinity"}[str(value)]
    return value


def _reported(recorded: Iterable[Recorded], node: str) -> list[Happening]:
    """Return the events that the safety node has published, in their order."""
    found = []
    for each in recorded:
        if each.topic != f"/{node}/events":
            continue
        values = {pair.key: pair.value for pair in decode(each).values}
        if values.get("kind") in _KINDS:
            found.append(
                Happening(
                    int(values["time_ns"]),
                    values["kind"],
                    values["action"],
                    values.get("behaviour", ""),
                    values.get("arguments", ""),
                )
            )
    return found


def _differences(of_node: Sequence[Happening], of_player: Sequence[Happening]) -> Iterator[str]:
    """Yield what only one of two lists of events has, and whether their order is another."""
    for each in (Counter(of_node) - Counter(of_player)).elements():
        yield f"only the safety node has: {each}"
    for each in (Counter(of_player) - Counter(of_node)).elements():
        yield f"only the player has: {each}"
    if Counter(of_node) == Counter(of_player) and of_node != of_player:
        yield "the safety node has the same events in another order"


# Delays ------------------------------------------------------------------------------------------


class _Clock:
    """Times of the machine's steady clock as times of the run's clock, in ns."""

    def __init__(self, recorded: Iterable[Recorded]) -> None:
        ticks = [each for each in recorded if each.topic == _CLOCK]
        self._shown = [_nanoseconds(decode(each).clock) for each in ticks]
        self._sent = [each.sent for each in ticks]

    def at(self, instant: int) -> int:
        """Return what the clock showed at an instant: the last step that had been sent.

        Another process may have received that step earlier than the recorder.
        """
        if not self._sent:
            return instant
        return self._shown[max(bisect_right(self._sent, instant) - 1, 0)]


def _nanoseconds(time: Any) -> int:
    return int(time.sec) * 1_000_000_000 + int(time.nanosec)


def _series(experiment: Experiment, recorded: Sequence[Recorded], clock: _Clock) -> Series:
    """Find each time that the condition is fulfilled, and the action that follows."""
    actions = _beginnings(recorded, experiment.action)
    times, lost = [], 0
    for first, end in _fulfilled(recorded, experiment):
        answer = next((each for each in actions if first.sent < each.received < end), None)
        if answer is None:
            lost += 1
        else:
            times.append((clock.at(answer.received) - clock.at(first.sent)) / 1e9)
    return Series(experiment, tuple(times), lost)


def _beginnings(recorded: Iterable[Recorded], topic: str) -> list[Recorded]:
    """Return the messages with which an action becomes active."""
    states = sorted((each for each in recorded if each.topic == topic), key=lambda e: e.received)
    values = [bool(decode(each).data) for each in states]
    pairs = zip(states[1:], pairwise(values), strict=True)
    return [each for each, (before, now) in pairs if now and not before]


def _fulfilled(
    recorded: Iterable[Recorded], experiment: Experiment
) -> Iterator[tuple[Recorded, int]]:
    """Yield the first message of each row of them that fulfil the condition.

    With it comes the time until which its action may come.
    """
    messages = [each for each in recorded if each.topic == experiment.topic]
    first = None
    for each in sorted(messages, key=lambda message: message.sent):
        if experiment.is_fulfilled(decode(each)):
            first = first or each
        elif first is not None:
            yield first, each.sent + _SOON
            first = None
    if first is not None:
        yield first, messages[-1].sent + _SOON
