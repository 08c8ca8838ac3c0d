"""What the cells of a timeline mean: times, messages, effects and commands.

A **time** is ``1.5 s`` or ``20 ms``. One cell may have several, separated by commas, or those of a
sensor that goes on sending, both ends included: ``1 s to 2 s every 0.1 s``, ``1 s every 20 ms until
2 s``. Without an end it sends until that of the table (``time until 9 s`` in its head, else the
last time in it), without a beginning from its first period on. ``back to 1.5 s`` is a step of the
clock.

A **message** gives fields of one topic: those of an input, or of the topic itself
(``/imu.orientation.x``). Values are JSON, with NaN and infinities; ``time`` is the time of the
message, as a stamp. ``publishers = 2`` beside the fields says how many publishers the topic has
then, unless an input has that name. In place of a message stand ``reset`` (of the latched actions),
``reset /cmd_vel`` (of the gate to that topic), ``enable NAME``, ``disable NAME`` (of an optional
behaviour), ``heartbeat lost`` and ``heartbeat back``.

An **effect** is an action that is triggered, or it says ``reset`` or ``refused``. A **command** is
what a gate does as of that time: ``/cmd_vel zero``, ``/cmd_vel.linear.x = 0.1``.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator, Mapping
from decimal import Decimal
from typing import Any, NamedTuple, get_args

from deros.interfaces.durations import NS_PER_S
from deros.interfaces.fields import FieldPath, format_steps, parse_path
from deros.names.names import did_you_mean, near
from deros.rules.program.ir import Input, Program
from deros.simulation.gate_simulation import AnswerKind
from deros.simulation.timelines.lines import Cell, Line
from deros.simulation.timelines.timeline import decimal
from deros.simulation.trace import nanoseconds

_DIGITS = {"s": 0, "sec": 0, "ms": 3, "us": 6, "ns": 9}
_LONGEST = 200  # of a time
_TIME = re.compile(r"(\d{1,30}(?:\.\d{0,30})?) (s|sec|ms|us|ns)", re.ASCII)
_RANGE = re.compile(r"(?P<first>.+) to (?P<end>.+) every (?P<step>.+)")
_GOES_ON = re.compile(r"(?:(?P<first>.+) )?every (?P<step>.+?)(?: until (?P<end>.+))?")
_TARGET = re.compile(
    r'(/?\w[\w/]*)((?:\.\w+|\[(?:\d+|\w+ = (?:-?\d+|"(?:[^"\\]|\\.)*"))\])*) = (time\b)?'
)
_COMMAND = re.compile(r"(/\w[\w/]*) ([a-z ]+)(?=, |$)")
_HEARTBEATS = {"heartbeat lost": False, "heartbeat back": True}
_EFFECTS = {"": "trigger", "reset": "reset", "refused": "refused"}
ANSWERS: Mapping[str, str] = {each.replace("_", " "): each for each in get_args(AnswerKind)}
"""What a gate may be said to do, and the event of that name."""

MOST = 1_000_000
"""The greatest number of messages of a timeline."""

BACK = "back to "

PUBLISHERS = "publishers"
"""Beside the fields of a message: how many publishers its topic has."""

_COUNT = re.compile(r"[1-9]\d{0,8}", re.ASCII)


class Field(NamedTuple):
    """A field of a message: its input or topic, the path within it, and its value as JSON."""

    target: str
    path: str
    value: str


# Times --------------------------------------------------------------------------------------------


def time_of(text: str, cell: Cell) -> int:
    """Return a time in nanoseconds.

    Raises:
        Fault: it is none.
    """
    written = _TIME.fullmatch(text)
    t_ns = None
    if written:
        t_ns = nanoseconds(f"{Decimal(written[1]).scaleb(-_DIGITS[written[2]]):f}")
    if t_ns is None:
        raise cell.fault(f"'{text}' is not a time", "write '1.5 s' or '20 ms'")
    return t_ns


def last_of(text: str, cell: Cell) -> int | None:
    """Return the last time that a part of a cell means; ``None`` if that is the table's end."""
    written = _several(text, cell)
    if not written:
        return time_of(text, cell)
    return time_of(written["end"], cell) if written["end"] else None


