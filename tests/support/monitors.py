"""Driving the reference engine and a generated monitor side by side."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from hypothesis import currently_in_test_context, note

from deros.generators.monitor.python.run import GeneratedMonitor
from deros.rules.engine.engine import Engine
from deros.rules.program.ir import Program
from tests.support.strategies import Start, Step

START_NS = 100
ORDINARY_START = Start(0, frozenset())


def timed(steps: Iterable[Step]) -> Iterator[tuple[int, Step]]:
    """Yield each step with its time; none is negative."""
    t_ns = START_NS
    for step in steps:
        t_ns = max(0, t_ns + step.wait_ns)
        yield t_ns, step


def compare(
    program: Program,
    steps: Iterable[Step],
    texts: Mapping[str, str],
    start: Start = ORDINARY_START,
) -> None:
    """Drive both with the same calls; they must answer alike at each.

    The engine gets arrays as lists of Python's numbers, the generated monitor as those of numpy.

    Raises:
        AssertionError: they do not.
    """
    remark(f"{start}")
    chosen = dict(start.constants)
    engine = Engine(program, START_NS, start.grace_ns, start.latched, chosen)
    generated = GeneratedMonitor(program, START_NS, texts, start.grace_ns, start.latched, chosen)
    for t_ns, step in timed(steps):
        remark(f"at {t_ns} {step}")
        assert call(generated, t_ns, with_arrays(program, step)) == call(engine, t_ns, step)
        assert generated.events == engine.events
        assert [e.span for e in generated.events] == [e.span for e in engine.events]
        assert generated.waiting == engine.waiting
        assert generated.explain() == engine.explain()
        _compare_deadlines(engine.next_deadline, generated.next_deadline, t_ns)


def remark(text: str) -> None:
    """Show a text with the example that fails, if there are examples."""
    if currently_in_test_context():
        note(text)


def call(monitor: Engine | GeneratedMonitor, t_ns: int, step: Step) -> bool | None:
    """Make the call that a step stands for; return what a reset answers."""
    match step.call:
        case "message":
            monitor.message(t_ns, step.topic, step.leaves)
        case "advance":
            monitor.advance(t_ns)
        case "enable":
            monitor.enable(t_ns, step.behaviour, step.enabled)
        case "reset":
            return monitor.reset(t_ns)
    return None


def with_arrays(program: Program, step: Step) -> Step:
    """Return a step with arrays in the form in which messages are decoded."""
    leaves: dict[int, Any] = dict(step.leaves)
    for index, value in leaves.items():
        leaf = program.leaves[index].type
        if leaf.is_array and leaf.base in ("float32", "float64") and not isinstance(value, str):
            leaves[index] = np.array(value, leaf.base)
    return replace(step, leaves=leaves)


def _compare_deadlines(reference: int | None, generated: int | None, now_ns: int) -> None:
    """The generated monitor may ask to be called in vain, but never too late."""
    if reference is not None:
        assert generated is not None
        assert generated <= reference
    assert generated is None or generated >= now_ns
