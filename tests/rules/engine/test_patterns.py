"""The patterns of the documentation act as their timelines say."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Sequence
from itertools import groupby
from pathlib import Path

import pytest
from click.testing import CliRunner

from deros.cli.main import deros
from deros.diagnostics import SourceFile
from deros.generators.monitor.python.run import GeneratedMonitor
from deros.metamodels.load import Repository
from deros.models.rules import Rules
from deros.rules.compiler.build import build
from deros.rules.engine.engine import Engine
from deros.rules.program.ir import Program
from deros.simulation.trace import read_trace
from tests.support import timelines
from tests.support.c_harness import unit
from tests.support.c_library import Loaded
from tests.support.c_monitors import CMonitor
from tests.support.needs import needs
from tests.support.rules import embedded_store
from tests.support.timelines import Timeline

PAGE = Path(__file__).parents[3] / "docs/patterns.md"
TIMELINES = timelines.read(PAGE)
PATTERNS = {
    name: tuple(group)
    for name, group in groupby(TIMELINES, lambda each: each.name.removesuffix(f", {each.label}"))
}
FLOATING = {
    "/odom": {"twist.twist.linear.x", "pose.pose.position.x"},
    "/radar": {"data"},
    "/encoder": {"data"},
    "/imu": {"linear_acceleration.x", "angular_velocity.z"},
    "/scan": {"ranges"},
    "/rear_scan": {"ranges"},
    "/battery": {"current"},
}
"""The fields of the patterns that can be NaN, by topic."""

LATER_MS = {
    "Interlock": 1500,  # it stands, and then crawls while it is being set up: until 2 s
    "The nearer of two sensors": 500,  # tolerates so much blindness
}
"""How long after the timeout the stop may come, where the pattern says why."""

KINDS = ("As meant", "As it is abused", "Sensor lost")

every_timeline = pytest.mark.parametrize("timeline", TIMELINES, ids=lambda each: each.name)
every_pattern = pytest.mark.parametrize("name", PATTERNS)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the system of the page."""
    path = tmp_path_factory.mktemp("patterns")
    (path / "robot.system").write_text(timelines.system(PAGE), encoding="utf-8")
    return path


def test_there_are_as_many_as_the_page_says() -> None:
    """The number is in its first words."""
    assert len(PATTERNS) == 30
    _, _, text = PAGE.read_text("utf-8").partition("\n")
    assert text.lstrip().startswith("Twenty-nine ")


@every_pattern
def test_pattern_has_every_kind_of_timeline(name: str) -> None:
    """It is shown as meant, as it is abused, and with a sensor lost, which it notices."""
    kinds = [each.label.partition(":")[0] for each in PATTERNS[name]]
    assert list(dict.fromkeys(kinds)) == list(KINDS)
    assert all(each.expect for each in PATTERNS[name] if each.label.startswith("Sensor lost"))


@every_pattern
def test_pattern_passes_the_strict_check(name: str, folder: Path) -> None:
    """There is no finding at all, not even a remark."""
    (rules,) = {each.rules for each in PATTERNS[name]}
    path = folder / "rules.deros"
    path.write_text(rules, encoding="utf-8")
    result = CliRunner().invoke(deros, ["check", "--strict", str(path)])
    assert (result.exit_code, result.output) == (0, "2 files checked, no findings\n")


@every_pattern
def test_loss_of_any_input_is_noticed(name: str, folder: Path) -> None:
    """Where an input never comes, or is NaN from its first message on, the robot is stopped.

    It is when the timeout passes at the latest, but for what the page says. Of three sensors that
    vote one may be lost.
    """
    meant = PATTERNS[name][0]
    rules = program(meant, folder)
    spared = 1 if name == "Two of three" else 0
    for each in rules.inputs[spared:]:
        lost = {each.topic} | {other.topic for other in rules.inputs[:spared]}
        assert each.timeout_ns is not None
        for change in (_silent, _not_a_number):
            trace = tuple(text for line in meant.trace for text in change(line, lost))
            engine = Engine(rules, 0)
            _run(engine, trace, meant.until_ns, rules)
            engine.advance(max(meant.until_ns, each.timeout_ns))
            acts = [event.t_ns for event in engine.events if event.action in ("stop", "slow")]
            assert acts, (each.name, change)
            assert acts[0] <= LATER_MS.get(name, 0) * 10**6 + each.timeout_ns


@every_timeline
def test_timeline_matches(timeline: Timeline, folder: Path) -> None:
    """It triggers and resets the named actions at the named times and no others."""
    rules = program(timeline, folder)
    for monitor in (Engine, GeneratedMonitor):
        runner = monitor(rules, 0)
        _run(runner, timeline.trace, timeline.until_ns, rules)
        assert timelines.happenings(runner.events) == timeline.expect, monitor


@needs("gcc")
@pytest.mark.essential
def test_timelines_match_in_c(folder: Path, tmp_path: Path) -> None:
    """The monitors in C give the same."""
    programs = [program(group[0], folder) for group in PATTERNS.values()]
    units = [unit(each, f"pattern_{number}") for number, each in enumerate(programs)]
    library = Loaded(units, tmp_path, "-O0")
    for number, (rules, group) in enumerate(zip(programs, PATTERNS.values(), strict=True)):
        for timeline in group:
            runner = CMonitor(library, number)
            _run(runner, timeline.trace, timeline.until_ns, rules)
            events = [event for event, _ in runner.events]
            assert timelines.happenings(events) == timeline.expect, timeline.name


def program(timeline: Timeline, folder: Path) -> Program:
    """Build the rules of a timeline on the system of the page."""
    model = Repository().load_text(folder / "rules.deros", timeline.rules).model
    assert isinstance(model, Rules)
    result = build(model, embedded_store())
    assert result.program is not None, result.diagnostics
    return result.program


def _run(
    runner: Engine | GeneratedMonitor | CMonitor,
    lines: Sequence[str],
    until_ns: int,
    rules: Program,
) -> None:
    trace = read_trace(SourceFile("trace", "\n".join(lines)), rules, embedded_store())
    assert not trace.diagnostics
    for message in trace.messages:
        runner.message(message.t_ns, message.topic, message.leaves)
    runner.advance(until_ns)


def _silent(line: str, topics: set[str]) -> Iterator[str]:
    """Yield a message, but of these topics none."""
    if json.loads(line)["topic"] not in topics:
        yield line


def _not_a_number(line: str, topics: set[str]) -> Iterator[str]:
    """Yield a message, of these topics with NaN; what cannot be NaN is not sent at all."""
    message = json.loads(line)
    if message["topic"] not in topics:
        yield line
    elif message["topic"] in FLOATING:
        for path in set(message["data"]) & FLOATING[message["topic"]]:
            length = len(message["data"][path]) if path == "ranges" else 0
            message["data"][path] = [math.nan] * length or math.nan
        yield json.dumps(message)
