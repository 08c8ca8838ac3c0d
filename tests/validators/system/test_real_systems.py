"""Fourteen public systems: their findings, and which planted faults are found.

``tests/data/systems/README.md`` lists the sources. ``findings.md`` next to it lists all findings,
each with the verdict of a maintainer: would it be fixed, and if not, why?
"""

from __future__ import annotations

import os
from collections import Counter
from pathlib import Path

import pytest

from deros.diagnostics import Diagnostic
from tests.support import planted, real_systems
from tests.support.profiles import thinned
from tests.support.tables import rows

SYSTEMS = real_systems.names()
LISTED = list(rows("systems/findings"))

EVERY = 1 if os.environ.get("DEROS_ALL_FAULTS") else thinned(4)
"""One of so many faults of each kind is planted in each system."""


def _listed(finding: Diagnostic) -> dict[str, str]:
    return {
        "file": str(Path(finding.span.file).resolve().relative_to(real_systems.FOLDER)),
        "code": finding.code.name,
        "message": finding.message,
    }


def test_there_are_fourteen_systems_of_three_to_fifteen_nodes() -> None:
    """The collection keeps its size; a system of two robots counts per robot."""
    sizes = {name: len(real_systems.flat_system(name).nodes) for name in SYSTEMS}
    print(sizes)
    assert len(sizes) == 14
    robots = {"linorobot_pair": 2}
    assert all(3 <= size / robots.get(name, 1) <= 15 for name, size in sizes.items())


@pytest.mark.parametrize("name", SYSTEMS)
def test_findings_match_the_reviewed_list(name: str) -> None:
    """No finding is new, and none is missing."""
    found = [_listed(finding) for finding in real_systems.findings(name)]
    listed = [
        {key: each[key] for key in ("file", "code", "message")}
        for each in LISTED
        if each["file"].startswith(f"{name}/")
    ]
    assert sorted(found, key=str) == sorted(listed, key=str)


def test_each_system_has_fewer_than_three_unfixed_findings() -> None:
    """Each finding that would stay unfixed has a reason, and none is an error."""
    left = Counter(each["file"].split("/")[0] for each in LISTED if each["fixed"] == "no")
    for name in SYSTEMS:
        print(f"{name}: {left[name]}")
    assert max(left.values()) < 3
    assert all(len(each["reason"]) > 20 for each in LISTED)
    assert not any(f.is_error for name in SYSTEMS for f in real_systems.findings(name))


@pytest.mark.parametrize("name", SYSTEMS)
def test_planted_faults_are_found(name: str) -> None:
    """Each fault gives a finding at its place; ``DEROS_ALL_FAULTS=1`` plants all of them."""
    before = planted.known_findings(name)
    by_kind: dict[str, list[planted.Fault]] = {kind: [] for kind in planted.KINDS}
    for fault in planted.faults(name):
        by_kind[fault.kind].append(fault)
    missed = []
    for kind, every in by_kind.items():
        drawn = every[::EVERY]
        lost = [fault for fault in drawn if planted.is_found(fault, before) is None]
        print(f"{name}, {kind}: {len(drawn) - len(lost)} of {len(drawn)} found ({len(every)})")
        missed += lost
    assert missed == []
