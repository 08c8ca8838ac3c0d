"""Whatever texts and numbers a system has, its nodes get them as they are, with their types."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from deros.generators.api.protocol import GenerationError
from deros.metamodels.parameter_files.scalars import is_misread
from deros.models.common import Scalar
from deros.models.system import System
from tests.generators.system.test_arguments import (
    as_modelled,
    from_launch,
    from_script,
    launch_file,
    plain,
    script_of,
)
from tests.support.arguments import text_of
from tests.support.frontend_files import TARGETS, Tree, started, tree
from tests.support.systems import CONTEXT, load_text

OPEN = "node open : p parameters open"
DECLARED = """node declared : p parameters
  name t : string = "z"
  name ts : string[] = ["z"]
  name d : double = 0.0
  name ds : double[] = [1.0]
  name i : int = 0
  name b : bool = false
  name bs : bool[] = [true]
"""
SYSTEM = """system S
argument s : string
argument c : string one_of [{choices}]
argument x : double
argument n : int in [-1000, 1000]
argument b : bool
imports import "open.rnd" import "declared.rnd"
node one : open
parameters
  param t1 = $s param t2 = $c param t3 = {text} param t4 = "${{s}}_${{n}}" param t5 = "${{n}}"
  param t6 = if b then $s else {text}
  param ts = [$s, {text}, $c] param us = [{text}, {other}]
  param d1 = $x param d2 = -$x param ds = [1, nan, $x] param es = [$x, {number}]
  param i1 = $n param i2 = $n + 1 param is = [$n, 2] param "qos_overrides./scan.depth" = $n
  param b1 = $b param bs = [$b, false]
node two : declared
parameters
  param t = $s param ts = [{text}, $s, $c]
  param d = $n param ds = [$n, $x, inf] param i = $n - 1 param b = $b param bs = [true, $b]
"""
WORDS = (
    *("y", "N", "no", "true", "~", "null", "1", "1.5", "1e3", "1.5e+3", "-.5", "08", "0x1F"),
    *("0X1F", "0x1p3", "inf", "-Infinity", "nan", ".nan", "nan(1)", "1_000", "C:\\new", "c\\d"),
    *('man"ual', "it's", "", " a ", "a: b", "# c", "- d", "[e]", "{f}", "10:30", "2026-01-01"),
)
texts = st.sampled_from(WORDS) | st.text("ayNe018.+-x'\"\\ {}[]:,#é", max_size=5)
doubles = st.floats(allow_nan=False) | st.sampled_from([1.0, 1e-05, float("inf"), -float("inf")])


def written(text: str) -> str:
    """Return a text as it stands in a system."""
    escaped = text.replace("\\", "\\\\").replace('"', '\\"')
    return f'"{escaped}"'


def types_and_values(nodes: list[tuple[Any, ...]]) -> list[tuple[str, dict[str, str]]]:
    """Return the parameters of nodes, of which nan is like nan."""
    return [(node[0], {name: shown for name, (_, shown) in node[2].items()}) for node in nodes]


def from_frontends(system: System) -> Iterator[Tree]:
    """Yield the files in XML and YAML."""
    for language, target in TARGETS.items():
        (file,) = target(system, CONTEXT).values()
        yield tree(file.text, language)


@settings(max_examples=60, deadline=None)
@given(
    choices=st.lists(texts, min_size=1, max_size=3, unique=True),
    constants=st.tuples(texts, texts),
    number=doubles,
    data=st.data(),
)
@pytest.mark.essential
def test_values_arrive_as_they_are(
    tmp_path_factory: pytest.TempPathFactory,
    choices: list[str],
    constants: tuple[str, str],
    number: float,
    data: st.DataObject,
) -> None:
    """Those that launch files in XML and YAML cannot hand on are refused, and no others."""
    text = SYSTEM.format(
        choices=", ".join(map(written, choices)),
        text=written(constants[0]),
        other=written(constants[1]),
        number=number if abs(number) < 1e15 else 1,
    )
    system = load_text(tmp_path_factory.mktemp("any"), text, open=OPEN, declared=DECLARED)
    values: dict[str, Scalar] = {
        "s": data.draw(texts),
        "c": data.draw(st.sampled_from(choices)),
        "x": data.draw(doubles),
        "n": data.draw(st.integers(-1000, 1000)),
        "b": data.draw(st.booleans()),
    }
    given = {name: text_of(value) for name, value in values.items()}
    expected = types_and_values(as_modelled(system, values))
    assert types_and_values(from_launch(launch_file(system), given)) == expected
    if any(map(is_misread, constants)):
        for target in TARGETS.values():
            with pytest.raises(GenerationError, match="put no quotes around the text"):
                target(system, CONTEXT)
    elif is_misread(given["s"]) or is_misread(given["c"]):
        for read in from_frontends(system):
            with pytest.raises(ValueError, match="ROS 2 would read it as a bool or a number"):
                list(started(read, given))
    else:
        for read in from_frontends(system):
            nodes = [(each.full_name, "", plain(each.parameters)) for each in started(read, given)]
            assert types_and_values(nodes) == expected


LIMITS = """system S
argument limit : double = inf > 0
argument other : double = nan
argument one : double = 1.0 one_of [1.0, inf]
argument n : int = 3 >= 0
argument free : double = 2.0
argument same : double = $other
imports import "declared.rnd"
node two : declared
parameters
  param d = $limit param ds = [$other, $one, $free, $same] param i = $n
