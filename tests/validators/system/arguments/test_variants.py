"""The findings of a system with arguments are those of all combinations; few are looked at."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping

import pytest
from hypothesis import HealthCheck, given, settings

from deros import codes
from deros.diagnostics import Code, Diagnostic, Span
from deros.interfaces.store import InterfaceStore
from deros.models.common import Scalar
from deros.models.system import System
from deros.rules.compiler.build_cache import BuildCache
from deros.systems.arguments.resolve import resolve
from deros.systems.flatten import flatten
from deros.validators.findings.context import CheckContext
from deros.validators.node.values import show
from deros.validators.system.arguments.variants import EVERYWHERE, is_there, places_of
from deros.validators.system.system import check
from tests.support.argument_systems import VALUES, load, systems

STORE = InterfaceStore()
CONTEXT = CheckContext(STORE, BuildCache(STORE), is_whole=True)

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
