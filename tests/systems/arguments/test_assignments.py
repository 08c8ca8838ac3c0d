"""The values of arguments that conditions tell apart, and their combinations."""

from __future__ import annotations

import contextlib
from collections.abc import Sequence
from pathlib import Path

import pytest

from deros.models.common import Scalar
from deros.systems.arguments.assignments import MOST_CLASSES, Space, space_of
from deros.systems.arguments.diagrams import TooManyCombinations
from deros.systems.arguments.evaluate import CannotEvaluate, holds
from deros.systems.arguments.scopes import Scope
from deros.systems.arguments.varied import varied
from tests.support.arguments import arguments, condition, expression
from tests.support.systems import load_text


def _space(declared: str, *conditions: str, used: Sequence[str] | None = None) -> Space:
    found = arguments(declared)
    scope = Scope(found)
    names = [each.name for each in found] if used is None else used
    return space_of(found, names, [(scope, condition(each)) for each in conditions])


def _assignments(space: Space) -> list[dict[str, Scalar]]:
    return [space.assignment(number) for number in range(space.count)]


# Combinations ------------------------------------------------------------------------------------


def test_smallest_assignments_come_first() -> None:
    """The usual values, then those in which one argument differs, then those in which two do."""
    space = Space({"a": [True, False], "b": ["x", "y", "z"], "fixed": [1]})
    assert [tuple(each.values()) for each in _assignments(space)] == [
        (True, "x"),
        (False, "x"),
        (True, "y"),
        (True, "z"),
        (False, "y"),
        (False, "z"),
    ]


def test_set_of_an_argument_without_a_choice_is_everything() -> None:
    """A space without varied arguments has one assignment."""
    space = Space({"fixed": [1]})
    assert (space.count, space.assignment(0)) == (1, {})
    assert list(space.classes(["fixed"])) == [({}, space.everything)]


def test_classes_share_all_assignments() -> None:
    """Each assignment is in the class of its values, and in no other."""
    space = Space({"a": [True, False], "b": ["x", "y", "z"], "c": [1, 2]})
    classes = list(space.classes(["c", "a", "unknown"]))
    assert len(classes) == 4
    everything = space.nothing
    for values, mask in classes:
        assert not everything & mask
        everything |= mask
        for assignment, alone in space.classes(space.values):
            is_in = all(assignment[name] == value for name, value in values.items())
            assert is_in == bool(mask & alone)
    assert everything == space.everything


def test_smallest_assignment_of_a_set() -> None:
    """It is the one with the fewest arguments that differ from their usual values."""
    space = _space(
        "argument a : bool = true argument b : bool = false argument c : bool = false",
        "a",
        "b or c",
    )
    given = Scope(arguments("argument a : bool argument b : bool argument c : bool"))
    mask = space.where(condition("not a and (b or c)"), given)
    number = space.smallest(mask)
    assert space.assignment(number) == {"a": False, "b": True, "c": False}
    assert space.difference(number) == {"a": False, "b": True}
    assert space.difference(number, space.smallest(space.where(condition("c"), given))) == {
        "a": False,
        "b": True,
        "c": False,
    }


def test_conditions_are_told_apart_whatever_the_number_of_arguments() -> None:
    """Of 60 arguments, the set in which 30 pairs agree is one of a billion."""
    names = [f"a{place}" for place in range(60)]
    declared = " ".join(f"argument {name} : bool = false" for name in names)
    pairs = zip(names[::2], names[1::2], strict=True)
    text = " and ".join(f"{one} = {other}" for one, other in pairs) + " and (a2 or a58)"
    space = _space(declared, text)
    assert space.count == 1 << 60
    mask = space.where(condition(text), Scope(arguments(declared)))
    assert space.difference(space.smallest(mask)) == {"a2": True, "a3": True}


def test_one_comparison_of_too_many_arguments() -> None:
    """Its combinations are gone through, so that they have a limit."""
    names = [f"n{place}" for place in range(8)]
    declared = " ".join(f"argument {name} : int = 1 in [1, 9]" for name in names)
    outer = Scope(arguments(declared))
    bound = {"k": expression(" + ".join(f"${name}" for name in names))}
    inner = Scope(arguments("argument k : int"), bound, outer)
    space = Space({name: range(1, 10) for name in names})
    assert space.count > MOST_CLASSES
    with pytest.raises(TooManyCombinations) as raised:
        space.where(condition("k > 3"), inner)
    assert raised.value.span is not None
    assert raised.value.span.text == "k > 3"


