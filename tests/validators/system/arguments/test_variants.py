"""The findings of a system with arguments are those of all combinations; few are looked at."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Mapping
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from deros import codes
from deros.diagnostics import Code, Diagnostic, Span
from deros.interfaces.store import InterfaceStore
from deros.models.common import Scalar
from deros.models.system import System
from deros.rules.compiler.build_cache import BuildCache
from deros.systems.arguments import diagrams
from deros.systems.arguments.resolve import resolve
from deros.systems.arguments.variants import Variants
from deros.systems.flatten import flatten
from deros.validators.findings.context import CheckContext
from deros.validators.node.values import show
from deros.validators.system.arguments.variants import EVERYWHERE, is_there, places_of
from deros.validators.system.system import check
from tests.support.argument_systems import VALUES, load, systems, waiting_systems

STORE = InterfaceStore()
CONTEXT = CheckContext(STORE, BuildCache(STORE), is_whole=True)

# The oracle ---------------------------------------------------------------------------------------

Key = tuple[Code, Span]
Values = Mapping[str, tuple[Scalar, ...]]


def assignments(all_values: Values) -> list[dict[str, Scalar]]:
    """Return all combinations, those with few differences from the defaults first."""
    products = itertools.product(*all_values.values())
    found = [dict(zip(all_values, each, strict=True)) for each in products]
    return sorted(found, key=lambda each: differences(each, all_values))


def differences(assignment: Mapping[str, Scalar], all_values: Values) -> int:
    """Return how many arguments differ from their defaults."""
    return sum(assignment[name] != values[0] for name, values in all_values.items())


def all_findings(system: System, all_values: Values) -> dict[Key, list[dict[str, Scalar]]]:
    """Return the findings of each combination by itself, with the combinations that have it.

    Those that a combination must not lack where it has their part are left out if one does.
    """
    found: dict[Key, list[dict[str, Scalar]]] = {}
    keys: list[set[Key]] = []
    places: dict[int, set[Span]] = {}
    for number, assignment in enumerate(assignments(all_values)):
        plain = resolve(system, assignment)
        places[number] = places_of(flatten(plain))
        keys.append({(each.code, each.span) for each in check(plain, CONTEXT)})
        for key in keys[-1]:
            found.setdefault(key, []).append(assignment)
    return {
        key: where
        for key, where in found.items()
        if key[0] not in EVERYWHERE
        or all(
            key in each or not is_there(key[1], places[number], places)
            for number, each in enumerate(keys)
        )
    }


ABOUT_ARGUMENTS = {
    codes.UNUSED_ARGUMENT,
    codes.IDLE_CONDITION,
    codes.UNFIT_ARGUMENT,
    codes.UNCHECKED_COMBINATIONS,
}


def told(finding: Diagnostic) -> dict[str, str]:
    """Return the values of arguments that a finding names."""
    _, _, where = finding.message.rpartition(", where ")
    pairs = [pair.partition(" = ") for pair in where.split(" and ")] if where else []
    return {name: value for name, _, value in pairs}


def assert_complete(
    system: System, all_values: Values, text: str, findings: Iterable[Diagnostic] | None = None
) -> None:
    """Assert that a system has the findings of all combinations, each with a smallest one."""
    found = {
        (each.code, each.span): each
        for each in (check(system, CONTEXT) if findings is None else findings)
        if each.code not in ABOUT_ARGUMENTS
    }
    kept = {
        key: where
        for key, where in all_findings(system, all_values).items()
        if key[0] not in ABOUT_ARGUMENTS
    }
    assert found.keys() == kept.keys(), text
    for key, finding in found.items():
        smallest = kept[key][0]
        if differences(smallest, all_values) and key[0] not in EVERYWHERE:
            named = {n: show(v) for n, v in smallest.items() if v != all_values[n][0]}
            assert len(told(finding)) == len(named), (finding.message, named)
            shown = [{n: show(v) for n, v in each.items()} for each in kept[key]]
            assert any(told(finding).items() <= each.items() for each in shown), finding.message


@settings(
    max_examples=30, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(text=systems())
def test_findings_are_those_of_all_combinations(
    tmp_path_factory: pytest.TempPathFactory, text: str
) -> None:
    """None is missed, none is invented, and each names an assignment that no smaller one shows."""
    system = load(tmp_path_factory.mktemp("variants"), text)
    assert_complete(system, VALUES, text)


@settings(
    max_examples=30, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(text=waiting_systems())
def test_findings_about_waits_are_those_of_all_combinations(
    tmp_path_factory: pytest.TempPathFactory, text: str
) -> None:
    """What is waited for may be there, managed, active or provided in some of them alone."""
    system = load(tmp_path_factory.mktemp("variants"), text)
    assert_complete(system, VALUES, text)


@settings(
    max_examples=10, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(text=systems(), steps=st.integers(0, 200))
@pytest.mark.essential
def test_findings_without_sets_are_those_of_the_smallest(
    tmp_path_factory: pytest.TempPathFactory, text: str, steps: int
) -> None:
    """Where sets would be too much work, all of the few combinations are looked at."""
    system = load(tmp_path_factory.mktemp("variants"), text)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(diagrams, "MOST_STEPS", steps)
        variants = Variants(system)
        if variants.gap is not None:
            assert variants.numbers == list(range(variants.space.count))
        findings = list(check(system, CONTEXT))
    told_so = [each for each in findings if each.code is codes.UNCHECKED_COMBINATIONS]
    assert len(told_so) == (variants.gap is not None)
    assert_complete(system, VALUES, text, findings)


@pytest.mark.slow
def test_findings_of_a_dozen_arguments(tmp_path: Path) -> None:
    """They are those of all 4,096 combinations."""
    names = [f"a{number}" for number in range(12)]
    text = "system S " + "".join(f"argument {name} : bool = false " for name in names)
    text += 'imports import "*.rnd" topics topic /x topic /y when a0 or a11 '
    for one, other, another in zip(names, names[1:], names[2:], strict=False):
        text += f"node s_{one} : source when {one} and not {another} wirings "
        text += f"connect out to /x when {other} connect out to /y when not {other} "
    text += "node sink : sink when a5 or a6 wirings connect in to /x"
    system = load(tmp_path, text)
    assert_complete(system, dict.fromkeys(names, (False, True)), text)


@pytest.mark.parametrize(
    ("body", "code"),
    [
        (
            'env ROS_DOMAIN_ID = "2" node one : sink when a'
            ' node two : source env ROS_DOMAIN_ID = "3" when b',
            codes.NODES_APART,
        ),
        (
            'node one : sink when a node two : source env RMW_IMPLEMENTATION = "x" when b',
            codes.NODES_APART,
        ),
        (
            'node one : sink when a env RMW_IMPLEMENTATION = "rmw_${b}"'
            ' node two : source env RMW_IMPLEMENTATION = "rmw_false"',
            codes.NODES_APART,
        ),
        ('process one : "x" when a process one : "y" when b', codes.DUPLICATE_PROCESS),
        ('node one : sink when a process one : "y" when b', codes.DUPLICATE_PROCESS),
        ("parameters param none = 1 when a and b node one : sink when a", codes.NO_NODE_BELOW),
        ("parameters param rate = 9 when b node one : sink when a", codes.PARAMETER_OUT_OF_RANGE),
        ("remappings remap in to /far when a node one : sink when b", codes.UNKNOWN_TOPIC),
    ],
)
def test_what_two_conditions_bring_together_is_found(tmp_path: Path, body: str, code: Code) -> None:
    """Neither is there by default, and neither alone shows it."""
    text = 'system S argument a : bool = false argument b : bool = false imports import "*.rnd"\n'
    system = load(tmp_path, text + body)
    assert_complete(system, {"a": (False, True), "b": (False, True)}, body)
    found = [each for each in check(system, CONTEXT) if each.code is code]
    assert found
    for each in found:
        said = " and ".join(f"{name} = {str(value).lower()}" for name, value in each.where)
        assert each.message.partition(", where ")[2] == said


def test_many_parts_at_one_topic(tmp_path: Path) -> None:
    """With more combinations than are looked at, each pair is, and each part without the others."""
    kinds = ("sink", "source", "late", "sink", "other", "source", "managed", "sink")
    text = "system S\n" + "".join(f"argument a{n} : bool = false\n" for n in range(len(kinds)))
    text += 'imports import "*.rnd"\ntopics topic /x\n'
    for number, kind in enumerate(kinds):
        port = "in" if kind == "sink" else "out"
        text += f"node n{number} : {kind} when a{number} wirings connect {port} to /x\n"
    system = load(tmp_path, text)
    all_values = {f"a{number}": (False, True) for number in range(len(kinds))}
    assert len(Variants(system).numbers) < 64
    assert_complete(system, all_values, text)


_DESCRIBING = """\
<launch>
  <arg name="mode"><choice value="fast"/><choice value="slow"/></arg>
