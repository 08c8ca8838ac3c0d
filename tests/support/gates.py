"""Random gates, what happens to them, and generated gates that answer as the reference does."""

from __future__ import annotations

import math
import random
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from types import SimpleNamespace
from typing import Any, Protocol

from hypothesis import strategies as st

from deros.diagnostics import SourceFile, Span
from deros.generators.gate.python.generate import MODULES, render
from deros.generators.gate.python.interface import gate_nodes
from deros.generators.gate.python.view import GateView, gate_view
from deros.generators.runtime.python.deros_runtime import gate_logic
from deros.generators.safety_node.node import safety_node
from deros.generators.text.python import expression
from deros.interfaces.fields import FieldPath
from deros.interfaces.message_fields import field_type, unsized_arrays
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import FieldType, InterfaceType
from deros.rules.compiler.scope.topics import SystemTopics
from deros.rules.gates.gate_engine import Output, OutputKind
from deros.rules.program.commands import Message
from deros.rules.program.ir import (
    Action,
    Binding,
    Gate,
    GateLine,
    InputBound,
    Limit,
    Program,
    Source,
    Stop,
    StopField,
    TunableConstant,
    TunedBound,
)

STORE = InterfaceStore()
SOURCE = SourceFile("random.deros", "".join(f"line {n};\n" for n in range(1, 20)))

Path = FieldPath


def span(line: int) -> Span:
    """Return the span of a whole line of a source that stands for random gates."""
    start = SOURCE.text.index(f"line {line};")
    return Span(SOURCE, start, start + len(f"line {line};"))


def message_type(text: str) -> InterfaceType:
    """Return the message type spelt ``package.Name``."""
    package, name = text.split(".")
    return InterfaceType(package, "msg", name)


def _bound(index: int, name: str, topic: str, kind: str, value: bool | int) -> Action:
    binding = Binding(topic, message_type(kind), ("data",), value)
    return Action(index, name, (), binding, None, False, (), span(index + 1))


ACTIONS = (
    _bound(0, "stop", "/stop", "std_msgs.Bool", True),
    _bound(1, "go", "/go", "std_msgs.Bool", False),
    _bound(2, "slow", "/mode", "std_msgs.UInt8", 1),
    _bound(3, "slower", "/mode", "std_msgs.UInt8", 2),
)
"""Actions of all kinds: two share a topic, and one is active when its field is false."""

COMMANDS: Mapping[str, tuple[Path, ...]] = {
    "geometry_msgs.Twist": (("linear", "x"), ("linear", "y"), ("angular", "z")),
    "geometry_msgs.TwistStamped": (("twist", "linear", "x"), ("twist", "angular", "z")),
    "std_msgs.Int32": (("data",),),
    "std_msgs.Float64MultiArray": (("data", 0), ("data", 2)),
    "trajectory_msgs.JointTrajectoryPoint": (("positions", 0), ("velocities", 1)),
    "trajectory_msgs.JointTrajectory": (("points", 0, "positions", 1), ("points", 1, "effort", 0)),
}
"""Types of commands, and the fields of each that random limits, ramps and sends speak of."""


# Random gates -------------------------------------------------------------------------------------


@st.composite
def gates(draw: st.DrawFn) -> Gate:
    """Draw a gate; its times are a few nanoseconds, so that instants coincide often."""
    name = draw(st.sampled_from(sorted(COMMANDS)))
    sources = random_sources(draw(st.randoms()))
    lines = [_timed(head, sources) for head in draw(st.lists(_heads, min_size=1, max_size=6))]
    return Gate(
        index=0,
        sources=sources,
        target="/robot/command",
        type=message_type(name),
        period_ns=draw(st.integers(1, 12)),
        lines=tuple(
            _line(
                head,
                _opened(draw(st.randoms()), head, draw(_limits(name))),
                random_stop(draw(st.randoms()), message_type(name), COMMANDS[name]),
                draw(_rarely),
                number,
            )
            for number, head in enumerate(_once(lines), start=2)
        ),
        span=span(1),
        resume_on_zero=draw(_rarely),
    )


@st.composite
def gates_with_bounds(draw: st.DrawFn) -> Gate:
    """Draw a gate that always keeps to limits whose ends messages and parameters give."""
    gate = draw(gates())
    rng = draw(st.randoms())
    limits = tuple(
        with_open_end(rng, limit)
        for path in COMMANDS[f"{gate.type.package}.{gate.type.name}"]
        for limit in opened(rng, (_limit(gate.type, path, -2, 2),))
    )
    lines = tuple(line for line in gate.lines if not line.is_standing)
    standing = GateLine(None, None, None, limits, span(8))
    return replace(gate, lines=(*lines, standing))