# Values ------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("declared", "conditions", "values"),
    [
        ("argument a : bool = true", [], (True, False)),
        ("argument a : string = 'm' one_of ['x', 'm', 'y']", [], ("m", "x", "y")),
        ("argument a : int = 3 one_of [1, 3]", ["a > 1"], (3, 1)),
        ("argument a : string = 'x'", [], None),
        ("argument a : string = 'x'", ["a = 'q' or a in ['p', 'x']"], ("x", "p", "q", "other")),
        ("argument a : string = 'x'", ["a = 'q'"], ("x", "q")),
        ("argument a : string = 'x'", ["a = 'x'"], ("x", "other")),
        ("argument a : string = 'other'", ["a = 'other'"], ("other", "other1")),
        ("argument a : double = 1", ["a > 3"], (1.0, 3.0, 2.0, 0.0, 4.0)),
        ("argument a : double = 1 in [0.5, 3]", ["3 < a"], (1.0, 3.0, 2.0)),
        ("argument a : double = 1 in [0.5, 3)", ["a >= 3"], (1.0, 2.0)),
        ("argument a : double = 2 > 0", ["a < 1"], (2.0, 1.0, 1.5, 3.0, 0.5)),
        ("argument a : double = 0.1 < 1", ["a > 0.5"], (0.1, 0.5, 0.3, -0.9, 0.75)),
        ("argument a : int = 1", ["a > 2"], (1, 0, 2, 3)),
        ("argument a : int = 1", ["a > 2.5"], (1, 0, 2, 3)),
        ("argument a : int = 1 in [1, 2]", ["a = 2"], (1, 2)),
        ("argument a : int = 2", ["not (a = 2 and true)"], (2, 1, 3)),
        ("argument a : double = 5", ["a < inf"], (5.0, 4.0, 6.0, "inf")),
    ],
)
def test_values_that_conditions_tell_apart(
    declared: str, conditions: list[str], values: tuple[Scalar, ...] | None
) -> None:
    """One stands for each constant and each side of it, within what the declaration allows."""
    quoted = declared.replace("'", '"')
    found = _space(quoted, *(each.replace("'", '"') for each in conditions)).values.get("a")
    expected = values and tuple(float("inf") if each == "inf" else each for each in values)
    assert found == expected


def test_argument_that_nothing_varies_with_has_one_value() -> None:
    """What conditions do not decide, and expressions do not use, doubles no work."""
    declared = "argument a : bool = true argument b : bool = true"
    assert list(_space(declared, "a", used=["a"]).values) == ["a"]


def _both(space: Space, text: str, declared: str) -> None:
    """Assert that a condition holds for some assignments, and does not for others."""
    mask = space.where(condition(text), Scope(arguments(declared)))
    assert mask not in (space.nothing, space.everything), space.values


@pytest.mark.parametrize(
    ("declared", "text"),
    [
        ("argument a : int = 1 argument b : int = 2", "a < b"),
        ("argument a : int = 1 argument b : int = 2", "a = b"),
        ("argument a : double = 0 in [0, 3] argument b : double = 9 in [2, 9]", "a > b"),
        ("argument a : double = 0 in [0, 3] argument b : double = 9 in [2, 9]", "a = b"),
        ("argument a : string = 'x' argument b : string = 'y'", "a = b"),
        ("argument a : string = 'x' argument b : string = 'x'", "a != b"),
        ("argument a : string = 'x' argument b : string = 'y'", "a = b and a = 'q'"),
        ("argument a : string = 'x' one_of ['x', 'y'] argument b : string = 'z'", "a = b"),
        ("argument a : bool = true argument b : bool = true", "a = b"),
        ("argument a : int = 1 argument b : int = 1", "a = b and a > 5"),
        ("argument a : double = 1 argument b : int = 1", "a > 5 and b > 5 and a < b"),
    ],
)
def test_arguments_that_are_compared_with_each_other(declared: str, text: str) -> None:
    """Each has values on both sides of the other's, and at them."""
    declared, text = declared.replace("'", '"'), text.replace("'", '"')
    _both(_space(declared, text), text, declared)


