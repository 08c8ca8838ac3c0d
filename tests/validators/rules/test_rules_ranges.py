"""Comparisons decided by the range of a type are reported, and no others."""

from __future__ import annotations

import itertools
import math
import random
from collections.abc import Iterator

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from deros.interfaces.durations import NS_PER_S
from deros.rules.engine.engine import Engine, Event
from deros.rules.program.ir import Program
from tests.support.profiles import scaled
from tests.support.rules import findings, program

DECLARED = """
action stop;
input mode = topic /mode.data timeout 1 sec
input v = topic /speed.data timeout 1 sec
input q = topic /imu.orientation timeout 1 sec
input scan = topic /scan timeout 1 sec
input odom = topic /odom timeout 1 sec
input joints = topic /joints timeout 1 sec
input bytes = topic /bytes timeout 1 sec
input flag = topic /flag.data timeout 1 sec
"""
NAMED = """
entity fast { real: v > 5; failsafe safe: v > 5; }
entity other { faster: v > 6 for 1 sec; lasting: fast.real for 1 sec; }
"""


def decided(condition: str) -> list[tuple[str, str]]:
    """Return code and place of the decided parts of a condition."""
    inputs = ("mode", "v", "q", "scan", "odom", "joints", "bytes", "flag")
    used = " or ".join(f"{each}.missing()" for each in inputs)
    statements = f"""{DECLARED} entity e {{ failsafe r: {condition}; s: {used}; }} {NAMED}
        if e.r or e.s or fast.real or fast.safe then {{ stop; }};
        if other.faster or other.lasting then {{ stop; }};"""
    results = ((code, place) for code, place, _ in findings(statements))
    return [each for each in results if each[0] not in ("DRS367", "DRS386")]  # on functions as such


UNDECIDED = (
    "mode > 254",
    "mode = 255",
    "mode in [255, 300]",
    "mode in (1, 3)",
    "v > 1e38",
    "v > 5 or v < 3",
    "v > 5 and not v < 3",
    "v > 5 and mode < 3",
    "v.abs() <= 0",
    "q.roll() > 179 deg",
    "(v > 5 within 1 sec) and v < 3",
    "(v > 5 since v > 6) and v < 5.5",
    "not (v > 5 for 1 sec) and v > 6",
    "(v > 5 begins) or v < 3",
    "flag and not (flag for 1 sec)",
    "fast.safe and v < 3",
    "fast.real or v < 3",
    "v > 5 and v.abs() < 3",
    "scan.nearest(-1.0, 1.0) > 0",
    "scan.nearest(-1.0, 1.0) <= 0",
    "scan.nearest(-1.0, 1.0) in (0, 5 m]",
    "scan.blind(-1.0, 1.0) >= 1",
    "scan.blind_gap(-1.0, 1.0) > 0",
    "mode.abs() > 254",
    "mode.rate() < -300",
    "q.roll().abs() > 179 deg",
    "odom.pose.pose.position.norm() > 1e300",
    "v.age() > 0.5 sec",
    "v.age() in [0.1 sec, 0.5 sec]",
    "q.roll() > q.tilt()",
    "q.tilt() > q.roll().abs()",
    "joints.name.count() > joints.position.count()",
    "mode < joints.name.count()",
    "odom.pose.covariance.count() < mode.abs()",
)


def test_undecided_condition_is_not_reported() -> None:
    """A condition that some values satisfy and others do not gives no finding."""
    for condition in UNDECIDED:
        assert decided(condition) == [], condition


