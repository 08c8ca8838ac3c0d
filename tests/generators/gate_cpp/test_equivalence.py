"""The gate in C++ does what the reference gate does, whatever the gate and whatever happens."""

from __future__ import annotations

import os
import random
from collections.abc import Sequence
from pathlib import Path

import pytest

from deros.monitor.gate import GateEngine
from deros.monitor.ir import Gate
from tests.support.cpp import needs_compiler
from tests.support.gate_cpp import SANITIZED, Players, compiled, encoded, needs_clang
from tests.support.gate_traces import MORE_COMMANDS, play, random_gate, random_trace
from tests.support.gates import ACTIONS, STORE

pytestmark = needs_compiler

EXAMPLES = int(os.environ.get("DEROS_EXAMPLES", "3000"))
"""Traces in all; set, gates and traces are drawn anew in every run, else always the same."""

SEED = random.randrange(2**32) if "DEROS_EXAMPLES" in os.environ else 4
START_NS = 100


def check(players: Players, gates: Sequence[Gate], number: int, seed: int) -> int:
    """Play one trace; return how many commands were published in it."""
    rng = random.Random(seed)
    gate = gates[number]
    trace = random_trace(rng, gate, START_NS)
    engine = GateEngine(gate, ACTIONS, STORE, START_NS)
    answers = players.play(number, START_NS, trace)
    for step, ((t_ns, happening), answer) in enumerate(zip(trace, answers, strict=True)):
        before = len(engine.outputs)
        play(engine, t_ns, happening)
        expected = tuple(
            (each.t_ns, each.kind, encoded(gate.type, each.message))
            for each in engine.outputs[before:]
        )
        assert answer.outputs == expected, f"{gate}\nseed {seed}, step {step} of {trace}"
        assert answer.next_deadline is None or answer.next_deadline > t_ns
    return len(engine.outputs)


@pytest.mark.parametrize(
    ("compiler", "flags", "gates_of_a_type"),
    [
        pytest.param("c++", SANITIZED, 2, id="sanitized"),
        pytest.param("clang++", ("-O2",), 1, id="optimised", marks=needs_clang),
    ],
)
def test_same_commands(
    compiler: str, flags: tuple[str, ...], gates_of_a_type: int, tmp_path: Path
) -> None:
    """Both publish the same messages at the same nanosecond; timers may be late, clocks step."""
    rng = random.Random(f"{SEED} {compiler}")
    gates = [random_gate(rng, name) for name in MORE_COMMANDS for _ in range(gates_of_a_type)]
    published = 0
    with Players(compiled(gates, tmp_path, compiler, *flags), gates) as players:
        for example in range(EXAMPLES // 2):
            published += check(players, gates, example % len(gates), rng.randrange(2**48))
    assert published > EXAMPLES  # several in each
