"""The C++ gate behaves like the reference gate, for any gate and any events."""

from __future__ import annotations

import itertools
import math
import random
import struct
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import pytest

from deros.generators.gate.cpp.messages import type_views
from deros.interfaces.types import FieldType, InterfaceType
from deros.rules.gates.gate_engine import GateEngine
from deros.rules.program.commands import HEADER, LAYOUT
from deros.rules.program.ir import Gate, GateLine, Limit, Source, Stop, StopField
from tests.support.gate_cpp import SANITIZED, Players, compiled, encoded
from tests.support.gate_traces import (
    MORE_COMMANDS,
    Trace,
    limitable,
    random_gate,
    random_trace,
    with_bounds,
)
from tests.support.gates import (
    ACTIONS,
    NUMBERS,
    QUIET,
    READINGS,
    STORE,
    Happening,
    message_type,
    play,
    span,
)
from tests.support.messages import message_types
from tests.support.needs import needs
from tests.support.profiles import draws_new_examples, scaled, thinned

pytestmark = needs("c++")

IN_CI = 3000
EXAMPLES = scaled(IN_CI)
"""Total number of traces."""

SEED = random.randrange(2**32) if draws_new_examples() else 4
START_NS = 100
TRACES_OF_A_TYPE = 8

TYPES_STEP = 2 * thinned(1) - 1
"""One of so many message types is compiled."""

FEW_COMMANDS = (
    *("geometry_msgs.Twist", "geometry_msgs.TwistStamped", "geometry_msgs.PoseStamped"),
    *("std_msgs.Int32", "std_msgs.Float64MultiArray", "std_msgs.UInt64"),
)
"""Types out of two packages, whose headers compile in a second or two."""

TWICE = [*MORE_COMMANDS] * 2

PACKAGES = (
    "builtin_interfaces",
    "diagnostic_msgs",
    "geometry_msgs",
    "nav_msgs",
    "sensor_msgs",
    "std_msgs",
    "test_msgs",
    "trajectory_msgs",
)


def check(players: Players, gates: Sequence[Gate], number: int, seed: int) -> int:
    """Play one random trace; return how many commands were published in it."""
    trace = random_trace(random.Random(seed), gates[number], START_NS)
    return check_trace(players, gates, number, trace)


def check_trace(players: Players, gates: Sequence[Gate], number: int, trace: Trace) -> int:
    """Play a trace; return how many commands were published in it."""
    gate = gates[number]
    engine = GateEngine(gate, ACTIONS, STORE, START_NS)
    answers = players.play(number, START_NS, trace)
    for step, ((t_ns, happening), answer) in enumerate(zip(trace, answers, strict=True)):
        before = len(engine.outputs)
        against = play(engine, t_ns, happening)
        assert answer.is_done == (not against)
        assert not engine.outputs or answer.applying == engine.applying
        expected = tuple(
            (output.t_ns, output.kind, encoded(gate.type, output.message))
            for output in engine.outputs[before:]
        )
        assert answer.outputs == expected, f"{gate}\nstep {step} of {trace}"
        assert answer.next_deadline is None or answer.next_deadline > t_ns
    return len(engine.outputs)


ZEROED = Gate(
    0,
    (Source("/wish"),),
    "/robot/command",
    message_type("std_msgs.Int32"),
    10,
    (
        GateLine(2, None, None, (Limit(("data",), FieldType("int32"), -3, 3),), span(2)),
        GateLine(0, None, None, (), span(3), stop=Stop()),
        GateLine(3, None, None, (Limit(("data",), FieldType("int32"), -1, 1),), span(4)),
    ),
    span(1),
)
"""A gate with a zero line between two limits."""


_SPEED = ("linear", "x")
_LIMITED = (Limit(_SPEED, FieldType("float64"), -0.25, 0.25),)
_RAMP = Stop(ramps=(StopField(_SPEED, FieldType("float64"), 1e7),))

LIMITED_WHEN_LOST = Gate(
    0,
    (Source("/wish"),),
    "/robot/command",
    message_type("geometry_msgs.Twist"),
    10,
    (
        GateLine(None, "input", 20, _LIMITED, span(2)),
        GateLine(0, None, None, (), span(3), stop=_RAMP),
    ),
    span(1),
)
"""A gate with a limit for when the input is lost, before a ramp of the same field."""


@dataclass(frozen=True)
class Compiled:
    """A program, and the gates in it."""

    program: Path
    gates: Sequence[Gate]


@pytest.fixture(scope="module")
def plain(tmp_path_factory: pytest.TempPathFactory) -> Compiled:
    """Compile the gates of all tests, which read the same headers, into one program."""
    gates = [ZEROED, LIMITED_WHEN_LOST, *drawn("c++", FEW_COMMANDS), *of_every_type()]
    return Compiled(compiled(gates, tmp_path_factory.mktemp("plain"), "c++", "-O0"), gates)


def drawn(compiler: str, types: Iterable[str]) -> list[Gate]:
    """Draw two gates for each type of commands, others for each compiler.

    The second one has limits whose ends messages and parameters give.
    """
    rng = random.Random(f"{SEED} {compiler}")
    gates = [random_gate(rng, name) for name in sorted(types)]
    return gates + [with_bounds(rng, random_gate(rng, name)) for name in sorted(types)]


def of_every_type() -> list[Gate]:
    """Draw a gate for one of :data:`TYPES_STEP` types that can be commands."""
    rng = random.Random(f"{SEED} types")
    kinds = commands()[::TYPES_STEP]
    return [random_gate(rng, kind.short, limitable(rng, kind)) for kind in kinds]


