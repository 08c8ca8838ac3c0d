"""The generated monitor behaves like the reference engine, for any rules and any trace."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, note, settings
from hypothesis import strategies as st

from deros.generators.monitor.python.interface import render_monitor
from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from deros.models.rules import Rules
from deros.rules.compiler.build import build
from deros.rules.engine.engine import Engine, Event
from deros.rules.program.ir import Program
from tests.support import counterexamples
from tests.support.counterexamples import Pair, pairs
from tests.support.monitors import START_NS, call, compare, timed
from tests.support.profiles import scaled
from tests.support.rules_text import NODE_TEXT, SYSTEM_TEXT, rules_text
from tests.support.strategies import MORE_KINDS, Step, programs, traces

COUNTEREXAMPLES = sorted(counterexamples.FOLDER.glob("*.json"))

thorough = settings(suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])
essential = settings(thorough, max_examples=scaled(1000))


@essential
@given(programs().flatmap(pairs))
@pytest.mark.essential
def test_events_match_the_reference(pair: Pair) -> None:
    """Both give the same events, at the same nanosecond, in the same order."""
    pair.compare()


@pytest.mark.slow
@thorough
@given(programs(kinds=("scan", "array", "element")).flatmap(pairs))
def test_events_of_arrays_match(pair: Pair) -> None:
    """The same holds for message arrays and for missing elements."""
    pair.compare()


@pytest.mark.slow
@thorough
@given(programs(kinds=("number", "boolean")).flatmap(pairs))
def test_events_of_few_values_match(pair: Pair) -> None:
    """The same holds if conditions change often and messages repeat known values."""
    pair.compare()


@essential
@given(programs(kinds=("stamped", "number", "quaternion")).flatmap(pairs))
@pytest.mark.essential
def test_events_of_rates_match(pair: Pair) -> None:
    """The same holds for state over several messages, and for irregular stamps."""
    pair.compare()


@pytest.mark.slow
@thorough
@given(programs(kinds=tuple(MORE_KINDS)).flatmap(pairs))
def test_events_of_integers_and_elements_match(pair: Pair) -> None:
    """The same holds for integers of all widths, texts and booleans in arrays, and float32."""
    pair.compare()


@pytest.mark.parametrize("path", COUNTEREXAMPLES, ids=lambda path: path.stem)
def test_former_counterexample_passes(path: Path) -> None:
    """Former differences must not occur any more."""
    counterexamples.read(path).compare()


def test_counterexamples_round_trip(tmp_path: Path) -> None:
    """A stored pair is read back unchanged."""

    @settings(thorough, max_examples=scaled(50), derandomize=True)
    @given(programs().flatmap(pairs))
    def check(pair: Pair) -> None:
        path = counterexamples.write(pair, tmp_path)
        kept = counterexamples.read(path)
        assert kept.program == pair.program
        assert counterexamples.write(kept, tmp_path) == path  # whose name depends on the content

    check()


@pytest.fixture(scope="module")
def robot(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder of a system with every topic of the random programs."""
    folder = tmp_path_factory.mktemp("robot")
    (folder / "robot.rnd").write_text(NODE_TEXT)
    (folder / "robot.system").write_text(SYSTEM_TEXT)
    return folder


def _build(text: str, folder: Path) -> Program:
    repository = Repository()
    model = repository.load_text(folder / "random.deros", text).model
    assert isinstance(model, Rules), repository.diagnostics
    result = build(model, InterfaceStore())
    assert result.program is not None, result.diagnostics
    return result.program


@thorough
@given(data=st.data())
@pytest.mark.essential
def test_events_of_parsed_rules_match(data: st.DataObject, robot: Path) -> None:
    """Rules written as text, parsed and generated behave like the original program."""
    meant = data.draw(programs(writable=True))
    text = rules_text(meant)
    note(text)
    built = _build(text, robot)
    steps = [each for each in data.draw(traces(meant)) if each.topic in ("", *built.topics)]
    read = [_as_read_by(meant, built, step) for step in steps]
    assert _happened(meant, steps) == _happened(built, read)
    compare(built, read, render_monitor(built))


def _as_read_by(meant: Program, built: Program, step: Step) -> Step:
    """Return a step with the leaves of its message as numbered by another program."""
    fields = {
        (meant.inputs[leaf.input].topic, leaf.path): step.leaves[leaf.index]
        for leaf in meant.leaves
        if leaf.index in step.leaves
    }
    leaves = {
        leaf.index: fields[built.inputs[leaf.input].topic, leaf.path]
        for leaf in built.leaves
        if built.inputs[leaf.input].topic == step.topic
    }
    return replace(step, leaves=leaves)


def _happened(program: Program, steps: list[Step]) -> list[Event]:
    engine = Engine(program, START_NS)
    for t_ns, step in timed(steps):
        call(engine, t_ns, step)
    return engine.events
