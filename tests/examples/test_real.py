"""The systems in ``examples/real`` start what the launch files that they describe start.

The comparison runs where ``launch`` and ``nav2_bringup`` can be had: ``DEROS_REAL_PYTHON`` names a
Python that imports ``launch_ros`` and ``nav2_common``, and ``AMENT_PREFIX_PATH`` has the packages.
"""

from __future__ import annotations

import json
import os
import subprocess
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

from deros.names.graph_names import resolve_name
from tests.support.cli import deros
from tests.support.examples import EXAMPLES
from tests.support.real_systems import FOLDER
from tests.support.resolved_launch import command

REPOSITORY = Path(__file__).resolve().parents[2]
NAV2 = EXAMPLES / "real" / "nav2" / "nav2.system"
INTERFACES = ("--interfaces", FOLDER / "interfaces")
PYTHON = os.environ.get("DEROS_REAL_PYTHON", "")

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


@pytest.mark.skipif(not PYTHON, reason="DEROS_REAL_PYTHON names no Python that has launch_ros")
@pytest.mark.parametrize("target", TARGETS)
@pytest.mark.parametrize("arguments", SETS.values(), ids=SETS)
def test_nav2_starts_what_its_launch_file_starts(
    arguments: Mapping[str, str], target: str, tmp_path: Path
) -> None:
    """Programs, names, words, parameters and remappings are the same, but for what is listed."""
    original = _share("nav2_bringup") / "launch" / "bringup_launch.py"
    outcome = deros("generate", *INTERFACES, "--target", target, NAV2, "-o", tmp_path)
    assert outcome.code == 0, outcome.err
    ours = {name: value.lower() for name, value in arguments.items()}
    wanted = _resolved(original, arguments)
    found = _resolved(tmp_path / f"nav2.launch.{TARGETS[target]}", ours)
    differences = list(_differences(wanted, found))
    print(f"{len(wanted)} nodes, {len(differences)} differences")
    for each in differences:
        print(" ", each)
    assert len(wanted) >= 12
    assert differences == _intended(wanted)


def _share(package: str) -> Path:
    prefixes = os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep)
    return next(p for each in prefixes if (p := Path(each, "share", package)).is_dir())


def _resolved(path: Path, arguments: Mapping[str, str]) -> dict[str, dict[str, Any]]:
    words = command(PYTHON, path, arguments)
    run = subprocess.run(
        words, cwd=REPOSITORY, capture_output=True, text=True, timeout=60, check=False
    )
    assert run.returncode == 0, run.stderr
    nodes = json.loads(run.stdout.splitlines()[-1])
    return {each["name"]: each for each in nodes}


def _differences(
    wanted: Mapping[str, dict[str, Any]], found: Mapping[str, dict[str, Any]]
) -> list[str]:
    made = [f"{name}: not started" for name in sorted(wanted.keys() - found.keys())]
    made += [f"{name}: started, too" for name in sorted(found.keys() - wanted.keys())]
    for name in sorted(wanted.keys() & found.keys()):
        one, other = wanted[name], found[name]
        made += [
            f"{name}: {what} {one[what]} is {other[what]}"
            for what in ("program", "container", "words")
            if one[what] != other[what]
        ]
        for what in ("parameters", "remappings"):
            made += [
                f"{name}: {what[:-1]} {key} {one[what].get(key)!r} is {other[what].get(key)!r}"
                for key in sorted(one[what].keys() | other[what].keys())
                if not _is_same(one[what].get(key), other[what].get(key), name)
            ]
    return made


def _is_same(one: Any, other: Any, node: str) -> bool:
    """Return whether two values are, or name the same topic: nav2's file writes absolute names."""
    is_name = isinstance(one, str) and isinstance(other, str) and one.startswith("/")
    return one == other or (is_name and resolve_name(other, node.rpartition("/")[0]) == one)


def _intended(wanted: Mapping[str, dict[str, Any]]) -> list[str]:
    """Return the one difference that is meant: the container needs no parameter of its own."""
    values = wanted.get("/nav2_container", {}).get("parameters", {})
    return [
        f"/nav2_container: parameter autostart {values['autostart']!r} is None"
        for _ in range("autostart" in values)
    ]
