"""The C++ gate behaves like the reference gate, for any gate and any events."""

from __future__ import annotations

import random
from collections.abc import Sequence
from pathlib import Path

import pytest

from deros.generators.gate.cpp.messages import type_views
from deros.interfaces.types import FieldType, InterfaceType
from deros.monitor.commands import HEADER, LAYOUT
from deros.monitor.gate_engine import GateEngine
from deros.monitor.ir import Gate, GateLine, Limit
from tests.support.gate_cpp import SANITIZED, Players, compiled, encoded
from tests.support.gate_traces import (
    MORE_COMMANDS,
    Trace,
    limitable,
    random_gate,
    random_trace,
)
from tests.support.gates import ACTIONS, QUIET, STORE, Happening, message_type, play, span
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
        assert answer.is_done == (not against) or not gate.is_latching
        assert not engine.outputs or answer.applying == engine.applying
        expected = tuple(
            (output.t_ns, output.kind, encoded(gate.type, output.message))
            for output in engine.outputs[before:]
        )
        assert answer.outputs == expected, f"{gate}\nstep {step} of {trace}"
        assert answer.next_deadline is None or answer.next_deadline > t_ns
    return len(engine.outputs)


def test_zeros_are_not_limited_as_executed_commands(tmp_path: Path) -> None:
    """Values that a limit left in them are not limited again after the zero line has ended."""
    kind = message_type("std_msgs.Int32")
    data = FieldType("int32")
    lines = (
        GateLine(2, None, None, (Limit(("data",), data, -3, 3),), span(2)),
        GateLine(0, None, None, (), span(3)),
        GateLine(3, None, None, (Limit(("data",), data, -1, 1),), span(4)),
    )
    gates = [Gate(0, "/wish", "/robot/command", kind, 10, lines, span(1))]
    happens = [
        *QUIET,
        Happening(1, "state", {"data": 1}, "/mode"),
        Happening(1, "command", {"data": 9}),
        Happening(1, "state", {"data": True}, "/stop"),
        Happening(1, "state", {"data": False}, "/stop"),
        Happening(1, "state", {"data": 2}, "/mode"),
    ]
    trace = [(START_NS + number, each) for number, each in enumerate(happens)]
    with Players(compiled(gates, tmp_path, "c++", "-O0"), gates) as players:
        assert check_trace(players, gates, 0, trace) == 3  # at the start, limited, and zero


@pytest.mark.parametrize(
    ("compiler", "flags", "types"),
    [
        pytest.param("c++", ("-O0",), FEW_COMMANDS, id="plain"),
        pytest.param(
            "c++", SANITIZED, 2 * [*MORE_COMMANDS], id="sanitized", marks=pytest.mark.slow
        ),
        pytest.param(
            "clang++",
            ("-O2",),
            [*MORE_COMMANDS],
            id="optimised",
            marks=[needs("clang++"), pytest.mark.slow],
        ),
    ],
)
def test_commands_match_the_reference(
    compiler: str, flags: tuple[str, ...], types: Sequence[str], tmp_path: Path
) -> None:
    """Both publish the same messages at the same nanosecond, with late timers and clock steps."""
    rng = random.Random(f"{SEED} {compiler}")
    gates = [random_gate(rng, name) for name in sorted(types)]
    published = 0
    with Players(compiled(gates, tmp_path, compiler, *flags), gates) as players:
        for example in range(EXAMPLES // 2):
            published += check(players, gates, example % len(gates), rng.randrange(2**48))
    assert published > EXAMPLES  # several in each


def commands() -> list[InterfaceType]:
    """Return all message types of some packages that can be commands."""
    no_commands = (HEADER, LAYOUT)  # fields that determine how to read the rest of a message
    kinds = (kind for kind in message_types(*PACKAGES) if kind not in no_commands)
    return [kind for kind in kinds if type_views(STORE, kind)]


def test_commands_of_every_type(tmp_path: Path) -> None:
    """Each float is checked, each number zeroed or limited, and the rest is unchanged."""
    rng = random.Random(f"{SEED} types")
    every = commands()
    assert len(every) > 100
    kinds = every[::TYPES_STEP]
    gates = [random_gate(rng, kind.short, limitable(rng, kind)) for kind in kinds]
    with Players(compiled(gates, tmp_path, "c++", "-O0"), gates) as players:
        for number in range(len(gates)):
            for _ in range(TRACES_OF_A_TYPE):
                check(players, gates, number, rng.randrange(2**48))