</launch>
"""
_PLAIN = '<launch>\n  <arg name="mode" default="slow"/>\n</launch>\n'
_SPEEDS = ("slow", "fast", "still")
_RATE = "/**:\n  ros__parameters:\n    rate: $(var tens)$(var ones)\n"


def test_each_value_for_a_launch_file_is_looked_at_with_each_file(tmp_path: Path) -> None:
    """Neither file nor value alone shows what is wrong, and not all values are multiplied."""
    (tmp_path / "a.launch.xml").write_text(_DESCRIBING)
    (tmp_path / "b.launch.xml").write_text(_PLAIN)
    others = [f"x{number}" for number in range(4)]
    declared = "".join(
        f'argument {each} : string = "0" one_of ["0", "1", "2"]\n' for each in others
    )
    text = (
        'system S\nargument file : string = "b" one_of ["b", "a"]\n'
        'argument mode : string = "slow" one_of ["slow", "fast", "still"]\n' + declared
    )
    passed = ", ".join(f"{each} = ${each}" for each in others)
    words = ", ".join(f"${each}" for each in others)
    text += f'process tool : "tool" arguments [{words}]\n'
    text += f'launch "${{file}}.launch.xml" (mode = $mode, {passed}) as far\n'
    system = load(tmp_path, text)
    values: Values = {"file": ("b", "a"), "mode": _SPEEDS, **dict.fromkeys(others, ("0", "1", "2"))}
    assert_complete(system, values, text)
    found = [each for each in check(system, CONTEXT) if ("mode", "still") in each.where]
    assert [each.where for each in found] == [(("file", "a"), ("mode", "still"))]
    assert len(Variants(system).numbers) < 30


def test_values_for_a_parameter_file_are_multiplied_where_it_uses_them(tmp_path: Path) -> None:
    """Two that make one parameter wrong together are found; the file does not use the others."""
    (tmp_path / "a.yaml").write_text(_RATE)
    others = [f"x{number}" for number in range(4)]
    declared = "".join(
        f'argument {each} : string = "0" one_of ["0", "1", "2"]\n' for each in others
    )
    text = (
        'system S\nargument tens : string = "0" one_of ["0", "1"]\n'
        'argument ones : string = ".5" one_of [".5", "9.5"]\n' + declared
    )
    passed = ", ".join(f"{each} = ${each}" for each in others)
    text += (
        'imports import "*.rnd"\nnode far : sink wirings connect in to /x\n'
        f'parameters from "a.yaml" (tens = $tens, ones = $ones, {passed})\n'
        "topics external topic /x\n"
    )
    system = load(tmp_path, text)
    values: Values = {
        "tens": ("0", "1"),
        "ones": (".5", "9.5"),
        **dict.fromkeys(others, ("0", "1", "2")),
    }
    assert_complete(system, values, text)
    found = [each for each in check(system, CONTEXT) if each.code is codes.PARAMETER_OUT_OF_RANGE]
    assert found
    assert len(Variants(system).numbers) < 20
