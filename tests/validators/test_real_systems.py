"""Fourteen public systems: what is found in them, and which planted faults are.

``tests/data/systems/README.md`` says where they come from. ``findings.json`` beside it lists what
is found in them, each with the verdict of a maintainer: would it be fixed, and why not?
"""

from __future__ import annotations

import json
import os
from collections import Counter
from pathlib import Path
from typing import Any

import pytest

from deros.diagnostics import Diagnostic
from tests.support import planted, real_systems

SYSTEMS = real_systems.names()
LISTED: list[dict[str, Any]] = json.loads(
    (real_systems.FOLDER / "findings.json").read_text(encoding="utf-8")
)

EVERY = 1 if os.environ.get("DEROS_ALL_FAULTS") else 4
"""Of the faults of each kind in each system, every one of so many is planted."""


def _listed(finding: Diagnostic) -> dict[str, str]:
    return {
        "file": str(Path(finding.span.file).resolve().relative_to(real_systems.FOLDER)),
        "code": finding.code.name,
        "message": finding.message,
    }


def test_there_are_fourteen() -> None:
    """Of three to fifteen nodes each."""
    sizes = {name: len(real_systems.flat_system(name).nodes) for name in SYSTEMS}
    print(sizes)
    assert len(sizes) == 14
    robots = {"linorobot_pair": 2}
    assert all(3 <= size / robots.get(name, 1) <= 15 for name, size in sizes.items())


@pytest.mark.parametrize("name", SYSTEMS)
def test_findings_are_those_listed(name: str) -> None:
    """None comes, and none goes."""
    found = [_listed(each) for each in real_systems.findings(name)]
    listed = [{key: each[key] for key in found_keys(each)} for each in LISTED if _is_of(each, name)]
    assert sorted(found, key=str) == sorted(listed, key=str)


def found_keys(entry: dict[str, Any]) -> list[str]:
    """Return the keys of an entry that the finding itself has."""
    return [key for key in entry if key in ("file", "code", "message")]


def _is_of(entry: dict[str, Any], name: str) -> bool:
    return str(entry["file"]).startswith(f"{name}/")


def test_a_maintainer_would_leave_fewer_than_three_in_each_system() -> None:
    """Each that would be left has a reason; there is no error among them."""
    left = Counter(str(each["file"]).split("/")[0] for each in LISTED if not each["fixed"])
    for name in SYSTEMS:
        print(f"{name}: {left[name]}")
    assert max(left.values()) < 3
    assert all(len(each["reason"]) > 20 for each in LISTED)
    assert not any(f.is_error for name in SYSTEMS for f in real_systems.findings(name))


@pytest.mark.parametrize("name", SYSTEMS)
def test_planted_faults_are_found(name: str) -> None:
    """Each ends in a finding that names its place; ``DEROS_ALL_FAULTS=1`` plants all of them."""
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