@pytest.mark.parametrize(
    ("declared", "passed", "text"),
    [
        ("argument n : int = 10", "$n", "k > 5"),
        ("argument n : int = 10", "$n * 2", "k > 5"),
        ("argument n : int = 10", "2 * $n - 1", "k = 5"),
        ("argument n : double = 10", "-$n", "k < 0"),
        ("argument n : double = 10", "$n / 4", "k > 100"),
        ("argument n : double = 10", "4 / $n", "k < 0"),
        ("argument n : double = 10", "4 / $n", "k > 8"),
        ("argument n : double = 10", "($n + 1) * 3 - 2", "k in [7.0, 8.0]"),
        ("argument n : int = 1 argument m : int = 1", "$n + $m", "k > 5"),
        ("argument n : double = 1 in [0, 2] argument m : double = 1 in [0, 4]", "$n + $m", "k > 5"),
    ],
)
def test_numbers_that_are_passed_to_another_system(declared: str, passed: str, text: str) -> None:
    """A condition on what is computed from an argument tells its values apart, too."""
    outer = Scope(arguments(declared))
    inner = Scope(arguments("argument k : double"), {"k": expression(passed)}, outer)
    found = space_of(outer.arguments, "nm", [(inner, condition(text))])
    results = set()
    for each in _assignments(found):
        with contextlib.suppress(CannotEvaluate):  # a quotient has none at zero
            results.add(holds(condition(text), inner.values(each)))
    assert results == {True, False}, found.values


def test_conditions_in_values_tell_apart(tmp_path: Path) -> None:
    """Those in what is passed to a used system, and those that only a value depends on."""
    (tmp_path / "arm.system").write_text(
        'system Arm argument k : int imports import "n.rnd" node n : n when k > 4'
        " parameters param rate = if k > 2 then 1.0 else $k / 2"
    )
    text = (
        'system S argument n : int = 0 imports import "arm.system"'
        " subsystem arm : Arm(k = if n > 10 then $n else 3)"
    )
    system = load_text(tmp_path, text, n="node n : p parameters name rate : double = 1.0")
    values = varied(system).space.values["n"]
    assert {isinstance(each, int) and each > 10 for each in values} == {True, False}


@pytest.mark.parametrize(
    ("passed", "text"),
    [
        ("$robot", "who = 'left_arm'"),
        ("'${robot}_arm'", "who = 'left_arm'"),
        ("'${robot}_arm'", "who != 'left_arm'"),
        ("'x_${robot}'", "who in ['x_1', 'x_2']"),
    ],
)
def test_texts_that_are_passed_to_another_system(passed: str, text: str) -> None:
    """What is left of the text that a condition has is a value of the argument."""
    outer = Scope(arguments('argument robot : string = "r"'))
    passed, text = passed.replace("'", '"'), text.replace("'", '"')
    inner = Scope(arguments("argument who : string"), {"who": expression(passed)}, outer)
    space = space_of(outer.arguments, {"robot"}, [(inner, condition(text))])
    results = {holds(condition(text), inner.values(each)) for each in _assignments(space)}
    assert results == {True, False}, space.values


def test_inner_condition_makes_an_outer_argument_vary() -> None:
    """It does so through every system between, and only for the argument that is passed."""
    outer = Scope(arguments("argument speed : double = 1 argument idle : double = 1"))
    middle = Scope(arguments("argument v : double"), {"v": expression("$speed")}, outer)
    inner = Scope(
        arguments("argument w : double argument own : double = 2"),
        {"w": expression("$v + 1")},
        middle,
    )
    conditions = [(inner, condition("w > 3")), (inner, condition("own > 7"))]
    space = space_of(outer.arguments, {"speed", "idle"}, conditions)
    assert list(space.values) == ["speed"]
    assert {2.0, 1.0} < set(space.values["speed"])


def test_constants_that_no_argument_can_have() -> None:
    """They break nothing: numbers beyond the range, texts for numbers, division by zero."""
    outer = Scope(arguments("argument n : int = 10"))
    inner = Scope(arguments("argument k : double"), {"k": expression("$n / 0")}, outer)
    big = 10**300
    conditions = [
        (outer, condition(f'n > {big} or n = "x" or n in [{big}, "y"]')),
        (inner, condition("k > 5")),
        (Scope(inner.arguments, {"k": expression(f"$n * {big}")}, outer), condition(f"k < {big}")),
        (Scope(inner.arguments, {"k": expression(f"$n / {big}")}, outer), condition(f"k < {big}")),
    ]
    assert space_of(outer.arguments, {"n"}, conditions).values["n"][0] == 10
