"""The systems in ``examples/real`` start what the launch files that they describe start.

The comparison runs where ``launch`` and ``nav2_bringup`` can be had (`compared_launch`).
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

from tests.support.cli import deros
from tests.support.compared_launch import differences, needs_launch, resolved, share
from tests.support.examples import EXAMPLES
from tests.support.real_systems import FOLDER

NAV2 = EXAMPLES / "real" / "nav2" / "nav2.system"
INTERFACES = ("--interfaces", FOLDER / "interfaces")

TARGETS: Mapping[str, str] = {"launch": "py", "launch-xml": "xml", "launch-yaml": "yaml"}
SETS: Mapping[str, Mapping[str, str]] = {
    "composed": {},
    "not composed": {"use_composition": "False"},
    "a map, and simulated time": {"map": "/maps/depot.yaml", "use_sim_time": "true"},
    "a map, not composed": {"map": "/maps/depot.yaml", "use_composition": "False"},
    "slam": {"slam": "True", "log_level": "debug"},
    "slam, not composed": {"slam": "True", "use_composition": "False", "autostart": "false"},
    "no localization": {"use_localization": "False"},
}


def test_nav2_checks_clean() -> None:
    """Where nav2 is not installed, remarks say that its files have not been read."""
    outcome = deros("check", *INTERFACES, NAV2)
    assert outcome.code == 0
    assert {line.split("[")[1][:6] for line in outcome.out.splitlines() if "[DRS" in line} <= {
        "DRS262",
        "DRS280",
    }


@needs_launch
@pytest.mark.parametrize("target", TARGETS)
@pytest.mark.parametrize("arguments", SETS.values(), ids=SETS)
def test_nav2_starts_what_its_launch_file_starts(
    arguments: Mapping[str, str], target: str, tmp_path: Path
) -> None:
    """Programs, names, words, parameters and remappings are the same, but for what is listed."""
    original = share("nav2_bringup") / "launch" / "bringup_launch.py"
    outcome = deros("generate", *INTERFACES, "--target", target, NAV2, "-o", tmp_path)
    assert outcome.code == 0, outcome.err
    ours = {name: value.lower() for name, value in arguments.items()}
    wanted = resolved(original, arguments)
    found = resolved(tmp_path / f"nav2.launch.{TARGETS[target]}", ours)
    different = differences(wanted, found)
    print(f"{len(wanted)} nodes, {len(different)} differences")
    for each in different:
        print(" ", each)
    assert len(wanted) >= 12
    assert different == _intended(wanted)


def _intended(wanted: Mapping[str, dict[str, Any]]) -> list[str]:
    """Return the one difference that is meant: the container needs no parameter of its own."""
    values = wanted.get("/nav2_container", {}).get("parameters", {})
    return [
        f"/nav2_container: parameter autostart {values['autostart']!r} is None"
        for _ in range("autostart" in values)
    ]
