"""Gates in the intermediate form: what applies when, and what it does to commands."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Literal

from deros.diagnostics import Span
from deros.interfaces.fields import FieldPath
from deros.interfaces.types import FieldType, InterfaceType
from deros.rules.program.values import Scalar
from deros.systems.tunables import TunableConstant


@dataclass(frozen=True, slots=True)
class InputBound:
    """An end of a standing limit: a field of an input times ``factor``, in the limited one's unit.

    It is unknown, which stands for 0, before the first message, after ``timeout_ns`` without one
    (``None``: never), and while the field is NaN or missing in its array.

    Attributes:
        text: as written.
        name: of what is read: ``speed_limit.data``.
        topic: that the messages come on, and ``type`` their type.
        path: of the field, and ``field_type`` its type.
    """

    text: str
    name: str
    topic: str
    type: InterfaceType
    path: FieldPath
    field_type: FieldType
    timeout_ns: int | None
    factor: float
    span: Span = field(compare=False, repr=False)

    @property
    def key(self) -> tuple[str, FieldPath, int | None]:
        """What is the same of ends that one number gives."""
        return self.topic, self.path, self.timeout_ns


@dataclass(frozen=True, slots=True)
class TunedBound:
    """An end of a standing limit: a tunable constant times ``factor``; ``text`` as written."""

    text: str
    constant: TunableConstant
    factor: float


@dataclass(frozen=True, slots=True)
class Limit:
    """The interval, ends included, that a gate keeps one numeric field of the command in."""

    path: FieldPath
    type: FieldType
    lower: int | float | InputBound | TunedBound
    upper: int | float | InputBound | TunedBound

    @property
    def ends(self) -> tuple[int | float | InputBound | TunedBound, ...]:
        """Both ends, the lower one first."""
        return self.lower, self.upper

    @property
    def interval(self) -> tuple[int | float, int | float]:
        """Both ends of a limit that is not open."""
        assert isinstance(self.lower, int | float), self
        assert isinstance(self.upper, int | float), self
        return self.lower, self.upper

    @property
    def is_open(self) -> bool:
        """Whether an end is given by messages, or by a parameter."""
        return any(isinstance(end, InputBound | TunedBound) for end in self.ends)


@dataclass(frozen=True, slots=True)
class StopField:
    """A field of what a gate publishes to stop.

    ``value`` is, of a ramp, the rate per second; of what is sent, the field's value, where ``None``
    empties an array.
    """

    path: FieldPath
    type: FieldType
    value: Scalar | None

    @property
    def zero(self) -> Scalar:
        """What is 0, false or empty, of the kind of ``value``, which there has to be."""
        assert self.value is not None, self.path
        return type(self.value)()


@dataclass(frozen=True, slots=True)
class Stop:
    """What a gate publishes to stop: zeros along ``ramps``, the fields ``sent``, or the like."""

    kind: Literal["zero", "send", "hold", "silence"] = "zero"
    ramps: tuple[StopField, ...] = ()
    sent: tuple[StopField, ...] = ()


@dataclass(frozen=True, slots=True)
class GateLine:
    """When a gate does something to the command, and what.

    ``action`` is the index of a bound action; without one the line is about the loss, for
    ``lost_ns``, of what ``lost`` names; without either its limits stand. It has either a ``stop``,
    which lasts ``until_reset`` where that is written, or ``limits``; or what moves waits for
    ``wait_ns`` of the action.
    """

    action: int | None
    lost: Literal["heartbeat", "input"] | None
    lost_ns: int | None
    limits: tuple[Limit, ...]
    span: Span = field(compare=False, repr=False)
    until_reset: bool = False
    stop: Stop | None = None
    wait_ns: int | None = None

    @property
    def is_standing(self) -> bool:
        """Whether it always applies."""
        return self.action is None and self.lost is None


@dataclass(frozen=True, slots=True)
class Source:
    """A topic of commands, which pass while the last one is younger than ``silent_ns``.

    A single source needs no time. ``from_zero``: each time it takes over, it has to command zero
    first.
    """

    topic: str
    silent_ns: int | None = None
    from_zero: bool = False


@dataclass(frozen=True, slots=True)
class Gate:
    """What safety lets through of the commands on ``sources``, earlier ones first, to ``target``.

    ``period_ns`` is that at which zeros are published. ``resume_on_zero``: after any stop, commands
    pass again only when the controller has commanded zero. What a gate does with its lines is
    defined by the class that plays :func:`deros.rules.gates.gate_table.gate_table`.
    """

    index: int
    sources: tuple[Source, ...]
    target: str
    type: InterfaceType
    period_ns: int
    lines: tuple[GateLine, ...]
    span: Span = field(compare=False, repr=False)
    description: str = ""
    resume_on_zero: bool = False

    @property
    def topics(self) -> tuple[str, ...]:
        """The topics of its sources."""
        return tuple(each.topic for each in self.sources)

    @property
    def inputs(self) -> tuple[InputBound, ...]:
        """The numbers from messages that its limits need, each once."""
        found: dict[object, InputBound] = {}
        for end in self._ends():
            if isinstance(end, InputBound):
                found.setdefault(end.key, end)
        return tuple(found.values())

    @property
    def input_types(self) -> dict[str, InterfaceType]:
        """The types of the topics of these messages, by the topics."""
        return {each.topic: each.type for each in self.inputs}

    @property
    def tunables(self) -> tuple[TunableConstant, ...]:
        """The tunable constants that its limits need, each once, by their names."""
        ends = (end for end in self._ends() if isinstance(end, TunedBound))
        found = {end.constant.name: end.constant for end in ends}
        return tuple(found[name] for name in sorted(found))

    def _ends(self) -> Iterator[object]:
        for line in self.lines:
            for limit in line.limits:
                yield from limit.ends

    @property
    def is_latching(self) -> bool:
        """Whether a line stops until a reset, so that the gate has one."""
        return any(line.until_reset for line in self.lines)