def random_sources(rng: random.Random) -> tuple[Source, ...]:
    """Return one source without a time, or up to three with one."""
    if rng.random() < 0.5:
        return (Source("/wish"),)
    return tuple(
        Source(topic, rng.randint(1, 60), rng.random() < 0.3)
        for topic in ("/wish", "/second", "/third")[: rng.randint(1, 3)]
    )


def _timed(head: Any, sources: Sequence[Source]) -> Any:
    """Return the head of a line without the time of a lost input, where the sources have it."""
    action, lost, lost_ns = head
    return action, lost, 0 if lost == "input" and sources[0].silent_ns else lost_ns


_rarely = st.sampled_from((False, False, True))


_STANDING = (None, None, None)


def _line(
    head: Any, limits: tuple[Limit, ...], stop: Stop, until_reset: bool, number: int
) -> GateLine:
    action, lost, lost_ns = head
    if lost == "wait":
        return GateLine(action, None, None, (), span(number), wait_ns=lost_ns)
    if limits or head == _STANDING:
        return GateLine(action, lost, lost_ns, limits, span(number))
    return GateLine(action, lost, lost_ns, (), span(number), until_reset, stop)


_heads: st.SearchStrategy[tuple[Any, Any, Any]] = st.one_of(
    st.tuples(st.integers(0, len(ACTIONS) - 1), st.none(), st.none()),
    st.tuples(st.none(), st.sampled_from(("heartbeat", "input")), st.integers(1, 60)),
    st.just(_STANDING),
    st.tuples(st.integers(0, len(ACTIONS) - 1), st.just("wait"), st.integers(1, 30)),
)


def _once(heads: list[Any]) -> list[Any]:
    """Return the heads of lines with one of standing limits: two could name the same field."""
    first = heads.index(_STANDING) if _STANDING in heads else 0
    return [head for i, head in enumerate(heads) if head != _STANDING or i == first]


def random_stop(rng: random.Random, kind: InterfaceType, paths: Sequence[Path]) -> Stop:
    """Return how a line stops; ramps take some tens of the nanoseconds that random gates live."""
    how = rng.choice(("zero", "zero", "zero", "send", "hold", "silence"))
    some = [path for path in paths if rng.random() < 0.5]
    if how == "zero":
        rates = (1e7, 5e7, 1e8, 1e9)
        fields = (
            StopField(path, field_type(STORE, kind, path), rng.choice(rates)) for path in some
        )
        return Stop(ramps=tuple(fields))
    if how == "send" and paths:
        return Stop("send", sent=tuple(_sent(rng, kind, path) for path in some or paths[:1]))
    return Stop("silence" if how == "silence" else "hold")


def _sent(rng: random.Random, kind: InterfaceType, path: Path) -> StopField:
    """Return a field with a number to send, or the array around it, to be emptied."""
    field = field_type(STORE, kind, path)
    around = next(iter(unsized_arrays(STORE, kind, path)), None)
    if around is not None and rng.random() < 0.2:
        return StopField(tuple(around[0]), field_type(STORE, kind, around[0]), None)
    value = rng.choice((0, 0, 1, 5 if str(field.base)[0] in "ub" else -3))
    return StopField(path, field, value / 2 if field.is_float else value)


@st.composite
def _limits(draw: st.DrawFn, name: str) -> tuple[Limit, ...]:
    paths = draw(st.lists(st.sampled_from(COMMANDS[name]), unique=True))
    limits = []
    for path in paths:
        lower, upper = draw(st.integers(-2, 0)), draw(st.integers(0, 2))
        limits.append(_limit(message_type(name), path, lower, upper))
    return tuple(limits)


def _limit(kind: InterfaceType, path: Path, lower: int, upper: int) -> Limit:
    """Return a limit with ends as the compiler has them: of a float, halves, written as floats."""
    field = field_type(STORE, kind, path)
    ends = (lower / 2, upper / 2) if field.is_float else (lower, upper)
    return Limit(path, field, *ends)


READINGS: Mapping[str, str] = {"/greatest": "std_msgs.Float64", "/least": "std_msgs.Float32"}
"""Topics with numbers for limits, and their types: of one of them, numbers are rounded."""

_TUNED = TunableConstant("most", 1.0, 0.0, 2.0, "m/s", span(19))


