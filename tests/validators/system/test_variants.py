"""A system with arguments has the findings of all their combinations, of which few are looked at."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from deros import codes
from deros.diagnostics import Code, Diagnostic, Span
from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from deros.models.common import Scalar
from deros.models.system import System
from deros.rules.compiler.build_cache import BuildCache
from deros.systems.flatten import flatten
from deros.systems.resolve import resolve
from deros.validators.findings.context import CheckContext
from deros.validators.node.values import show
from deros.validators.system.system import check
from deros.validators.system.variants import EVERYWHERE, is_there, places_of

STORE = InterfaceStore()
CONTEXT = CheckContext(STORE, BuildCache(STORE), is_whole=True)

TYPES = {
    "source": 'node source : p parameters name frame : string = "map" name sim : bool = false'
    " publishes topic out : std_msgs.Int32",
    "other": "node other : p publishes topic out : std_msgs.Bool",
    "sink": "node sink : p parameters name rate : double = 1.0 in [0, 5]"
    " subscribes topic in : std_msgs.Int32",
    "late": "node late : p publishes topic out : std_msgs.Int32 qos best_effort"
    " subscribes topic in : std_msgs.Int32 qos reliable",
    "managed": "node managed : p lifecycle publishes topic out : std_msgs.Int32",
}
"""Node types whose ends disagree with each other in type, QoS and life."""

VALUES: Mapping[str, tuple[Scalar, ...]] = {
    "a": (False, True),
    "b": (True, False),
    "c": (False, True),
    "mode": ("auto", "hand", "off"),
    "n": (1, 2, 3),
}
"""All values that the arguments may have, the default first."""

DECLARATIONS = """
argument a : bool = false
argument b : bool = true
argument c : bool
argument mode : string = "auto" one_of ["auto", "hand", "off"]
argument n : int = 1 in [1, 3]
"""


def load(folder: Path, text: str) -> System:
    """Load a system whose imports are :data:`TYPES`."""
    for name, description in TYPES.items():
        (folder / f"{name}.rnd").write_text(description)
    (folder / "s.system").write_text(text)
    loaded = Repository().load(folder / "s.system")
    assert isinstance(loaded.model, System)
    assert loaded.diagnostics == (), text
    return loaded.model


# Systems at random --------------------------------------------------------------------------------

atoms = st.sampled_from(
    ["a", "b", "c", "not a", 'mode = "off"', 'mode in ["auto", "hand"]', "n > 1", "n = 3", "a = b"]
)
conditions = st.one_of(
    atoms,
    st.tuples(atoms, st.sampled_from(["and", "or"]), atoms).map(" ".join),
    atoms.map(lambda atom: f"not ({atom})"),
)
optional_conditions = st.one_of(st.just(""), conditions.map(lambda found: f" when {found}"))
topics = st.sampled_from(["/x", "/y", "/z", '"/${mode}/x"'])


@st.composite
def nodes(draw: st.DrawFn) -> str:
    """Return a node of some type, some parts of which have conditions."""
    kind = draw(st.sampled_from(list(TYPES)))
    name = draw(st.sampled_from(["one", "two", "three"]))
    text = f"node {name} : {kind}{draw(optional_conditions)}"
    if kind == "sink":
        value = draw(st.sampled_from(["2", "$n * 2", "9"]))
        text += f" parameters param rate = {value}{draw(optional_conditions)}"
    port = "in" if kind == "sink" else "out"
    wirings = draw(st.lists(st.tuples(topics, optional_conditions), max_size=2))
    if wirings:
        text += " wirings"
        for topic, condition in wirings:
            text += f" connect {port} to {topic}{condition}"
    return text


@st.composite
def systems(draw: st.DrawFn) -> str:
    """Return a system of nodes in subsystems, with conditions here and there."""
    parts = draw(st.lists(nodes(), min_size=1, max_size=5))
    text = f'system S {DECLARATIONS} imports import "*.rnd"\ntopics\n'
    for topic in ("/x", "/y", '"/${mode}/x"'):
        text += f"topic {topic}{draw(optional_conditions)}\n"
    for number, part in enumerate(parts):
        if draw(st.booleans()):
            space = draw(st.sampled_from(["", " namespace /inner", " namespace $mode"]))
            text += f"subsystem part{number}{space}{draw(optional_conditions)} {{ {part} }}\n"
        else:
            text += f"{part}\n"
    return text


# The oracle ---------------------------------------------------------------------------------------

Key = tuple[Code, Span]


def assignments() -> Iterator[dict[str, Scalar]]:
    """Yield all combinations, those with few differences from the defaults first."""
    found = [dict(zip(VALUES, each, strict=True)) for each in itertools.product(*VALUES.values())]
    return iter(sorted(found, key=differences))


def differences(assignment: Mapping[str, Scalar]) -> int:
    """Return how many arguments differ from their defaults."""
    return sum(assignment[name] != values[0] for name, values in VALUES.items())


def all_findings(system: System) -> dict[Key, list[dict[str, Scalar]]]:
    """Return the findings of each combination by itself, with the combinations that have it.

    Those that a combination must not lack where it has their part are left out if one does.
    """
    found: dict[Key, list[dict[str, Scalar]]] = {}
    keys: list[set[Key]] = []
    places: dict[int, set[Span]] = {}
    for number, assignment in enumerate(assignments()):
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


ABOUT_ARGUMENTS = {codes.UNUSED_ARGUMENT, codes.IDLE_CONDITION, codes.UNFIT_ARGUMENT}


def told(finding: Diagnostic) -> dict[str, str]:
    """Return the values of arguments that a finding names."""
    _, _, where = finding.message.rpartition(", where ")
    pairs = [pair.partition(" = ") for pair in where.split(" and ")] if where else []
    return {name: value for name, _, value in pairs}


@settings(
    max_examples=30, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(text=systems())
def test_findings_are_those_of_all_combinations(
    tmp_path_factory: pytest.TempPathFactory, text: str
) -> None:
    """None is missed, none is invented, and each names an assignment that no smaller one shows."""
    system = load(tmp_path_factory.mktemp("variants"), text)
    found = {
        (each.code, each.span): each
        for each in check(system, CONTEXT)
        if each.code not in ABOUT_ARGUMENTS
    }
    kept = {
        key: where for key, where in all_findings(system).items() if key[0] not in ABOUT_ARGUMENTS
    }
    assert found.keys() == kept.keys(), text
    for key, finding in found.items():
        smallest = kept[key][0]
        if differences(smallest) and key[0] not in EVERYWHERE:
            named = {n: show(v) for n, v in smallest.items() if v != VALUES[n][0]}
            assert len(told(finding)) == len(named), (finding.message, named)
            shown = [{n: show(v) for n, v in each.items()} for each in kept[key]]
            assert any(told(finding).items() <= each.items() for each in shown), finding.message
