"""The systems in ``examples/real`` start what the launch files that they describe start.

The comparison runs where ``launch`` and the packages can be had: ``DEROS_REAL_PYTHON`` names a
Python that imports ``launch_ros`` and ``nav2_common``, ``AMENT_PREFIX_PATH`` has the packages, and
``PATH`` has ``xacro``.
"""

from __future__ import annotations

import json
import os
import subprocess
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest

from deros.names.graph_names import resolve_name
from tests.support.cli import deros
from tests.support.examples import EXAMPLES
from tests.support.real_systems import FOLDER
from tests.support.resolved_launch import command

REPOSITORY = Path(__file__).resolve().parents[2]
REAL = EXAMPLES / "real"
INTERFACES = ("--interfaces", FOLDER / "interfaces")
PYTHON = os.environ.get("DEROS_REAL_PYTHON", "")
UNCHECKED = frozenset({"DRS262", "DRS280"})
"""Remarks on files of packages that are not installed."""


@dataclass(frozen=True)
class Start:
    """One way to start a system.

    Attributes:
        arguments: as the original has them.
        environment: that both see.
        launch_file: the original, if there are several of which the system is one.
        which: the arguments of the system that choose this one.
    """

    arguments: Mapping[str, str] = field(default_factory=dict)
    environment: Mapping[str, str] = field(default_factory=dict)
    launch_file: str = ""
    which: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class Bringup:
    """A system, the launch file that it describes, and how both are started."""

    system: str
    package: str
    launch_file: str
    least: int  # of its processes and components
    starts: Mapping[str, Start]


NAV2 = Bringup(
    "nav2",
    "nav2_bringup",
    "bringup_launch.py",
    12,
    {
        "composed": Start(),
        "not composed": Start({"use_composition": "False"}),
        "a map, and simulated time": Start({"map": "/maps/depot.yaml", "use_sim_time": "true"}),
        "a map, not composed": Start({"map": "/maps/depot.yaml", "use_composition": "False"}),
        "slam": Start({"slam": "True", "log_level": "debug"}),
        "slam, not composed": Start(
            {"slam": "True", "use_composition": "False", "autostart": "false"}
        ),
        "no localization": Start({"use_localization": "False"}),
    },
)
TURTLEBOT3 = Bringup(
    "turtlebot3",
    "turtlebot3_bringup",
    "robot.launch.py",
    3,
    {
        "burger": Start({}, {"TURTLEBOT3_MODEL": "burger", "LDS_MODEL": "LDS-01"}),
        "waffle in a namespace": Start(
            {"namespace": "tb3"}, {"TURTLEBOT3_MODEL": "waffle", "LDS_MODEL": "LDS-02"}
        ),
        "waffle_pi, another port": Start(
            {"usb_port": "/dev/ttyACM1"}, {"TURTLEBOT3_MODEL": "waffle_pi", "LDS_MODEL": "LDS-03"}
        ),
        "an unknown lidar, and simulated time": Start(
            {"use_sim_time": "true"}, {"TURTLEBOT3_MODEL": "burger", "LDS_MODEL": "LDS-00"}
        ),
        "parameters of another robot, below two namespaces": Start(
            {
                "namespace": "hall/tb3",
                "tb3_param_dir": "{turtlebot3_bringup}/param/waffle.yaml",
            },
            {"TURTLEBOT3_MODEL": "burger", "LDS_MODEL": "LDS-03"},
        ),
    },
)
LITE: Mapping[str, Any] = {"launch_file": "lite.launch.py", "which": {"model": "lite"}}
NO_DIAGNOSTICS = {"TURTLEBOT4_DIAGNOSTICS": "0"}
TURTLEBOT4 = Bringup(
    "turtlebot4",
    "turtlebot4_bringup",
    "standard.launch.py",
    9,
    {
        "standard": Start(),
        "standard in a namespace": Start({}, {"ROBOT_NAMESPACE": "tb4"}),
        "standard without diagnostics": Start({}, NO_DIAGNOSTICS),
        "lite": Start(**LITE),
        "lite in two namespaces, without diagnostics": Start(
            {"joy_device": "/dev/input/js1"},
            {"ROBOT_NAMESPACE": "hall/tb4", **NO_DIAGNOSTICS},
            **LITE,
        ),
        "standard, other files": Start(
            {
                "param_file": "{turtlebot4_bringup}/config/turtlebot4_controller.config.yaml",
                "controller_config": "{turtlebot4_bringup}/config/turtlebot4.yaml",
            },
            {"ROBOT_NAMESPACE": "tb4"},
        ),
    },
)
BRINGUPS = (NAV2, TURTLEBOT3, TURTLEBOT4)
STARTS = {
    f"{bringup.system}: {name}": (bringup, start)
    for bringup in BRINGUPS
    for name, start in bringup.starts.items()
}