@pytest.mark.essential
def test_zeros_are_not_limited_as_executed_commands(plain: Compiled) -> None:
    """Values that a limit left in them are not limited again after the zero line has ended."""
    happens = [
        *QUIET,
        Happening(1, "state", {"data": 1}, "/mode"),
        Happening(1, "command", {"data": 9}),
        Happening(1, "state", {"data": True}, "/stop"),
        Happening(1, "state", {"data": False}, "/stop"),
        Happening(1, "state", {"data": 2}, "/mode"),
    ]
    trace = [(START_NS + number, each) for number, each in enumerate(happens)]
    with Players(plain.program, plain.gates) as players:
        # At the start, limited, and zero.
        assert check_trace(players, plain.gates, plain.gates.index(ZEROED), trace) == 3


def test_limited_field_has_no_ramp_while_the_input_is_lost(plain: Compiled) -> None:
    """It is zero at once, as the command to which the limit leaves it is lost, and stays so."""
    speed = {"linear": {"x": 1.0, "y": 0.0, "z": 0.0}, "angular": {"x": 0.0, "y": 0.0, "z": 0.0}}
    trace = [(START_NS, each) for each in QUIET]
    trace += [
        (START_NS, Happening(0, "state", {"data": False}, "/stop")),
        (START_NS, Happening(0, "command", speed)),
        (START_NS + 15, Happening(15, "state", {"data": True}, "/stop")),
        (START_NS + 19, Happening(4, "advance")),
        (START_NS + 25, Happening(6, "advance")),
        (START_NS + 35, Happening(10, "command", speed)),  # which does not lift it again
        (START_NS + 45, Happening(10, "advance")),
    ]
    gate = plain.gates.index(LIMITED_WHEN_LOST)
    engine = GateEngine(LIMITED_WHEN_LOST, ACTIONS, STORE, START_NS)
    for t_ns, happening in trace:
        play(engine, t_ns, happening)
    published = [(each.t_ns - START_NS, each.message["linear"]["x"]) for each in engine.outputs]
    assert published == [(0, 0.0), (0, 1.0), (15, 1.0), (20, 0.0), (30, 0.0), (35, 0.0), (45, 0.0)]
    with Players(plain.program, plain.gates) as players:
        check_trace(players, plain.gates, gate, trace)


@pytest.mark.essential
def test_commands_match_the_reference(plain: Compiled) -> None:
    """Both publish the same messages at the same nanosecond, with late timers and clock steps."""
    chosen = [LIMITED_WHEN_LOST, *drawn("c++", FEW_COMMANDS)]
    check_random_traces(plain, [plain.gates.index(gate) for gate in chosen])


@pytest.mark.parametrize(
    ("compiler", "flags", "types"),
    [
        pytest.param("c++", SANITIZED, TWICE, id="sanitized"),
        pytest.param("clang++", ("-O2",), MORE_COMMANDS, id="optimised", marks=needs("clang++")),
    ],
)
@pytest.mark.slow
def test_commands_match_the_reference_otherwise_compiled(
    compiler: str, flags: tuple[str, ...], types: Sequence[str], tmp_path: Path
) -> None:
    """They do so for all types, with sanitizers and with another compiler."""
    gates = drawn(compiler, types)
    program = Compiled(compiled(gates, tmp_path, compiler, *flags), gates)
    check_random_traces(program, range(len(gates)))


def check_random_traces(program: Compiled, numbers: Sequence[int]) -> None:
    """Play random traces to gates of a program, as many to each."""
    rng = random.Random(f"{SEED} traces")
    published = 0
    with Players(program.program, program.gates) as players:
        for example in range(EXAMPLES // 2):
            number = numbers[example % len(numbers)]
            published += check(players, program.gates, number, rng.randrange(2**48))
    assert published > EXAMPLES  # several in each


def test_readings_are_numbers_that_their_messages_hold() -> None:
    """The reference is given what arrives: another one would limit numbers of more digits to it."""
    rng = random.Random(f"{SEED} readings")
    gate = with_bounds(rng, LIMITED_WHEN_LOST)
    while not gate.inputs:
        gate = with_bounds(rng, LIMITED_WHEN_LOST)
    traces = [random_trace(rng, gate, START_NS) for _ in range(200)]
    short = [topic for topic, kind in READINGS.items() if kind == "std_msgs.Float32"]
    numbers = [
        each.message["data"]
        for _, each in itertools.chain(*traces)
        if each.call == "reading" and each.topic in short and each.message
    ]
    finite = [number for number in numbers if math.isfinite(number)]
    assert any(number not in NUMBERS for number in finite)  # some have been rounded
    assert all(struct.unpack("f", struct.pack("f", number)) == (number,) for number in finite)


def commands() -> list[InterfaceType]:
    """Return all message types of some packages that can be commands."""
    no_commands = (HEADER, LAYOUT)  # fields that determine how to read the rest of a message
    kinds = (kind for kind in message_types(*PACKAGES) if kind not in no_commands)
    return [kind for kind in kinds if type_views(STORE, kind)]


def test_commands_of_every_type(plain: Compiled) -> None:
    """Each float is checked, each number zeroed or limited, and the rest is unchanged."""
    assert len(commands()) > 100
    rng = random.Random(f"{SEED} traces of types")
    with Players(plain.program, plain.gates) as players:
        for gate in of_every_type():
            number = plain.gates.index(gate)
            for _ in range(TRACES_OF_A_TYPE):
                check(players, plain.gates, number, rng.randrange(2**48))
