"""Runs the generated monitor in this process, with the interface of the reference engine."""

from __future__ import annotations

import math
import sys
from collections.abc import Collection, Mapping
from types import ModuleType
from typing import Any

from deros.diagnostics import Span
from deros.generators.monitor.python.render import EXPLANATION, MONITOR, render_monitor
from deros.generators.monitor.python.view import monitor_view
from deros.rules.engine.engine import Event
from deros.rules.engine.explain import Explanation, RuleState
from deros.rules.engine.state import LeafValue
from deros.rules.program import walk
from deros.rules.program.ir import Program, Trigger


def load_monitor(texts: Mapping[str, str]) -> dict[str, ModuleType]:
    """Return the modules of a generated monitor by their file names; no other code sees them."""
    package = "generated_monitor"
    modules: dict[str, ModuleType] = {}
    try:
        for name in (MONITOR, EXPLANATION):
            modules[name] = module = ModuleType(f"{package}.{name.removesuffix('.py')}")
            module.__package__ = package
            sys.modules[module.__name__] = module  # for the second, which imports from the first
            exec(compile(texts[name], f"<generated {name}>", "exec"), module.__dict__)
    finally:
        for module in modules.values():
            sys.modules.pop(module.__name__, None)
    return modules


class GeneratedMonitor:
    """The generated Python monitor of a program, with the methods of the reference engine.

    Attributes:
        events: all events since the start, in order.
    """

    def __init__(
        self,
        program: Program,
        start_ns: int = 0,
        texts: Mapping[str, str] | None = None,
        grace_ns: int = 0,
        latched: Collection[str] = (),
        constants: Mapping[str, float] | None = None,
    ) -> None:
        """Generate the monitor, or take its ``texts``, and start it at ``start_ns``.

        Raises:
            ValueError: a tunable constant cannot have the value that ``constants`` gives it.
        """
        self.events: list[Event] = []
        modules = load_monitor(texts or render_monitor(program))
        self._spans = _spans(program)
        tuned = (constants,) if program.tunables else ()
        explained: Any = modules[EXPLANATION].__dict__["ExplainedMonitor"]
        self._monitor = explained(start_ns, self._take, grace_ns, latched, *tuned)
        self._handlers = {each.topic: each for each in monitor_view(program).handlers}

    @property
    def next_deadline(self) -> int | None:
        """When to call :meth:`advance` at the latest."""
        due: int | None = self._monitor.next_deadline
        return due

    @property
    def waiting(self) -> bool:
        """Whether an input with a timeout waits for its first message and is not missing yet."""
        waiting: bool = self._monitor.waiting
        return waiting

    def message(self, t_ns: int, topic: str, leaves: Mapping[int, LeafValue]) -> list[Event]:
        """Process a message and return the events.

        Raises:
            KeyError: no input of the program is on ``topic``.
        """
        before = len(self.events)
        handler = self._handlers[topic]
        values = [leaves[parameter.leaves[0]] for parameter in handler.parameters]
        present = [math.nan if value is None else value for value in values]
        getattr(self._monitor, handler.method)(t_ns, *present)
        return self.events[before:]

    def advance(self, t_ns: int) -> list[Event]:
        """Process all deadlines up to and including ``t_ns`` and return the events."""
        before = len(self.events)
        self._monitor.advance(t_ns)
        return self.events[before:]

    def reset(self, t_ns: int) -> bool:
        """Reset every latched action that is active; return whether none was refused."""
        done: bool = self._monitor.reset(t_ns)
        return done

    def enable(self, t_ns: int, behaviour: str, enabled: bool) -> list[Event]:
        """Enable or disable an optional behaviour and return the events."""
        before = len(self.events)
        self._monitor.enable(t_ns, behaviour, enabled)
        return self.events[before:]

    def explain(self) -> Explanation:
        """Return the verdict of each rule as of the last event, and why each behaviour holds."""
        told = self._monitor.explain()
        return Explanation(tuple(RuleState(*each) for each in told.rules), told.causes)

    def _take(self, event: Any) -> None:
        span = self._spans.get((event.action, event.behaviour, event.line))
        behaviour = event.behaviour or None
        self.events.append(
            Event(
                event.t,
                event.kind.value,
                event.action,
                behaviour,
                event.arguments,
                span,
                event.holding,
                event.unknown,
                event.coming,
            )
        )


def _spans(program: Program) -> dict[tuple[str, str, int], Span]:
    """Return the places that events name by action, behaviour and line."""
    spans = {
        (action.name, "", action.span.line): action.span
        for action in program.actions
        if action.span
    }
    for behaviour in walk.behaviours(program):
        for item in behaviour.body:
            if isinstance(item, Trigger):
                name = program.actions[item.action].name
                spans[name, behaviour.name, behaviour.span.line] = behaviour.span
    return spans