@pytest.mark.parametrize("bringup", BRINGUPS, ids=[each.system for each in BRINGUPS])
def test_it_checks_clean(bringup: Bringup) -> None:
    """Where its packages are not installed, remarks say that their files have not been read."""
    outcome = deros("check", *INTERFACES, _system(bringup))
    assert outcome.code == 0
    assert {line.split("[")[1][:6] for line in outcome.out.splitlines() if "[DRS" in line} <= (
        UNCHECKED
    )


@pytest.mark.skipif(not PYTHON, reason="DEROS_REAL_PYTHON names no Python that has launch_ros")
@pytest.mark.parametrize(("bringup", "start"), STARTS.values(), ids=STARTS)
def test_it_starts_what_the_launch_file_starts(
    bringup: Bringup, start: Start, tmp_path: Path
) -> None:
    """Programs, names, words, parameters and remappings are the same, but for what is listed."""
    original = _share(bringup.package) / "launch" / (start.launch_file or bringup.launch_file)
    outcome = deros("generate", *INTERFACES, "--target", "launch", _system(bringup), "-o", tmp_path)
    assert outcome.code == 0, outcome.err
    folders = {bringup.package: _share(bringup.package)}
    arguments = {name: value.format(**folders) for name, value in start.arguments.items()}
    ours = dict(start.which) | {
        name: value.lower() if value in ("True", "False") else value
        for name, value in arguments.items()
    }
    wanted = _resolved(original, arguments, start.environment)
    found = _resolved(tmp_path / f"{bringup.system}.launch.py", ours, start.environment)
    differences = list(_differences(wanted, found))
    print(
        f"{len(wanted)} nodes, {sum(len(each['parameters']) for each in wanted.values())}"
        f" parameters, {len(differences)} differences"
    )
    for each in differences:
        print(" ", each)
    assert len(wanted) >= bringup.least
    assert differences == _intended(wanted)


def _system(bringup: Bringup) -> Path:
    return REAL / bringup.system / f"{bringup.system}.system"


def _share(package: str) -> Path:
    prefixes = os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep)
    return next(p for each in prefixes if (p := Path(each, "share", package)).is_dir())


def _resolved(
    path: Path, arguments: Mapping[str, str], environment: Mapping[str, str]
) -> dict[str, dict[str, Any]]:
    words = command(PYTHON, path, arguments)
    run = subprocess.run(
        words,
        cwd=REPOSITORY,
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
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
            for what in ("program", "container", "words", "inside", "delay", "respawns", "ends_all")
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
    """Return whether two values are, or say the same.

    The file of nav2 writes absolute names of topics. Where a launch file leaves the type of a text
    open, launch_ros reads it as YAML, which joins the lines of a description.
    """
    if not isinstance(one, str) or not isinstance(other, str):
        return bool(one == other)
    if one.startswith("<?xml"):
        return one.split() == other.split()
    is_name = one.startswith("/")
    return one == other or (is_name and resolve_name(other, node.rpartition("/")[0]) == one)


def _intended(wanted: Mapping[str, dict[str, Any]]) -> list[str]:
    """Return the differences that are meant, each with its reason.

    * The container of nav2 needs no parameter of its own.
    * A container, and what is loaded into it, is started with the system: that of the camera of a
      TurtleBot 4 comes 30 seconds later in the original.
    """
    values = wanted.get("/nav2_container", {}).get("parameters", {})
    containers = {each["container"] for each in wanted.values() if each["container"]}
    return [
        f"/nav2_container: parameter autostart {values['autostart']!r} is None"
        for _ in range("autostart" in values)
    ] + [
        f"{name}: delay {each['delay']} is 0.0"
        for name, each in sorted(wanted.items())
        if each["delay"] and (each["container"] or name in containers)
    ]
