"""Usual values of arguments, and those that a system passes to one that it uses."""

from __future__ import annotations

import math

import pytest

from deros.models.common import Scalar
from deros.systems.arguments.evaluate import CannotEvaluate
from deros.systems.arguments.scopes import Scope, points, typed, usual_values
from tests.support.arguments import arguments, expression


@pytest.mark.parametrize(
    ("declaration", "value"),
    [
        ("a : integer = 3", 3),
        ("a : double = 3", 3.0),
        ('a : string = ""', ""),
        ("a : bool = true", True),
        ("a : integer", 0),
        ("a : double", 0.0),
        ("a : bool", False),
        ("a : string", "a"),
        ('a : string one_of ["x", "y"]', "x"),
        ('a : string = env("NAME") one_of ["x", "y"]', "x"),
        ('a : string = env("NAME", "y") one_of ["x", "y"]', "y"),
        ('a : string = env("NAME")', "NAME"),
        ("a : integer one_of [4, 2]", 4),
        ("a : double in [2, 3]", 2.0),
        ("a : double in (2, 3]", 3.0),
        ("a : double in (2, 3)", 2.5),
        ("a : double > 2", 3.0),
        ("a : double < -2", -3.0),
        ("a : integer >= 2", 2),
        ("a : integer in [-5, 5]", 0),
        ("a : integer in (2, 4)", 3),
    ],
)
def test_usual_value(declaration: str, value: Scalar) -> None:
    """It is the default, else a value that the declaration allows."""
    (argument,) = arguments(f"argument {declaration}")
    found = usual_values((argument,))[argument.name]
    assert (found, type(found)) == (value, type(value))


def test_what_a_variable_says_counts_where_it_is_known() -> None:
    """Whoever starts a system looks it up; what does not fit is found there."""
    declared = arguments('argument a : string = env("NAME") one_of ["x", "y"]')
    assert usual_values(declared, {"env NAME": "y"})["a"] == "y"
    assert usual_values(declared, {"env NAME": "z"})["a"] == "z"


def test_points_lie_at_and_between_the_constants() -> None:
    """One stands for each side of each constant; infinities have no other side."""
    assert sorted(points([3, 1, 1.0, math.inf])) == [0, 1, 2, 3, 4]
    assert points([]) == []
    assert points([-math.inf]) == []


def test_integers_of_double_arguments_become_doubles() -> None:
    """They are the parameters' own type wherever they come from."""
    found = typed({"x": 3, "n": 3, "other": 4}, arguments("argument x : double argument n : int"))
    assert {name: type(value) for name, value in found.items()} == {
        "x": float,
        "n": int,
        "other": int,
    }


def test_values_of_the_outermost_system() -> None:
    """What is not given has its usual value."""
    scope = Scope(arguments("argument a : int = 1 argument b : double = 2"))
    assert scope.values({}) == {"a": 1, "b": 2.0}
    assert scope.values({"b": 5}) == {"a": 1, "b": 5.0}
    assert isinstance(scope.values({"b": 5})["b"], float)


def _nested() -> Scope:
    """Return the scope of a system in a system in a system."""
    outermost = Scope(arguments('argument n : int = 1 argument who : string = "x"'))
    middle = Scope(
        arguments("argument k : double = 9 argument free : int = 5 argument label : string"),
        {"k": expression("$n * 2"), "label": expression('"${who}_arm"')},
        outermost,
    )
    return Scope(
        arguments("argument a : double argument n : int = 7"),
        {"a": expression("$k + $free")},
        middle,
    )


def test_values_are_passed_through_systems() -> None:
    """Each system sees its own arguments: those it is given, the others with their defaults."""
    inner = _nested()
    assert inner.outer is not None
    assert inner.outer.values({}) == {"k": 2.0, "free": 5, "label": "x_arm"}
    assert inner.values({"n": 4}) == {"a": 13.0, "n": 7}


def test_origins_are_arguments_of_the_outermost_system() -> None:
    """An argument that is not passed has none; one of the same name further in is another one."""
    inner = _nested()
    assert inner.outer is not None
    assert list(inner.origins(["a"])) == ["n"]
    assert list(inner.origins(["n"])) == []
    assert list(inner.outer.origins(["label", "free", "k"])) == ["who", "n"]
    assert list(Scope(arguments("argument n : int")).origins(["n"])) == ["n"]


def test_passed_value_without_a_value() -> None:
    """What has no value is reported where it is written, so it is not hidden here."""
    outer = Scope(arguments("argument n : int = 0"))
    scope = Scope(arguments("argument k : int = 1"), {"k": expression("4 / $n")}, outer)
    with pytest.raises(CannotEvaluate, match="divides by zero"):
        scope.values({})


def test_usual_values_by_name() -> None:
    """All arguments of a system at once."""
    found = usual_values(arguments("argument a : int = 1 argument b : bool"))
    assert found == {"a": 1, "b": False}