def times_of(text: str, cell: Cell, until: Callable[[], int | None]) -> list[int]:
    """Return each of the times that a part of a cell means: one, or those of a range.

    Args:
        text: the part.
        cell: the cell.
        until: returns the end of the table, if it has one.
    """
    written = _several(text, cell)
    if not written:
        return [time_of(text, cell)]
    step = time_of(written["step"], cell)
    first = time_of(written["first"], cell) if written["first"] else step
    end = time_of(written["end"], cell) if written["end"] else until()
    if end is None:
        hint = "write 'every 20 ms until 3 s', 'time until 3 s' in the head, or a last row"
        raise cell.fault("messages without an end", hint)
    if not 0 < step <= end - first:
        raise cell.fault("a range of less than two times")
    if (end - first) // step >= MOST:
        raise cell.fault(f"a range of more than {MOST:,} times", "shorten it, or send less often")
    return list(range(first, end + 1, step))


def _several(text: str, cell: Cell) -> re.Match[str] | None:
    if len(text) > _LONGEST:
        raise cell.fault("not a time: it is too long")
    return _RANGE.fullmatch(text) or _GOES_ON.fullmatch(text)


def is_range(text: str) -> bool:
    """Return whether a cell means several times."""
    return ", " in text or "every " in text


# Messages -----------------------------------------------------------------------------------------


class Messages:
    """Writes the cells of messages as lines of a trace."""

    def __init__(self, program: Program, fields: Mapping[str, Line]) -> None:
        """Write for a program.

        Args:
            program: whose inputs the cells name.
            fields: the rows that list the fields of every message of a topic.
        """
        self._inputs = {each.name: each for each in program.inputs}
        self._fields = {
            topic: [*fields_of(row.cells[1])] for topic, row in fields.items() if row.cells[1].text
        }

    def line(self, t_ns: int, cell: Cell) -> str:
        """Return the line for what a cell says at a time."""
        time = f'"t": "{decimal(t_ns)}"'
        word, _, name = cell.text.partition(" ")
        if cell.text in _HEARTBEATS:
            return f'{{{time}, "heartbeat": {json.dumps(_HEARTBEATS[cell.text])}}}'
        if word == "reset" and "=" not in name:
            return f'{{{time}, "reset": {json.dumps(name or True)}}}'
        if word in ("enable", "disable") and name and "=" not in name:
            return f'{{{time}, "{word}": {json.dumps(name)}}}'
        topic, data, beside = self._message(cell)
        sec, nanosec = divmod(t_ns, NS_PER_S)
        stamp = f'{{"sec": {sec}, "nanosec": {nanosec}}}'
        shown = (
            f"{json.dumps(path)}: {stamp if each == 'time' else each}"
            for path, each in data.items()
        )
        return f'{{{time}, "topic": "{topic}", "data": {{{", ".join(shown)}}}{beside}}}'

    def _message(self, cell: Cell) -> tuple[str, dict[str, str], str]:
        """Return the topic of a message, its fields, and what a line of a trace has beside them."""
        data: dict[str, str] = {}
        beside = ""
        topics = set()
        for each in fields_of(cell):
            if (each.target, each.path) == (PUBLISHERS, "") and PUBLISHERS not in self._inputs:
                if not _COUNT.fullmatch(each.value) or beside:
                    hint = "write 'publishers = 2' once beside the fields: how many the topic has"
                    raise cell.fault("not a number of publishers", hint)
                beside = f', "{PUBLISHERS}": {each.value}'
                continue
            topic, within = each.target, ""
            if not topic.startswith("/"):
                found = self._input(topic, cell)
                topic, within = found.topic, format_steps(found.path)
            topics.add(topic)
            data[f"{within}{each.path}".removeprefix(".")] = each.value
        if len(topics) != 1 or "" in data:
            hint = "a row has the fields of one topic: '/imu.angular_velocity.z = 0.2'"
            raise cell.fault("not the fields of one message", hint)
        (topic,) = topics
        common = {f"{each.target}{each.path}": each.value for each in self._fields.get(topic, ())}
        return topic, common | data, beside

    def _input(self, name: str, cell: Cell) -> Input:
        if name not in self._inputs:
            hint = did_you_mean(near(name, self._inputs))
            hint = hint or "name an input of the rules, or a field of a topic: '/odom.pose'"
            raise cell.fault(f"no input '{name}'", hint)
        return self._inputs[name]