def random_end(rng: random.Random, sign: int) -> InputBound | TunedBound:
    """Return an end of a limit that a message or a parameter gives; ``sign`` is its side of 0."""
    if rng.random() < 0.2:
        return TunedBound("most", _TUNED, sign * rng.choice((0.5, 1.0)))
    topic = rng.choice(sorted(READINGS))
    timeout_ns = None if rng.random() < 0.2 else 1 + rng.choice((4, 20, 50))
    kind = message_type(READINGS[topic])
    factor = rng.choice((1.0, 1.0, -1.0, 0.25))
    return InputBound(
        f"{topic}.data",
        f"{topic}.data",
        topic,
        kind,
        ("data",),
        field_type(STORE, kind, ("data",)),
        timeout_ns,
        factor,
        span(19),
    )


def opened(rng: random.Random, limits: tuple[Limit, ...]) -> tuple[Limit, ...]:
    """Return the limits of a standing line with some ends that others give."""
    return tuple(
        replace(
            limit,
            lower=random_end(rng, -1) if rng.random() < 0.4 else limit.lower,
            upper=random_end(rng, 1) if rng.random() < 0.6 else limit.upper,
        )
        for limit in limits
    )


def with_open_end(rng: random.Random, limit: Limit) -> Limit:
    """Return a limit with an end that others give, on whichever side of zero."""
    end = random_end(rng, rng.choice((-1, 1)))
    return replace(limit, lower=end) if rng.random() < 0.5 else replace(limit, upper=end)


def _opened(rng: random.Random, head: Any, limits: tuple[Limit, ...]) -> tuple[Limit, ...]:
    return opened(rng, limits) if head == _STANDING else limits


# Random events ------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Happening:
    """Something that happens ``wait_ns`` after the one before.

    Attributes:
        topic: of a state.
        counter: of a heartbeat.
        is_trusted: whether a state is known to come from the safety node.
        source: the number of a command's source.
    """

    wait_ns: int
    call: str
    message: Any = None
    topic: str = ""
    counter: int = 0
    is_trusted: bool = True
    source: int = 0


QUIET = (
    Happening(0, "state", {"data": False}, "/stop"),
    Happening(0, "state", {"data": True}, "/go"),
    Happening(0, "state", {"data": 0}, "/mode"),
    Happening(0, "heartbeat", counter=1),
    Happening(0, "heartbeat", counter=2),
)
"""The states and heartbeat of a safety node without an active action."""

CALLS = (
    *("command", "command", "command", "state", "state"),
    *("heartbeat", "heartbeat", "advance", "no_safety_node", "reset", "reading"),
)
"""What may happen, some of it more often."""

NUMBERS = (0.25, 0.5, 1.0, 2.0, 2.7, 300.0, 0.0, -0.5, -1.0, math.nan, math.inf, -math.inf)
"""What messages give as ends of limits."""

_MORE_CALLS = {False: (), True: ("reading",) * 4}

_mostly = st.sampled_from((True, True, True, False))
_waits = st.sampled_from((0, 0, 0, 1, 1, 2, 3, 4, 5, 7, 10, 12, 25, 60, -1, -5))
_tame_floats = st.sampled_from((-3.0, -1.0, -0.5, -0.0, 0.0, 0.25, 0.5, 1.0, 3.0))
_zeros = st.just(0.0)
_bounds = st.sampled_from((*NUMBERS, -0.0, 3.4028235677973366e38, 1e19, 5e-324))
_integers = st.integers(-9, 9)
_wild_floats = st.sampled_from((math.nan, math.inf)) | st.floats()


@st.composite
def happenings(draw: st.DrawFn, gate: Gate) -> list[Happening]:
    """Draw what happens to a gate: commands good and bad, states, heartbeats, the time alone."""
    first = QUIET if draw(st.booleans()) else ()
    happening = _happening(gate.type, len(gate.sources), (*CALLS, *_MORE_CALLS[bool(gate.inputs)]))
    return [*first, *draw(st.lists(happening, max_size=30))]


@st.composite
def _happening(
    draw: st.DrawFn, kind: InterfaceType, sources: int, calls: Sequence[str]
) -> Happening:
    wait_ns = draw(_waits)
    call = draw(st.sampled_from(calls))
    if call == "command":
        good, any_at_all = messages(kind, _tame_floats), messages(kind, _wild_floats)
        none = messages(kind, _zeros, st.just(0))
        drawn = st.one_of(good, good, good, none, none, any_at_all, st.none())
        return Happening(wait_ns, call, draw(drawn), source=draw(st.integers(0, sources - 1)))
    if call == "state":
        topic = draw(st.sampled_from(("/stop", "/go", "/mode", "/mode")))
        values = st.integers(0, 3) if topic == "/mode" else st.booleans()
        known = st.builds(lambda value: {"data": value}, values)
        data = draw(st.one_of(known, known, known, st.none()))
        return Happening(wait_ns, call, data, topic, is_trusted=draw(_mostly))
    if call == "reading":
        numbers = st.builds(lambda value: {"data": value}, _bounds)
        drawn = draw(st.one_of(numbers, numbers, numbers, st.none()))
        return Happening(wait_ns, call, drawn, draw(st.sampled_from(sorted(READINGS))))
    counter = draw(st.integers(1, 4)) if call == "heartbeat" else 0
    return Happening(wait_ns, call, counter=counter)


