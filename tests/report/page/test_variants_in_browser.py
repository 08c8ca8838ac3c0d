"""The page computes variants as deros does: held against Python, for random systems and values."""

from __future__ import annotations

import math
import struct
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st
from playwright.sync_api import Browser

from deros.diagnostics import SourceFile, Span
from deros.models.arguments import (
    Argument,
    Calculation,
    Chosen,
    Compared,
    Condition,
    Expression,
    Holds,
    Interpolation,
    Joined,
    Literally,
    Not,
    OneOf,
    Opposite,
)
from deros.models.common import Scalar
from deros.models.system import System
from deros.report.page import render
from deros.report.page.expressions import Encoder, literal
from deros.systems.arguments.evaluate import CannotEvaluate, evaluate, holds
from deros.systems.arguments.resolve import resolve
from deros.systems.flat import FlatProcess
from deros.systems.flatten import flatten
from deros.validators.wiring.graph import CHANNEL, SOURCES
from tests.support import argument_systems
from tests.support.browser import opened, text_of
from tests.support.needs import needs
from tests.support.profiles import scaled
from tests.support.systems import load_text

pytestmark = needs("chromium", "elkjs")

Seen = tuple[list[str], list[tuple[str, str]]]
"""The kinds and names of programs and channels, and of both sides of each arrow."""


def _expected(system: System, values: dict[str, Scalar]) -> Seen:
    flat = flatten(resolve(system, values))
    names = [
        f"process {each.full_name}" if isinstance(each, FlatProcess) else f"node {each.full_name}"
        for each in flat.programs
    ]
    channels = {f"topic {each.name}" for each in flat.topics}
    edges = []
    for node in flat.nodes:
        for port in node.ports:
            channel, name = f"{CHANNEL[port.port.kind]} {port.topic}", f"node {node.full_name}"
            channels.add(channel)
            edges.append((name, channel) if port.port.kind in SOURCES else (channel, name))
    return sorted([*names, *channels]), sorted(edges)


@pytest.mark.slow
@settings(
    max_examples=scaled(15),
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow],
)
@given(
    argument_systems.systems(),
    st.lists(
        st.fixed_dictionaries(
            {name: st.sampled_from(values) for name, values in argument_systems.VALUES.items()}
        ),
        min_size=4,
        max_size=4,
    ),
)
def test_page_shows_what_deros_makes_of_the_values(
    tmp_path: Path, chromium: Browser, text: str, assignments: list[dict[str, Scalar]]
) -> None:
    """All that is there, under the names that it has, with all arrows, and nothing else."""
    system = argument_systems.load(tmp_path, text)
    with opened(chromium, text_of(system), tmp_path) as page:
        for values in assignments:
            for name, value in values.items():
                page.switch(name, value)
            names = [each for each in page.names if not each.startswith("subsystem ")]
            assert (names, page.edges) == _expected(system, values), (text, values)


@pytest.mark.parametrize("space", ["", "/", "inner", "/outer", "a/b"])
@pytest.mark.parametrize("topic", ["scan", "/scan", "~/scan"])
def test_computed_names_resolve_as_in_ros(
    tmp_path: Path, chromium: Browser, space: str, topic: str
) -> None:
    """What is computed may be relative, absolute or private: only its value shows that."""
    text = """
        system S argument space : string = "x" argument topic : string = "y"
        imports import "talker.rnd"
        subsystem group namespace /robot {
          subsystem part namespace $space {
            node talker : talker wirings connect out to $topic
          }
        }
    """
    talker = "node talker : p publishes topic out : std_msgs.Bool"
    system = load_text(tmp_path, text, talker=talker)
    with opened(chromium, text_of(system), tmp_path) as page:
        page.switch("space", space)
        page.switch("topic", topic)
        names = [each for each in page.names if not each.startswith("subsystem ")]
        expected = _expected(system, {"space": space, "topic": topic})
        assert (names, page.edges) == expected


# Expressions --------------------------------------------------------------------------------------

_SPAN = Span(SourceFile("test", ""), 0, 0)
_VALUES: dict[str, Scalar] = {"t": True, "i": 2**63 - 1, "d": 0.5, "s": "a\u00e9</", "e": ""}

