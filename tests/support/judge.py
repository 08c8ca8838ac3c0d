"""What the generated monitor of an example makes of messages, as they are said."""

from __future__ import annotations

import functools
import json
from collections.abc import Set
from dataclasses import dataclass
from typing import Any

import pytest

from deros.generators.monitor.python.render import render_monitor
from deros.generators.monitor.python.run import GeneratedMonitor
from tests.support.examples import example_program

each_of_20_robots = pytest.mark.parametrize(
    "seeds",
    [
        pytest.param(range(3), id="3 robots"),
        pytest.param(range(3, 20), id="17 more", marks=pytest.mark.slow),
    ],
)
"""Three robots of a kind with every change, the others where there is more time."""


@dataclass(frozen=True)
class Verdict:
    """An action that the rules triggered, at a time in s, and the rules that hold then."""

    time: float
    action: str
    behaviour: str | None
    rules: frozenset[str]


class Judge:
    """The rules of an example, in the code that runs on a robot.

    Attributes:
        lines: all that was said, as the lines of a trace.
        verdicts: what the rules have triggered, but for what is only logged.
    """

    def __init__(self, example: str) -> None:
        """Begin at time 0."""
        program = example_program(example)
        self.lines: list[str] = []
        self.verdicts: list[Verdict] = []
        self._monitor = GeneratedMonitor(program, texts=_texts(example))
        self._leaves: dict[str, list[tuple[int, str]]] = {topic: [] for topic in program.topics}
        for leaf in program.leaves:
            topic = program.inputs[leaf.input].topic
            self._leaves[topic].append((leaf.index, ".".join(map(str, leaf.path))))

    def hear(self, time: float, topic: str, data: dict[str, Any]) -> None:
        """Take a message of a time in s, with the values of the fields that the rules read."""
        self.lines.append(json.dumps({"t": f"{time:.3f}", "topic": topic, "data": data}))
        t_ns = round(time * 1000) * 10**6
        self.advance(time)
        values = {index: data[field] for index, field in self._leaves[topic]}
        self._take(self._monitor.message(t_ns, topic, values))

    def advance(self, time: float) -> None:
        """Let what is due happen when it is due, up to a time in s."""
        t_ns = round(time * 1000) * 10**6
        while (due := self._monitor.next_deadline) is not None and due <= t_ns:
            self._take(self._monitor.advance(due))

    def require_stop(self, rules: Set[str], after: float, before: float, which: str) -> None:
        """Require that the first action is the stop, between two times in s, as these rules hold.

        Raises:
            AssertionError: if it is not; it says which robot this is about.
        """
        first = self.verdicts[0]
        assert first.action == "stop", which
        assert first.rules == rules, which
        assert after < first.time < before, which

    def _take(self, events: list[Any]) -> None:
        for event in events:
            if event.kind == "trigger" and event.action != "log_state":
                holding = frozenset(
                    rule.name for rule in self._monitor.explain().rules if rule.value is True
                )
                time = event.t_ns / 1e9
                self.verdicts.append(Verdict(time, event.action, event.behaviour, holding))


@functools.cache
def _texts(example: str) -> dict[str, str]:
    return render_monitor(example_program(example))
