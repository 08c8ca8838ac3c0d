"""The systems in ``examples/real`` start what the launch files that they describe start.

The comparison runs where ``launch`` and the packages can be had: ``DEROS_REAL_PYTHON`` names a
Python that imports ``launch_ros`` and ``nav2_common``, ``AMENT_PREFIX_PATH`` has the packages, and
``PATH`` has ``xacro``.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

from tests.support.cli import deros
from tests.support.compared_launch import differences, needs_launch, resolved, share
from tests.support.examples import EXAMPLES
from tests.support.real_systems import FOLDER

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
TARGETS: Mapping[str, str] = {"launch": "py", "launch-xml": "xml", "launch-yaml": "yaml"}
STARTS = {
    f"{bringup.system}: {name}, {target}": (bringup, start, target)
    for bringup in BRINGUPS
    for name, start in bringup.starts.items()
    # Those of the others have several nodes in a process, or an order: only Python says that.
    for target in (TARGETS if bringup is NAV2 else ["launch"])
}
COMPOSING = {
    f"{bringup.system}: {name}": (bringup, start)
    for bringup in (NAV2, TURTLEBOT4)
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


@needs_launch
@pytest.mark.parametrize(("bringup", "start", "target"), STARTS.values(), ids=STARTS)
def test_it_starts_what_the_launch_file_starts(
    bringup: Bringup, start: Start, target: str, tmp_path: Path
) -> None:
    """Programs, names, words, parameters and remappings are the same, but for what is listed."""
    original = share(bringup.package) / "launch" / (start.launch_file or bringup.launch_file)
    outcome = deros("generate", *INTERFACES, "--target", target, _system(bringup), "-o", tmp_path)
    assert outcome.code == 0, outcome.err
    folders = {bringup.package: share(bringup.package)}
    arguments = {name: value.format(**folders) for name, value in start.arguments.items()}
    ours = dict(start.which) | {
        name: value.lower() if value in ("True", "False") else value
        for name, value in arguments.items()
    }
    wanted = resolved(original, arguments, start.environment)
    found = resolved(
        tmp_path / f"{bringup.system}.launch.{TARGETS[target]}", ours, start.environment
    )
    different = differences(wanted, found)
    print(
        f"{len(wanted)} nodes, {sum(len(each['parameters']) for each in wanted.values())}"
        f" parameters, {len(different)} differences"
    )
    for each in different:
        print(" ", each)
    assert len(wanted) >= bringup.least
    assert different == _intended(wanted)


@needs_launch
@pytest.mark.parametrize(("bringup", "start"), COMPOSING.values(), ids=COMPOSING)
def test_script_loads_what_the_launch_file_loads(
    bringup: Bringup, start: Start, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Components, containers and all values: those of the file are read at the start, as here."""
    pytest.importorskip("rclpy")
    original = share(bringup.package) / "launch" / (start.launch_file or bringup.launch_file)
    folders = {bringup.package: share(bringup.package)}
    arguments = {name: value.format(**folders) for name, value in start.arguments.items()}
    everything = resolved(original, arguments, start.environment)
    wanted = {name: each for name, each in everything.items() if each["container"]}
    for name, value in start.environment.items():
        monkeypatch.setenv(name, value)
    truths = {"True": "true", "False": "false"}
    given = dict(start.which) | {name: truths.get(v, v) for name, v in arguments.items()}
    words = [f"{name}:={v}" for name, v in given.items()]
    if bringup is TURTLEBOT4 and "ROBOT_NAMESPACE" in start.environment:
        # The key is /oakd. launch_ros drops the slash, the parser of ROS 2 refuses it.
        with pytest.raises(ValueError, match=r"oakd_\w+\.yaml: .* repeated forward slash"):
            _loaded_by_script(bringup, words, tmp_path)
        return
    rows = _loaded_by_script(bringup, words, tmp_path)
    assert (
        differences(wanted, {name: wanted.get(name, {}) | row for name, row in rows.items()}) == []
    )
    assert bool(wanted) == (start.arguments.get("use_composition") != "False")


def _loaded_by_script(
    bringup: Bringup, words: list[str], folder: Path
) -> dict[str, dict[str, Any]]:
    """Return what the script of a system has loaded into containers, by full names."""
    system = _system(bringup)
    outcome = deros("generate", *INTERFACES, "--target", "script", system, "-o", folder)
    assert outcome.code == 0, outcome.err
    script = folder / f"{bringup.system}.py"
    module = ModuleType("real_script")
    module.__file__ = str(script)
    sys.modules[module.__name__] = module  # where its dataclasses look for their types
    try:
        exec(compile(script.read_text(), script, "exec"), vars(module))
    finally:
        del sys.modules[module.__name__]
    at_start = module.Start(str(script), words)
    rows = module.nodes(module.given(module.ARGUMENTS, words, (at_start,)), at_start)
    programs = module.programs_of([], os.environ)

    def locate(file: str) -> str:
        return str(module._located(file, programs))

    nodes = [row.located(locate) for row in rows if isinstance(row, module.Node) and row.container]
    made = getattr(module, "MADE", None) or module.Preparation()
    made.sources([file for node in nodes for file in node.files], locate)
    made.make(dict(os.environ))
    with made.in_place():
        return {
            node.full_name: {
                "container": node.container,
                "program": f"{node.package}/{node.plugin}",
                "parameters": {
                    **module.values_of(node.files, node.full_name),
                    **node.parameters,
                },
            }
            for node in nodes
        }


def _system(bringup: Bringup) -> Path:
    return REAL / bringup.system / f"{bringup.system}.system"


def _intended(wanted: Mapping[str, dict[str, Any]]) -> list[str]:
    """Return what is meant to differ: the container of nav2 needs no parameter of its own."""
    values = wanted.get("/nav2_container", {}).get("parameters", {})
    return [
        f"/nav2_container: parameter autostart {values['autostart']!r} is None"
        for _ in range("autostart" in values)
    ]