DECIDED = (
    ("mode > 255", "DRS308", "mode > 255"),
    ("scan.nearest(-1.0, 1.0) < -0.4 m", "DRS308", "scan.nearest(-1.0, 1.0) < -0.4 m"),
    ("scan.nearest(-1.0, 1.0) >= 0 m", "DRS309", "scan.nearest(-1.0, 1.0) >= 0 m"),
    ("scan.nearest(-1.0, 1.0) in [-2, -1]", "DRS308", "scan.nearest(-1.0, 1.0) in [-2, -1]"),
    (
        "scan.nearest(-1.0, 1.0) not in [0, 2] or v > 1 and scan.nearest(-1.0, 1.0) < 0",
        "DRS308",
        "scan.nearest(-1.0, 1.0) < 0",
    ),
    ("mode.abs() > 255", "DRS308", "mode.abs() > 255"),
    ("q.pitch().abs() > 91 deg", "DRS308", "q.pitch().abs() > 91 deg"),
    ("q.tilt().abs() >= 0", "DRS309", "q.tilt().abs() >= 0"),
    ("joints.name.count().abs() < 0", "DRS308", "joints.name.count().abs() < 0"),
    ("joints.position.count() > -1", "DRS309", "joints.position.count() > -1"),
    ("odom.pose.covariance.count() = 35", "DRS308", "odom.pose.covariance.count() = 35"),
    ("bytes.data.max() > 255", "DRS308", "bytes.data.max() > 255"),
    ("bytes.data.min() < 0", "DRS308", "bytes.data.min() < 0"),
    (
        "odom.pose.pose.position.norm() < -1 m",
        "DRS308",
        "odom.pose.pose.position.norm() < -1 m",
    ),
    ("v.age() >= 0 sec", "DRS309", "v.age() >= 0 sec"),
    ("v.age() < 0 sec", "DRS308", "v.age() < 0 sec"),
    ("v.age() > 2 sec and v.age() < 1 sec", "DRS308", "v.age() > 2 sec and v.age() < 1 sec"),
    ("v.age() <= 2 sec or v.age() >= 1 sec", "DRS309", "v.age() <= 2 sec or v.age() >= 1 sec"),
    ("v > v", "DRS308", "v > v"),
    ("v <= v", "DRS309", "v <= v"),
    ("q.tilt() < q.tilt()", "DRS308", "q.tilt() < q.tilt()"),
    (
        "odom.pose.covariance.count() <= odom.twist.covariance.count()",
        "DRS309",
        "odom.pose.covariance.count() <= odom.twist.covariance.count()",
    ),
    ("q.roll() > q.pitch() and mode > 255", "DRS308", "mode > 255"),
    ("300 < mode", "DRS308", "300 < mode"),
    ("mode <= 255", "DRS309", "mode <= 255"),
    ("mode in (254.5, 254.9)", "DRS308", "mode in (254.5, 254.9)"),
    ("mode = -1 and v > 1", "DRS308", "mode = -1"),
    ("v > 1 and v > 2 and v < 2", "DRS308", "v > 1 and v > 2 and v < 2"),
    ("v = 1 and v != 1", "DRS308", "v = 1 and v != 1"),
    ("mode < 3 or mode > 2", "DRS309", "mode < 3 or mode > 2"),
    ("not (v > 5 and v < 3) for 1 sec", "DRS308", "v > 5 and v < 3"),
    ("q.tilt() < 0", "DRS308", "q.tilt() < 0"),
    ("(v > 5 for 1 sec) and v < 3", "DRS308", "(v > 5 for 1 sec) and v < 3"),
    ("(v > 5 begins) and v < 3", "DRS308", "(v > 5 begins) and v < 3"),
    ("(v > 5 since v > 6) and v < 3", "DRS308", "(v > 5 since v > 6) and v < 3"),
    ("(v > 5 within 1 sec) or v < 6", "DRS309", "(v > 5 within 1 sec) or v < 6"),
    ("flag and not flag", "DRS308", "flag and not flag"),
    ("flag or not flag", "DRS309", "flag or not flag"),
    ("fast.real and v < 3", "DRS308", "fast.real and v < 3"),
    ("not fast.real and v > 6", "DRS308", "not fast.real and v > 6"),
    ("other.faster and not fast.real", "DRS308", "other.faster and not fast.real"),
    ("other.lasting and v < 3", "DRS308", "other.lasting and v < 3"),
    ("scan.blind(-1.0, 1.0) > 100 %", "DRS308", "scan.blind(-1.0, 1.0) > 100 %"),
    ("q.pitch() > 91 deg", "DRS308", "q.pitch() > 91 deg"),
)


def test_decided_condition_is_reported_once() -> None:
    """The finding names the smallest decided condition."""
    for condition, code, place in DECIDED:
        results = [each for each in decided(condition) if each[0] != "DRS330"]
        assert results == [(code, place)], condition


@settings(max_examples=scaled(40))
@given(st.integers(-20, 280), st.integers(-20, 280), st.booleans())
def test_decided_pairs_agree_with_enumeration(low: int, high: int, both: bool) -> None:
    """A pair of comparisons is reported exactly if all 256 values give one verdict."""
    parts = [[mode >= low for mode in range(256)], [mode <= high for mode in range(256)]]
    combine = all if both else any
    verdicts = {combine(pair) for pair in zip(*parts, strict=True)}
    word = "and" if both else "or"
    results = decided(f"mode >= {low} {word} mode <= {high}")
    assert bool(results) == any(len(set(each)) == 1 for each in [*parts, verdicts])


def test_nested_behaviour_that_contradicts_the_outer_one_is_reported() -> None:
    """An inner condition that cannot hold where the outer one does never acts."""
    statements = f"""{DECLARED} {NAMED} entity low {{ is: v < 3; was: v < 3 within 1 sec; }}
        if fast.real then {{ if low.is then {{ stop; }}; if low.was then {{ stop; }}; }};
        if fast.safe then {{ if low.is then {{ stop; }}; }};"""
    found = [each[:2] for each in findings(statements) if each[0] in ("DRS308", "DRS309")]
    assert found == [("DRS308", "low.is")]


ATOMS = ("v > 2", "v <= 2", "v in [1, 2]")
FORMS = (
    "{}",
    "not ({})",
    "({}) for 1 sec",
    "not (({}) for 1 sec)",
    "({}) within 1 sec",
    "not (({}) within 1 sec)",
    "({}) begins",
    "({}) since v > 1",
    "flag since ({})",
    "v <= 1 since ({})",
    "n.{}",
    "not f.{}",
    "f.{} for 1 sec",
)
VALUES = {"v": (0.0, 1.0, 1.5, 2.0, 3.0, math.nan), "flag": (False, True)}