def fields_of(cell: Cell) -> Iterator[Field]:
    """Yield the fields that a cell gives."""
    text, place = cell.text, 0
    while place < len(text):
        target = _TARGET.match(text, place)
        if not target:
            hint = "such as 'speed = 0.6' or '/imu.angular_velocity.z = 0.2'"
            raise cell.fault("fields are written NAME.PATH = VALUE, and separated by ', '", hint)
        end = target.end()
        if not target[3]:
            _, end = _value(cell, end)
        if text[end : end + 2] not in ("", ", "):
            raise cell.fault("values are separated by ', '")
        yield Field(target[1], target[2], target[3] or text[target.end() : end])
        place = end + 2


def _value(cell: Cell, start: int) -> tuple[Any, int]:
    """Return the value at a place of a cell, and its end."""
    try:
        return json.JSONDecoder(parse_float=Decimal).raw_decode(cell.text, start)
    except (ValueError, RecursionError, ArithmeticError) as error:
        hint = 'values are written 0.6, true, "text", [1, 2] or NaN'
        raise cell.fault(f"not a value: {cell.text[start:]}", hint) from error


# Effects and commands -----------------------------------------------------------------------------


def effects_of(cell: Cell, program: Program) -> Iterator[tuple[str, str]]:
    """Yield the actions of a cell, and what happens to each."""
    names = [each.name for each in program.actions]
    for each in filter(None, cell.text.split(", ")):
        action, _, word = each.partition(" ")
        if word not in _EFFECTS or action not in names:
            hint = did_you_mean(near(action, names)) if action not in names else ""
            hint = hint or "an effect is an action: 'stop', 'stop reset' or 'stop refused'"
            raise cell.fault(f"unknown effect '{each}'", hint)
        yield action, _EFFECTS[word]


def _path(text: str, cell: Cell) -> FieldPath:
    """Return the path of a field of a command."""
    if '"' in text or "=" in text:
        raise cell.fault("elements of commands are named by their index")
    return parse_path(text)


class Answer(NamedTuple):
    """What a gate does: an event, or the value of a field of the last command."""

    gate: str
    event: str
    path: FieldPath = ()
    value: Any = None


def commands_of(cell: Cell, program: Program) -> Iterator[Answer]:
    """Yield what a cell says of gates."""
    gates = [each.target for each in program.gates]
    text, place = cell.text, 0
    while place < len(text):
        target = _TARGET.match(text, place)
        word = _COMMAND.match(text, place)
        if target and target[2] and not target[3]:
            value, end = _value(cell, target.end())
            answer = Answer(target[1], "", _path(target[2], cell), value)
        elif word and word[2] in ANSWERS:
            answer, end = Answer(word[1], ANSWERS[word[2]]), word.end()
        else:
            words = ", ".join(ANSWERS)
            hint = f"'/cmd_vel.linear.x = 0.1', or '/cmd_vel' and one of: {words}"
            raise cell.fault(f"unknown command '{text[place:]}'", hint)
        if answer.gate not in gates:
            hint = did_you_mean(near(answer.gate, gates)) or f"gates lead to {', '.join(gates)}"
            raise cell.fault(f"no gate leads to '{answer.gate}'", hint if gates else "")
        if text[end : end + 2] not in ("", ", "):
            raise cell.fault("commands are separated by ', '")
        yield answer
        place = end + 2