def messages(
    kind: InterfaceType,
    floats: st.SearchStrategy[float],
    integers: st.SearchStrategy[int] = _integers,
) -> st.SearchStrategy[dict[str, Any]]:
    """Draw messages as plain data, with numbers out of ``floats`` and ``integers``."""
    definition = STORE.message(kind)
    assert definition is not None
    fields = {name: _values(field, floats, integers) for name, field in definition.fields}
    return st.fixed_dictionaries(fields)


def _values(
    field: FieldType, floats: st.SearchStrategy[float], integers: st.SearchStrategy[int]
) -> st.SearchStrategy[Any]:
    if field.is_array:
        return st.lists(_values(field.element, floats, integers), max_size=3)
    if isinstance(field.base, InterfaceType):
        return messages(field.base, floats, integers)
    if field.is_float:
        return floats
    return st.sampled_from(("", "a b")) if field.base == "string" else integers


# The generated gate -------------------------------------------------------------------------------


def view_of(gate: Gate, actions: tuple[Action, ...] = ACTIONS) -> GateView:
    """Return the view of a gate in a package of its own."""
    program = Program("random", (), (), (), (), actions, (gate,))
    safety = safety_node(program, SystemTopics(()), {}, SOURCE)
    (node,) = gate_nodes(program, SystemTopics(()), safety)
    return gate_view(gate, node, program, STORE, safety)


def modules_of(view: GateView) -> dict[str, dict[str, Any]]:
    """Return the names in the generated modules that need no ROS 2, by the module."""
    modules: dict[str, dict[str, Any]] = {}
    for module in MODULES:
        modules[module] = {"__name__": module}
        text = render(module, view).replace(
            f"from {view.runtime}.", f"from {gate_logic.__package__}."
        )
        exec(compile(text, module, "exec"), modules[module])
    return modules


class GeneratedGate:
    """The generated table and message functions of a gate, joined as the generated node does.

    Attributes:
        outputs: all that has been published since the start, in order.
        text: of the generated table.
    """

    def __init__(self, gate: Gate, start_ns: int = 0) -> None:
        """Generate the gate, and start it at ``start_ns``."""
        self.outputs: list[Output] = []
        self._type = gate.type
        self._view = view_of(gate)
        self.text = render("table", self._view)
        modules = modules_of(self._view)
        self._table, self._functions = modules["table"]["TABLE"], modules["message"]
        tuned = {each.name: each.default for each in gate.tunables}
        self._gate = gate_logic.Gate(self._table, start_ns, self._publish, tuned)
        self._commands: list[Message | None] = [None] * len(gate.sources)
        self._last: Message | None = None

    @property
    def next_deadline(self) -> int | None:
        """When to call :meth:`advance` at the latest."""
        due = self._gate.next_deadline
        return None if due == gate_logic.NEVER else due

    @property
    def applying(self) -> tuple[bool, ...]:
        """Of each line, whether it applies."""
        return self._gate.applying

    def command(self, t_ns: int, message: Message | None, source: int = 0) -> None:
        """Take a command (``None``: one that could not be decoded)."""
        self._gate.advance(t_ns)
        is_finite = self._functions.get("is_finite", bool)
        if message is None or not is_finite(_object(message)):
            self._gate.on_refused(t_ns, source)
            return
        self._commands[source] = message
        functions = SimpleNamespace(**self._functions)
        names = {"now": t_ns, "msg": _object(message), "message": functions, "gate": self._gate}
        eval(f"gate.on_command({', '.join(self._view.command_arguments(str(source)))})", names)

    def state(
        self, t_ns: int, topic: str, message: Message | None, *, is_trusted: bool = True
    ) -> None:
        """Take a message about the state of actions (``None``: one that could not be decoded)."""
        values = {"msg": _object(message)}
        for state in self._view.states:
            if state.topic == topic:
                active = eval(expression(state.active, 0), values)
                self._gate.on_state(t_ns, active, is_trusted)
                return
        self._gate.advance(t_ns)

    def reading(self, t_ns: int, topic: str, message: Message | None) -> None:
        """Take a message with numbers for limits (``None``: one that could not be decoded)."""
        values = {"msg": None if message is None else _object(message)}
        for reading in self._view.readings:
            if reading.topic == topic:
                self._gate.on_inputs(t_ns, eval(expression(reading.read, 0), values))
                return
        self._gate.advance(t_ns)

    def heartbeat(self, t_ns: int, counter: int) -> None:
        """Take a heartbeat of the safety node."""
        self._gate.on_heartbeat(t_ns, counter)

    def no_safety_node(self, t_ns: int) -> None:
        """Take note that no node can be the safety node."""
        self._gate.on_no_safety_node(t_ns)

    def reset(self, t_ns: int) -> tuple[int, ...]:
        """Take a reset; return the indices of the lines that stand against it."""
        return self._gate.on_reset(t_ns)

    def advance(self, t_ns: int) -> None:
        """Settle all that is due up to and including ``t_ns``."""
        self._gate.advance(t_ns)

    def _publish(self, kind: OutputKind, values: gate_logic.Values) -> None:
        command = self._commands[self._gate.source]
        is_last = kind == "hold" or self._gate.renews
        message = self._last if is_last else command
        now_ns = self._gate.now
        if kind != "pass" and not is_last:
            made = _object(command or _blank(self._type))
            if kind != "limited" and "make_zero" in self._functions:
                seconds, rest = divmod(now_ns, 10**9)
                stamp = SimpleNamespace(sec=seconds, nanosec=rest)
                self._functions["make_zero"](made, *([stamp] if self._view.stamped else []))
            if kind == "send":
                self._functions["send"](made, self._gate.deciding)
            elif values:
                self._functions["put"](made, values)
            message = _data(made)
        if is_last and values:
            made = _object(message)
            self._functions["put"](made, values)
            message = _data(made)
        assert message is not None
        self._last = message
        self.outputs.append(Output(now_ns, kind, message))