literals = st.one_of(
    st.integers(-3, 3),
    st.sampled_from([2**53 + 1, -(2**63), 2**63 - 1]),
    st.floats(allow_nan=False),
    st.sampled_from([0.0, -0.0, 0.5, 1e300]),
    st.sampled_from(["", "a\u00e9</", "1"]),
    st.booleans(),
)
leaves: st.SearchStrategy[Expression] = st.one_of(
    literals.map(lambda value: Literally(value, _SPAN)),
    st.sampled_from([*_VALUES, "unknown"]).map(lambda name: Argument(name, _SPAN)),
)
expressions: st.SearchStrategy[Expression] = st.recursive(
    leaves,
    lambda inner: st.one_of(
        st.builds(Calculation, st.sampled_from(["+", "-", "*", "/"]), inner, inner, st.just(_SPAN)),
        st.builds(Opposite, inner, st.just(_SPAN)),
        st.builds(Chosen, st.builds(Holds, inner, st.just(_SPAN)), inner, inner, st.just(_SPAN)),
        st.builds(
            Interpolation,
            st.lists(st.one_of(st.text(max_size=2), inner), max_size=3).map(tuple),
            st.just(_SPAN),
        ),
    ),
    max_leaves=5,
)
_words = st.sampled_from(["=", "!=", "<", "<=", ">", ">="])
_choices = st.lists(literals.map(lambda value: Literally(value, _SPAN)), max_size=3).map(tuple)
conditions: st.SearchStrategy[Condition] = st.recursive(
    st.one_of(
        st.builds(Holds, expressions, st.just(_SPAN)),
        st.builds(Compared, _words, expressions, expressions, st.just(_SPAN)),
        st.builds(OneOf, expressions, _choices, st.just(_SPAN)),
    ),
    lambda inner: st.one_of(
        st.builds(Not, inner, st.just(_SPAN)),
        st.builds(
            Joined,
            st.sampled_from(["and", "or"]),
            st.lists(inner, min_size=1, max_size=3).map(tuple),
            st.just(_SPAN),
        ),
    ),
    max_leaves=4,
)

_DRIVER = """
([values, trees]) => {
  %s
  const known = new Map(values.map(([name, value]) => [name, decoded(value)]));
  const encoded = (value) => {
    if (typeof value === "bigint") return { int: String(value) };
    if (typeof value !== "number") return value;
    const bits = new DataView(new ArrayBuffer(8));
    bits.setFloat64(0, value);
    return { bits: String(bits.getBigUint64(0)) };
  };
  return trees.map(([isCondition, tree]) => {
    try {
      return [encoded(isCondition ? holds(tree, known) : evaluate(tree, known))];
    } catch (fault) {
      if (!(fault instanceof CannotEvaluate)) throw fault;
      return [];
    }
  });
}
"""


def _value(found: Expression | Condition) -> list[Any]:
    try:
        if isinstance(found, Holds | Compared | OneOf | Not | Joined):
            return [holds(found, _VALUES)]
        value = evaluate(found, _VALUES)
    except CannotEvaluate:
        return []
    if isinstance(value, float):
        assert not math.isnan(value)
        return [{"bits": str(struct.unpack(">Q", struct.pack(">d", value))[0])}]
    return [literal(value)]


_LARGE = [
    Calculation("/", Literally(one, _SPAN), Literally(other, _SPAN), _SPAN)
    for one in (2**63 - 1, -(2**63), 2**53 + 1, 0, -7)
    for other in (2**53 + 1, -(2**53) - 1, 3, 2**63 - 1)
]
"""Quotients that are others where the integers are rounded to doubles before."""

_WHOLE = Calculation("+", Literally(7, _SPAN), Literally(1, _SPAN), _SPAN)
_MIXED = [
    Chosen(Holds(Literally(False, _SPAN), _SPAN), other, _WHOLE, _SPAN)
    for other in (
        Literally(0.5, _SPAN),
        Literally(7, _SPAN),
        Opposite(Literally(0.5, _SPAN), _SPAN),
        Calculation("/", Literally(1, _SPAN), Literally(0, _SPAN), _SPAN),
        Chosen(Holds(Literally(True, _SPAN), _SPAN), Literally(7, _SPAN), _WHOLE, _SPAN),
        Chosen(
            Holds(Literally(True, _SPAN), _SPAN), Literally(7, _SPAN), Literally(0.5, _SPAN), _SPAN
        ),
    )
]
"""Choices of an integer, the other value of which may be a double."""


@settings(max_examples=scaled(30), suppress_health_check=[HealthCheck.too_slow])
@example(_LARGE)
@example(_MIXED)
@given(st.lists(st.one_of(expressions, conditions), min_size=20, max_size=40))
def test_trees_mean_what_the_expressions_mean(
    blank: Any, found: list[Expression | Condition]
) -> None:
    """To the bit, for integers of 64 bits, too; what has no value in deros has none in the page."""
    encoder = Encoder(None)
    trees = []
    for each in found:
        if isinstance(each, Holds | Compared | OneOf | Not | Joined):
            trees.append([True, encoder.condition(each)])
        else:
            trees.append([False, encoder.expression(each)])
    values = [[name, literal(value)] for name, value in _VALUES.items()]
    script = (Path(render.__file__).parent / "assets/evaluate.js").read_text()
    assert blank.evaluate(_DRIVER % script, [values, trees]) == [_value(each) for each in found]


@pytest.fixture(scope="module")
def blank(chromium: Browser) -> Any:
    """Return a page without anything, to run scripts in."""
    return chromium.new_page()