def _conditions() -> Iterator[str]:
    """Yield every pair of forms, joined by ``and`` and by ``or``."""
    names = {atom: f"p{number}" for number, atom in enumerate(ATOMS)}
    every = [form.format(names[atom] if "." in form else atom) for form in FORMS for atom in ATOMS]
    for word in ("and", "or"):
        for left, right in itertools.combinations(every, 2):
            yield f"({left}) {word} ({right})"


@pytest.mark.essential
def test_no_trace_contradicts_what_is_decided() -> None:
    """What is said to be never, or always, true is so through operators, names and failsafe."""
    named = "".join(f" p{number}: {atom};" for number, atom in enumerate(ATOMS))
    inputs = "input v = topic /speed.data timeout 3 sec input flag = topic /flag.data"
    common = f"{inputs} entity n {{ {named} }} entity f {{ {named.replace(' p', ' failsafe p')} }}"
    rules = dict(enumerate(_conditions()))
    entity = " ".join(f"r{number}: {condition};" for number, condition in rules.items())
    signs: dict[int, str] = {}
    for code, place, _ in findings(f"{common} entity e {{ {entity} }}"):
        if code in ("DRS308", "DRS309"):
            signs |= {
                number: "" if code == "DRS308" else "not "
                for number, condition in rules.items()
                if condition == place
            }
    assert len(signs) > len(rules) // 20
    sworn = " ".join(f"r{number}: {signs[number]}({rules[number]});" for number in signs)
    acts = "".join(f"if e.r{number} then {{ a{number}; }};" for number in signs)
    actions = " ".join(f"action a{number};" for number in signs)
    asked = program(f"{actions} {common} entity e {{ {sworn} }} {acts}")
    for seed in range(scaled(50)):
        acted = {each.action for each in _played(asked, random.Random(seed))}
        assert {rules[int(each[1:])] for each in acted} == set(), seed


def _played(asked: Program, chance: random.Random) -> list[Event]:
    """Return what a random trace triggers."""
    engine = Engine(asked)
    now_ns = 0
    for _ in range(10):
        now_ns += chance.choice((0, 1, 2)) * NS_PER_S
        each = chance.choice(asked.inputs)
        engine.message(now_ns, each.topic, {each.leaves[0]: chance.choice(VALUES[each.name])})
    engine.advance(now_ns + 10 * NS_PER_S)
    return engine.events


TUNED = """
const low = 2 tunable in [1, 3]
const high = 8 tunable in [6, 250]
const beyond = 300 tunable in [256, 400]
const tilt = 10 deg tunable in [5, 30] deg
input q = topic /imu.orientation
"""


@pytest.mark.parametrize(
    ("condition", "expected"),
    [
        ("mode > low", []),
        ("mode > low and mode < 3", []),
        ("mode > low and mode < 1", ["DRS308"]),
        ("mode > low or mode < 4", ["DRS309"]),
        ("mode > low or mode < 3", []),
        ("mode > high and mode < low", ["DRS308"]),
        ("mode in [low, high] and mode < 1", ["DRS308"]),
        ("mode in [low, high] or mode not in [4, 5]", ["DRS309"]),
        ("mode in [low, high] or mode not in [2, 5]", []),
        ("mode not in [low, high] and mode in [4, 5]", ["DRS308"]),
        ("mode not in [low, high] and mode in [3, 6]", ["DRS308"]),
        ("mode not in (low, high) and mode in [3, 6]", []),
        ("mode < beyond", ["DRS309"]),
        ("mode = beyond", ["DRS308"]),
        ("mode != beyond", ["DRS309"]),
        ("mode > 2 * beyond", ["DRS308"]),
        ("mode > -low", ["DRS309"]),
        ("mode = low and mode != low", []),
        ("q.roll() > tilt", []),
        ("q.roll() > 2 * tilt or q.roll() in [-2 * tilt, 2 * tilt]", []),
        ("q.roll() > 2 * tilt and q.roll() < 9 deg", ["DRS308"]),
        ("q.roll() > 7 * tilt", []),
        ("q.tilt() < -2 * tilt", ["DRS308"]),
        ("(mode > low since mode > high) and mode < 1", ["DRS308"]),
        ("(mode > low since mode > high) and mode < 3", []),
    ],
)
def test_tunable_constants_count_with_their_intervals(condition: str, expected: list[str]) -> None:
    """What is decided is so for all of their values; the default alone decides nothing."""
    statements = f"action stop; input mode = topic /mode.data {TUNED}"
    statements += f"entity e {{ r: {condition}; }} if e.r then {{ stop; }};"
    found = [code for code, *_ in findings(statements) if code in ("DRS308", "DRS309")]
    assert found == expected


def test_decided_by_the_interval_is_explained() -> None:
    """The message says that no value of the constants matters."""
    statements = f"action stop; input mode = topic /mode.data {TUNED}"
    statements += "entity e { r: mode < beyond; } if e.r then { stop; };"
    (message,) = (text for code, _, text in findings(statements) if code == "DRS309")
    assert message == (
        "'mode < beyond' is always true: the value is from 0 to 255, whatever the constants are"
        " set to"
    )