"""


def test_any_number_may_be_a_default(tmp_path: Path) -> None:
    """Launch files take their own defaults, and the largest integer."""
    system = load_text(tmp_path, LIMITS, declared=DECLARED)
    values: dict[str, Scalar] = {"limit": 0.5, "other": 1.5, "one": 1.0, "n": 2**63 - 1}
    values |= {"free": 3.0, "same": 0.5}
    for chosen in ({}, values):
        expected = types_and_values(as_modelled(system, chosen))
        given = {name: text_of(value) for name, value in chosen.items()}
        assert types_and_values(from_launch(launch_file(system), given)) == expected
        for read in from_frontends(system):
            nodes = [(each.full_name, "", plain(each.parameters)) for each in started(read, given)]
            assert types_and_values(nodes) == expected


DOUBLES = """system S
argument n : int = 2
argument b : bool = true
imports import "open.rnd" import "inner.system"
node one : open
parameters
  param a = if b then $n else 0.5
  param c = (if b then $n else 0.5) * 2
  param e = if b then $n else 3
subsystem i : Inner(x = $n, b = true)
"""
INNER = """system Inner
argument x : double
argument b : bool
imports import "open.rnd"
node two : open
parameters
  param a = $x param c = 3 * $x param e = if b then 1 else $x / 0
  param s = [1, $x]
"""


def test_doubles_are_doubles_wherever_nothing_else_says_so(tmp_path: Path) -> None:
    """An integer is one where it stands beside a double, or is given where one is declared."""
    (tmp_path / "inner.system").write_text(INNER)
    system = load_text(tmp_path, DOUBLES, open=OPEN)
    for b in (True, False):
        expected = types_and_values(as_modelled(system, {"b": b}))
        assert expected[1][1]["a"] == "2.0"
        assert expected[0][1]["a"] == ("2.0" if b else "0.5")
        given = {"b": text_of(b)}
        words = [f"b:={text_of(b)}"]
        assert types_and_values(from_script(script_of(system), words)) == expected
        assert types_and_values(from_launch(launch_file(system), given)) == expected
        for read in from_frontends(system):
            nodes = [(each.full_name, "", plain(each.parameters)) for each in started(read, given)]
            assert types_and_values(nodes) == expected


@pytest.mark.parametrize(
    ("word", "wanted"),
    [
        ("limit:=01", "a number > 0.0"),
        ("limit:=-inf", "a number > 0.0"),
        ("free:=nan", "a number"),
        (f"n:={2**63}", "an integer of 64 bits >= 0.0"),
        ("n:=99999999999999999999", "an integer of 64 bits"),
    ],
)
def test_what_is_no_number_for_all_is_refused(tmp_path: Path, word: str, wanted: str) -> None:
    """For Python, ``01`` is no number; for ROS 2, what is beyond 64 bits is no integer."""
    system = load_text(tmp_path, LIMITS, declared=DECLARED)
    name, value = word.split(":=")
    with pytest.raises(ValueError, match=f"{name} is '{value}': it has to be {wanted}"):
        from_launch(launch_file(system), {name: value})
    for read in from_frontends(system):
        with pytest.raises(ValueError, match=f"{name} is '{value}': it has to be {wanted}"):
            list(started(read, {name: value}))


CALCULATED = """system S
argument n : int = 2
argument m : int = 2 in [0, 10]
argument b : bool = true
imports import "open.rnd"
node one : open when b
parameters
  param a = $n * 2 - 3 param c = $m * 100 param e = if m > 5 then -$n else 3
"""


@pytest.mark.parametrize(
    ("given", "name"),
    [
        ({}, ""),
        ({"n": str(2**62)}, "a"),
        ({"n": str(2**62), "b": "false"}, ""),
        ({"n": str(1 - 2**62)}, "a"),
        ({"n": str(1 - 2**61), "m": "6"}, ""),
    ],
)
def test_integers_on_the_way_have_64_bits(tmp_path: Path, given: dict[str, str], name: str) -> None:
    """All that start a system refuse what leaves them; what cannot is not asked."""
    system = load_text(tmp_path, CALCULATED, open=OPEN)
    text = launch_file(system)
    assert "parameter c" not in text
    said = f"parameter {name} of one is no integer of 64 bits"
    refused = pytest.raises(ValueError, match=said) if name else contextlib.nullcontext()
    with refused:
        from_launch(text, given)
    for read in from_frontends(system):
        with refused:
            list(started(read, given))


def test_choices_that_xacro_cannot_get_are_refused(tmp_path: Path) -> None:
    """``launch`` takes its command apart as a shell does, where a quote ends a text."""
    text = '<robot xmlns:xacro="http://ros.org/wiki/xacro"><xacro:arg name="k" default=""/></robot>'
    (tmp_path / "a.xacro").write_text(text)
    system = load_text(
        tmp_path,
        'system S argument c : string = "a" one_of ["a", "q\\"r"] imports import "open.rnd"'
        ' node one : open parameters param r from xacro "a.xacro" (k = $c)',
        open=OPEN,
    )
    with pytest.raises(ValueError, match="a text without quotes and backslashes"):
        from_launch(launch_file(system), {"c": 'q"r'})
