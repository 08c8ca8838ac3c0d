"""Parts of the C++ safety node without rclcpp: compiled with the message packages, and run."""

from __future__ import annotations

import functools
import re
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from unittest.mock import Mock

import pytest

from deros.generators.api.protocol import Context
from deros.generators.monitor.python.interface import EXPLANATION, render_monitor
from deros.generators.monitor.python.run import load_monitor
from deros.generators.safety_package.cpp.generate import generate
from deros.generators.safety_package.python.generate import generate as generate_python
from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from deros.models.rules import Rules
from deros.rules.compiler.build import build
from tests.support.generating import output_of
from tests.support.needs import needs
from tests.support.safety_cpp import compiled

pytest.importorskip("rclpy")
pytest.importorskip("diagnostic_msgs.msg")
from diagnostic_msgs.msg import DiagnosticStatus

from deros.generators.runtime.python.deros_runtime.event_reporter import EventReporter
from deros.generators.runtime.python.deros_runtime.look_ahead import LookAhead

pytestmark = needs("c++")

HERE = Path(__file__).resolve().parent
MODEL = HERE.parent / "python/models/every_thing.deros"
NAN = float("nan")
MESSAGES = [
    ("speed", 10_000_000, 0.25),
    ("mode", 20_000_000, 1.0),
    ("speed", 30_000_000, 0.8999999761581421),
    ("joints", 40_000_000, 2.5),
    ("imu", 50_000_000, 0.4),
    ("speed", 200_000_000, 0.9),
    ("level", 210_000_000, 2.0),
    ("no_joint", 250_000_000, 1.0),
    ("imu", 300_000_000, 0.4),
    ("speed", 310_000_000, NAN),
    ("mode", 900_000_000, 0.0),
    ("speed", 100_000_000, 0.1),
]


@pytest.fixture(scope="module")
def model() -> tuple[Rules, Context]:
    """Return the rules, and the context in which they were read."""
    context = Context(InterfaceStore(), Repository())
    model = context.repository.load(MODEL).model
    assert isinstance(model, Rules)
    return model, context


@pytest.mark.slow
def test_hot_path_does_not_allocate(model: tuple[Rules, Context], tmp_path: Path) -> None:
    """From message to state, over hundreds of triggers and resets."""
    program = compiled(HERE / "hot_path.cpp", tmp_path, generate(*model, {"runtime": "copy"}))
    done = subprocess.run([program], capture_output=True, text=True, timeout=60, check=False)
    assert done.stdout == "acted, 0 allocations\n"


def test_explanations_and_reports_match_those_of_python(
    model: tuple[Rules, Context], tmp_path: Path
) -> None:
    """The diagnostics, the log and the reported events of both nodes agree on the same messages."""
    program = compiled(HERE / "explained.cpp", tmp_path, generate(*model, {"runtime": "copy"}))
    lines = "".join(f"{topic} {t} {value}\n" for topic, t, value in MESSAGES if value == value)
    output = subprocess.run(
        [program], input=lines, capture_output=True, text=True, timeout=60, check=True
    ).stdout
    assert output == "".join(_explained(*model))


def test_arrays_of_each_kind_are_read(tmp_path: Path) -> None:
    """The failsafe rules are true while nothing is known; a fixed array is never empty."""
    files = output_of(generate, HERE / "models/arrays/arrays.deros", runtime="copy")
    program = compiled(HERE / "arrays.cpp", tmp_path, files)
    done = subprocess.run([program], capture_output=True, text=True, timeout=60, check=True)
    assert done.stdout.splitlines() == ["2 2 0", "0 0 0", "2 2 2"]


def test_elements_with_a_key_are_found(tmp_path: Path) -> None:
    """The first that matches; where there is none, failsafe rules are true if one was there."""
    files = output_of(generate, HERE / "models/keys/keys.deros", runtime="copy")
    program = compiled(HERE / "keys.cpp", tmp_path, files)
    done = subprocess.run([program], capture_output=True, text=True, timeout=60, check=True)
    assert done.stdout.splitlines() == ["1 1 1 1 1", "0 0 0 0 0", "2 2 2 2 0", "2 2 2 2 2"]


def _explained(model: Rules, context: Context) -> list[str]:
    """Return the lines that show the state of the Python monitor after each message."""
    program = build(model, context.store).program
    assert program is not None
    explained: Any = load_monitor(render_monitor(program))[EXPLANATION]
    output: list[str] = []
    reporter = _reporter(model, context, output)
    events: list[Any] = []
    monitor = explained.ExplainedMonitor(0, events.append)
    for topic, t, value in MESSAGES:
        if value != value:
            continue  # C++ streams do not read NaN
        _take(monitor, topic, t, value)
        state = monitor.explain()
        for event in events:
            reporter.report_monitor_event(event, t, state)
        events.clear()
        for rule in state.rules:
            reads = (f"{term}={_shown(read)}" for term, read in rule.reads)
            words = (rule.name, str(rule.line), rule.text, _shown(rule.value), str(rule.since))
            output.append("\t".join((*words, *reads, *rule.causes)) + "\n")
        assert {*state.causes} == {*monitor.holding, *monitor.unknown, *monitor.coming}
        for kind in ("holding", "unknown", "coming"):
            output += [
                f"{kind}\t{name}\t{'; '.join(state.causes[name])}\n"
                for name in getattr(monitor, kind)
            ]
        output += _foretold(monitor, [rule.name for rule in state.rules])
        output.append(".\n")
    return output


def _foretold(monitor: Any, names: list[str]) -> Iterator[str]:
    """Yield the lines of what becomes of the rules as time goes on."""
    ahead = LookAhead(monitor)
    for _ in ahead.steps():
        pass
    for place, name in enumerate(names):
        for case, then in ahead.found.get(place, {}).items():
            yield f"{name}\t{case}\t{_shown(then.value)}\t{then.at}\n"


def _reporter(model: Rules, context: Context, output: list[str]) -> EventReporter:
    """Return the reporter of the Python node; it appends what it logs and publishes."""

    def publish(status: DiagnosticStatus) -> None:
        told = [f"{value.key}={value.value}" for value in status.values]
        output.append("\t".join((str(status.level[0]), status.message, *told)) + "\n")

    files = generate_python(model, context, {})
    (text,) = (file.text for path, file in files.items() if path.endswith("/rule_metadata.py"))
    names: dict[str, Any] = {}
    runtime = "deros.generators.runtime.python.deros_runtime"
    exec(re.sub(r"from \S+\.report_types", f"from {runtime}.report_types", text), names)
    node = Mock()
    for level, method in enumerate(("info", "warning", "error")):
        logged = functools.partial("{}\t{}\n".format, level)
        getattr(node.get_logger.return_value, method).side_effect = lambda message, line=logged: (
            output.append(line(message))
        )
    node.get_fully_qualified_name.return_value = "/safety"
    node.get_clock.return_value.now.return_value.nanoseconds = 9
    return EventReporter(node, Mock(origin=0), names["METADATA"], publish)


def _take(monitor: Any, topic: str, t: int, value: float) -> None:
    match topic:
        case "speed":
            monitor.on_speed(t, value)
        case "mode":
            monitor.on_mode(t, int(value))
        case "level":
            monitor.on_diagnostics(t, int(value))
        case "imu":
            monitor.on_imu(t, value, 0.0, 0.0, 1.0, value)
        case "joints":
            monitor.on_joints(t, value)
        case _:
            monitor.on_joints(t, NAN)


def _shown(value: object) -> str:
    if value is None:
        return "unknown"
    return str(value).lower() if isinstance(value, bool) else str(value)
