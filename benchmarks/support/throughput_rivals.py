"""The monitors whose throughput is compared, each behind the same few lines.

All get the same messages. The temporal logics are spared what they cannot say: timeouts, behaviours
and actions. Their time passes with the messages that they are given; so, to know every verdict at
every message as the generated monitor does, each of their rules is given each message. What they
take if a rule only gets the messages that it reads, and learns of time no sooner, stands beside it.
"""

from __future__ import annotations

import importlib
import importlib.util
from collections.abc import Callable, Sequence
from typing import Any

from deros.generators.monitor.python.interface import EXPLANATION, monitor_view, render_monitor
from deros.generators.monitor.python.run import load_monitor
from deros.rules.program.ir import Program
from support.throughput_by_hand import OneRuleByHand, RobotByHand
from support.throughput_rules import (
    RULES_OF_A_ROBOT,
    Bounds,
    Message,
    angles,
)

Call = tuple[Callable[..., Any], tuple[Any, ...]]
"""A function with its arguments: one message, to one monitor or several."""

Update = Callable[..., Any]

Contender = Callable[[Sequence[Message]], list[Call]]
"""Sets a monitor up from the start, and returns the calls that are a drive to it."""


def nothing(drive: Sequence[Message]) -> list[Call]:
    """Return calls of a function that does nothing: what calling costs."""
    return [(_nothing, (t, *values)) for t, _, values in drive]


def generated(program: Program, happened: list[Any] | None = None) -> Contender:
    """Return the generated monitor of a program; its events go into ``happened``."""
    module: Any = load_monitor(render_monitor(program))[EXPLANATION]
    methods = {each.topic: each.method for each in monitor_view(program).handlers}

    def calls(drive: Sequence[Message]) -> list[Call]:
        monitor = module.ExplainedMonitor(0, [].append if happened is None else happened.append)
        handlers = {topic: getattr(monitor, method) for topic, method in methods.items()}
        return [(handlers.get(topic, _nothing), (t, *values)) for t, topic, values in drive]

    return calls


def by_hand(rules: int, happened: list[Any] | None = None) -> Contender | None:
    """Return the monitor written by hand, if there is one for so many rules."""
    if rules not in (1, RULES_OF_A_ROBOT):
        return None

    def calls(drive: Sequence[Message]) -> list[Call]:
        emit = [].append if happened is None else happened.append
        if rules == 1:
            handlers: dict[str, Callable[..., Any]] = {"/odometry": OneRuleByHand(0, emit).odometry}
        else:
            monitor = RobotByHand(0, emit)
            handlers = {
                "/imu": monitor.imu,
                "/odometry": monitor.odometry,
                "/front": monitor.front,
                "/plc/mode": monitor.mode,
                "/plc/stop_button": monitor.stop_button,
                "/plc/bumper": monitor.bumpers,
                "/plc/arm": monitor.feeding_arm,
            }
        return [(handlers.get(topic, _nothing), (t, *values)) for t, topic, values in drive]

    return calls


def _nothing(*_: Any) -> None:
    pass


# Temporal logic -----------------------------------------------------------------------------------

FIELDS = {
    "/imu": ("roll", "pitch"),
    "/odometry": ("speed",),
    "/front": ("front",),
    "/plc/mode": ("mode",),
    "/plc/stop_button": ("stop_button",),
    "/plc/bumper": ("bumper",),
    "/plc/arm": ("arm",),
}
"""The numbers that the temporal logics get of each topic."""