def _blank(kind: InterfaceType) -> Message:
    """Return a message as the constructor of its class makes it, but for defaults."""
    definition = STORE.message(kind)
    assert definition is not None
    return {name: _blank_value(field) for name, field in definition.fields}


def _blank_value(field: FieldType) -> Any:
    if field.is_array:
        return [_blank_value(field.element) for _ in range(field.size or 0)]
    if isinstance(field.base, InterfaceType):
        return _blank(field.base)
    return "" if field.base == "string" else 0.0 if field.is_float else 0


def _object(value: Any) -> Any:
    """Return plain data in the form of messages."""
    if isinstance(value, Mapping):
        return SimpleNamespace(**{name: _object(each) for name, each in value.items()})
    return [_object(each) for each in value] if isinstance(value, list) else value


def _data(value: Any) -> Any:
    """Return what :func:`_object` was made of."""
    if isinstance(value, SimpleNamespace):
        return {name: _data(each) for name, each in vars(value).items()}
    return [_data(each) for each in value] if isinstance(value, list) else value


class Player(Protocol):
    """The reference gate, or a generated one: something that can be played."""

    def command(self, t_ns: int, message: Message | None, source: int = 0) -> object:
        """Take a command of a source, by its number."""

    def state(
        self, t_ns: int, topic: str, message: Message | None, *, is_trusted: bool = True
    ) -> object:
        """Take a message about the state of actions."""

    def reading(self, t_ns: int, topic: str, message: Message | None) -> object:
        """Take a message with numbers for limits."""

    def heartbeat(self, t_ns: int, counter: int) -> object:
        """Take a heartbeat."""

    def no_safety_node(self, t_ns: int) -> object:
        """Take note that no node can be the safety node."""

    def reset(self, t_ns: int) -> object:
        """Decide a reset."""

    def advance(self, t_ns: int) -> object:
        """Settle all that is due."""


def play(gate: Player, t_ns: int, each: Happening) -> object:
    """Let something happen to a gate; of a reset, return what stands against it."""
    if each.call == "command":
        gate.command(t_ns, each.message, each.source)
    elif each.call == "state":
        gate.state(t_ns, each.topic, each.message, is_trusted=each.is_trusted)
    elif each.call == "reading":
        gate.reading(t_ns, each.topic, each.message)
    elif each.call == "heartbeat":
        gate.heartbeat(t_ns, each.counter)
    elif each.call == "no_safety_node":
        gate.no_safety_node(t_ns)
    elif each.call == "reset":
        return gate.reset(t_ns)
    else:
        gate.advance(t_ns)
    return None
