"""Driving the reference engine and a generated monitor side by side."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from hypothesis import note

from deros.generators.monitor_python.run import GeneratedMonitor
from deros.monitor.engine import Engine
from deros.monitor.ir import Program
from tests.support.strategies import Step

START_NS = 100


def timed(steps: Iterable[Step]) -> Iterator[tuple[int, Step]]:
    """Yield each step with its time; none is negative."""
    t_ns = START_NS
    for step in steps:
        t_ns = max(0, t_ns + step.wait_ns)
        yield t_ns, step


def compare(program: Program, steps: Iterable[Step], text: str) -> None:
    """Drive both with the same calls; they must answer alike at each.

    Raises:
        AssertionError: they do not.
    """
    engine, generated = Engine(program, START_NS), GeneratedMonitor(program, START_NS, text)
    for t_ns, step in timed(steps):
        note(f"{step.call} at {t_ns} {step.topic} {dict(step.leaves)}")
        if step.call == "message":
            engine.message(t_ns, step.topic, step.leaves)
            generated.message(t_ns, step.topic, step.leaves)
        elif step.call == "advance":
            engine.advance(t_ns)
            generated.advance(t_ns)
        else:
            assert generated.reset(t_ns) == engine.reset(t_ns)
        assert generated.events == engine.events
        assert [e.span for e in generated.events] == [e.span for e in engine.events]
        _compare_deadlines(engine.next_deadline, generated.next_deadline, t_ns)


def _compare_deadlines(reference: int | None, generated: int | None, now_ns: int) -> None:
    """The generated monitor may ask to be called in vain, but never too late."""
    if reference is not None:
        assert generated is not None
        assert generated <= reference
    assert generated is None or generated >= now_ns