def _formulas(rules: int) -> list[tuple[str, str, str, float]]:
    """Return topic, condition, second condition and seconds of each rule; missing() has none.

    The second condition must last half as long, as the limits for driving backward do.
    """
    robots, rest = divmod(rules, RULES_OF_A_ROBOT)
    made: list[tuple[str, str, str, float]] = []
    for k in range(robots):
        b = Bounds.of(k)
        made += [
            ("/imu", _outside(b.tilt), "", 4),
            ("/imu", _outside(b.roll), "", 0),
            ("/front", f"front >= {b.stop_zone} and front < {b.warning_zone}", "", 0),
            ("/front", f"front >= {b.danger_zone} and front < {b.stop_zone}", "", 0),
            ("/front", f"front < {b.danger_zone}", "", 0),
            ("/plc/stop_button", "stop_button > 0.5", "", 0),
            ("/plc/bumper", "bumper > 0.5", "", 0),
            ("/plc/arm", "arm > 0.5", "", 0),
            ("/plc/mode", "mode < 0.5", "", 0),
            ("/plc/mode", "mode > 1.5", "", 0),
            ("/odometry", "speed < -0.05 or speed > 0.05", "", 0),
            ("/odometry", f"speed > {b.nominal}", f"speed < -{b.backward}", 4),
            ("/odometry", f"speed > {b.limit} or speed < -{b.backward_limit}", "", 0),
        ]
    made += [("/odometry", f"speed > {0.5 + n / 100}", "", 2) for n in range(rest)]
    return made


def _outside(bound: float) -> str:
    return " or ".join(f"{angle} {side}" for angle in FIELDS["/imu"] for side in _sides(bound))


def _sides(bound: float) -> tuple[str, str]:
    return f"< -{bound}", f"> {bound}"


def is_installed(package: str) -> bool:
    """Tell whether a rival is there to be measured; ``pip install deros[bench]`` brings them."""
    return importlib.util.find_spec(package) is not None


def reelay(rules: int, own_topics: bool = False) -> Contender:
    """Return the monitors of reelay, in dense time, piecewise constant, one a rule."""
    library = importlib.import_module("reelay")

    def monitor(first: str, second: str, seconds: float) -> Update:
        text = _braced(first)
        if seconds:
            text = f"historically[0:{seconds}] ({text})"
        if second:
            text = f"({text}) or (historically[0:{seconds / 2:g}] ({_braced(second)}))"
        update: Update = library.dense_timed_monitor(pattern=text).update
        return update

    def calls(drive: Sequence[Message]) -> list[Call]:
        updates = _by_topic(rules, own_topics, lambda _, *formula: monitor(*formula))

        def take(t: int, topic: str, values: tuple[float, ...]) -> None:
            sample = {"time": t / 1e9, **_numbers(topic, values)}
            for update in updates[topic]:
                update(sample)

        return [(take, message) for message in drive]

    return calls


def _by_topic(
    rules: int, own_topics: bool, monitor: Callable[[str, str, str, float], Update]
) -> dict[str, list[Update]]:
    """Return which monitors get the messages of each topic."""
    found: dict[str, list[Update]] = {topic: [] for topic in FIELDS}
    for formula in _formulas(rules):
        update = monitor(*formula)
        for topic in found:
            if topic == formula[0] or not own_topics:
                found[topic].append(update)
    return found


def _braced(condition: str) -> str:
    words = condition.replace(" or ", "} or {").replace(" and ", "} and {")
    return f"{{{words}}}"


def rtamt(rules: int) -> Contender:
    """Return the monitors of rtamt, online in dense time, one a rule, on the rule's own topic."""
    library = importlib.import_module("rtamt")

    def monitor(topic: str, first: str, second: str, seconds: float) -> Update:
        specification = library.StlDenseTimeOnlineSpecification()
        for name in (*FIELDS[topic], "out"):
            specification.declare_var(name, "float")
        text = f"historically[0,{seconds}]({first})" if seconds else f"({first})"
        if second:
            text = f"({text}) or (historically[0,{seconds / 2:g}]({second}))"
        specification.spec = f"out = {text}"
        specification.parse()
        update: Update = specification.update
        return update

    def calls(drive: Sequence[Message]) -> list[Call]:
        updates = _by_topic(rules, True, monitor)

        def take(t: int, topic: str, values: tuple[float, ...]) -> None:
            at = t / 1e9
            samples = [[name, [[at, number]]] for name, number in _numbers(topic, values).items()]
            for update in updates[topic]:
                update(*samples)

        return [(take, message) for message in drive]

    return calls


def _numbers(topic: str, values: tuple[float, ...]) -> dict[str, float]:
    given = angles(*values) if topic == "/imu" else values
    return dict(zip(FIELDS[topic], map(float, given), strict=True))
