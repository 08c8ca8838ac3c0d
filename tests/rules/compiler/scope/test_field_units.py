"""Units of fields and of what is computed of them, held against exact arithmetic in SI units."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

import pytest
from hypothesis import assume, given, note
from hypothesis import strategies as st

from deros import codes
from deros.diagnostics import SourceFile, Span
from deros.interfaces.fields import FieldPath
from deros.interfaces.types import InterfaceType
from deros.interfaces.units import UnitRegistry
from deros.rules.compiler.scope.field_units import FieldUnits
from deros.rules.compiler.scope.topics import SystemTopics
from deros.rules.engine.engine import Engine
from tests.support.rules import build_rules, embedded_store

FACTORS = {
    "m": Fraction(1),
    "cm": Fraction(1, 100),
    "km": Fraction(1000),
    "inch": Fraction(254, 10_000),
}
NUMBERS = st.integers(1, 40)
UNITS = st.sampled_from(sorted(FACTORS))
DECLARED = "cm"
POSITION, LENGTH = 3.0, 7.0
"""What the messages say: the position in metres, as REP 103 has it, and a length in centimetres."""


@dataclass(frozen=True)
class Term:
    """A term, its value in powers of metres, and which power."""

    text: str
    value: Fraction
    power: int


LEAVES = st.one_of(
    st.just(Term("x", Fraction(POSITION), 1)),
    st.just(Term("length", Fraction(LENGTH) * FACTORS[DECLARED], 1)),
    st.builds(lambda n, u: Term(f"{n} {u}", n * FACTORS[u], 1), NUMBERS, UNITS),
)


def joined(operands: tuple[Term, Term], operator: str) -> Term:
    """Return a term of two; a product where these cannot be added."""
    one, other = operands
    text = f"({one.text} {operator} {other.text})"
    if operator == "/":
        return Term(text, one.value / other.value, one.power - other.power)
    if operator == "*" or one.power != other.power:
        return Term(
            f"({one.text} * {other.text})", one.value * other.value, one.power + other.power
        )
    value = one.value + other.value if operator == "+" else one.value - other.value
    return Term(text, value, one.power)


def terms() -> st.SearchStrategy[Term]:
    """Return terms of lengths, areas and so on; divisors are lengths, and so are not zero."""
    return st.recursive(
        LEAVES,
        lambda inner: st.one_of(
            st.builds(joined, st.tuples(inner, inner), st.sampled_from("+-*")),
            st.builds(joined, st.tuples(inner, LEAVES), st.just("/")),
            st.builds(
                lambda n, each: Term(f"{n} * {each.text}", n * each.value, each.power),
                NUMBERS,
                inner,
            ),
        ),
        max_leaves=5,
    )


def verdict(condition: str) -> bool | None:
    """Return what a rule says of the messages; ``None`` if it is refused for a plain number."""
    built = build_rules(
        f"input x = topic /odom.pose.pose.position.x input length = topic /speed.data [{DECLARED}]"
        f" entity e {{ r: {condition}; q: x > 0 and length > 0; }}"
    )
    if built.program is None:
        assert {each.code for each in built.diagnostics} == {codes.PLAIN_BESIDE_COMPUTED}
        return None
    engine = Engine(built.program, 0)
    values = {"/odom": POSITION, "/speed": LENGTH}
    for time, each in enumerate(built.program.inputs):
        engine.message(time, each.topic, {each.leaves[0]: values[each.topic]})
    return engine.explain().rules[0].value


def _assume_apart(value: Fraction, bound: Fraction) -> None:
    """Leave out what is decided by the rounding of the engine, which computes with doubles."""
    assume(abs(value - bound) > 1e-9 * max(abs(value), abs(bound)))


@given(terms(), NUMBERS, UNITS)
def test_quantities_are_converted_exactly(term: Term, number: int, unit: str) -> None:
    """Whatever the units are, a comparison means what exact arithmetic in SI units says."""
    bound = number * FACTORS[unit] ** term.power
    assume("x" in term.text or "length" in term.text)
    _assume_apart(term.value, bound)
    shown = f"{unit}^{term.power}" if term.power else "dimensionless"
    bound = bound if term.power else Fraction(number)
    condition = f"{term.text} > {number} {shown}"
    note(condition)
    assert verdict(condition) is (term.value > bound)


@given(terms(), NUMBERS)
def test_plain_number_is_in_a_unit_that_is_seen(term: Term, number: int) -> None:
    """Beside what is computed it is one in SI units, in a unit with a name, or is refused."""
    assume("x" in term.text or "length" in term.text)
    for factor in (Fraction(1), *FACTORS.values()):
        _assume_apart(term.value, number * factor)
    condition = f"{term.text} > {number}"
    note(condition)
    found = verdict(condition)
    readings = {term.value > number * factor for factor in FACTORS.values()}
    if term.text in ("length", "x") or term.power != 1:
        readings = {
            term.value > number * FACTORS[DECLARED]
            if term.text == "length"
            else term.value > number
        }
    assert found is None or found in readings


@pytest.mark.parametrize("declared", [("points", 0, "velocities"), ("points", "velocities")])
def test_element_has_the_unit_of_its_array(declared: FieldPath) -> None:
    """The array may be part of an element of another one, or of each."""
    units = UnitRegistry()
    fields = FieldUnits(embedded_store(), SystemTopics([]), units)
    kind = InterfaceType("trajectory_msgs", "msg", "JointTrajectory")
    unit = units.parse("deg/s")
    assert unit is not None
    assert not [
        *fields.declare("/way", kind, declared, unit, Span(SourceFile("a.deros", ""), 0, 0))
    ]
    assert fields.unit_of("/way", kind, ("points", 0, "velocities", 1)) == unit
