"""The safety nodes whose reaction is measured, made from rules by ``deros generate``."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from support.processes import run

DURATIONS = (0.4, 2.0, 4.0)
"""The seconds of the ``for`` in the rules: those of the paper's experiments."""

_LANES = {0.4: 2, 2.0: 6, 4.0: 11}
"""How many rules share the measurements of each duration, so that all take equally long."""

_DRIVER = """\
node driver : reaction_driver "Tilts, and sees who reacts"
publishes
{imus}
subscribes
{states}
"""

_SYSTEM = """\
system Reaction
imports
  import "driver.rnd"
topics
{topics}
node driver : driver
"""

_ACTION = """\
action stop_{name} publishes true on {state} : std_msgs.Bool reset_by level_{name};
action level_{name};
input orientation_{name} = topic {imu}.orientation
entity body_{name} {{
  tilted: orientation_{name}.roll() not in [-10 deg, 10 deg]{duration};
  level: orientation_{name}.roll() in [-10 deg, 10 deg];
}}
behaviour stopping_{name}: if body_{name}.tilted then {{ stop_{name}; }};
behaviour levelling_{name}: if body_{name}.level then {{ level_{name}; }};

"""


_CPP_ACTIONS = """\
#ifndef {own}_HPP_
#define {own}_HPP_
#include "{name}_safety_cpp/{name}_safety_node_actions_base.hpp"
namespace {name}_safety_cpp
{{
class {own} : public {own}Base
{{
public:
  using {own}Base::{own}Base;
{methods}}};
}}  // namespace {name}_safety_cpp
#endif  // {own}_HPP_
"""


@dataclass(frozen=True, slots=True)
class Lane:
    """A pair of topics: a tilt on the one makes a state on the other, after so many seconds."""

    name: str
    group: str
    seconds: float

    @property
    def imu(self) -> str:
        """The topic with the tilt."""
        return f"/{self.group}/{self.name}/imu"

    @property
    def state(self) -> str:
        """The topic with the reaction."""
        return f"/{self.group}/{self.name}/state"


def timed_lanes(group: str) -> tuple[Lane, ...]:
    """Return the lanes for the rules with a ``for``."""
    return tuple(
        Lane(f"after_{round(1000 * seconds)}_ms_{number}", group, seconds)
        for seconds in DURATIONS
        for number in range(_LANES[seconds])
    )


def generate(name: str, lanes: Sequence[Lane], folder: Path, target: str = "python") -> Path:
    """Generate a safety node with one rule per lane; return the folder of its package.

    The package is ``<name>_safety``, its node and module ``<name>_safety_node``; with the target
    ``cpp`` both end in ``_cpp``. Files that are there already are only written if they change.

    Raises:
        ProcessError: if deros refuses the rules.
    """
    models = folder / f"{name}_models"
    models.mkdir(exist_ok=True)
    _write_system(models, lanes)
    rules = models / f"{name}.deros"
    text = 'use "reaction.system" import Reaction\n\n' + "".join(map(_rules, lanes))
    rules.write_text(text, encoding="utf-8")
    deros = [sys.executable, "-c", "from deros.cli.main import main; main()"]
    command = [*deros, "generate", str(rules), "--target", target, "--output", str(folder)]
    # A package in C++ is built alone: it brings the runtime along.
    run([*command, *(["--runtime", "copy"] if target == "cpp" else [])])
    if target == "cpp":
        package = folder / f"{name}_safety_cpp"
        actions = package / f"include/{name}_safety_cpp/{name}_safety_node_actions.hpp"
        text = _CPP_ACTIONS.format(name=name, own=_actions_class(name), methods=_methods(lanes))
    else:
        package = folder / f"{name}_safety"
        actions = package / f"{name}_safety" / f"{name}_safety_node_actions.py"
        text = _actions(name, lanes)
    if actions.read_text(encoding="utf-8") != text:
        actions.write_text(text, encoding="utf-8")
    return package


def _rules(lane: Lane) -> str:
    duration = f" for {lane.seconds} sec" if lane.seconds else ""
    return _ACTION.format(name=lane.name, imu=lane.imu, state=lane.state, duration=duration)


def _actions(name: str, lanes: Sequence[Lane]) -> str:
    """Fill in the actions that end a stop: the benchmark has nothing to do in them."""
    own = _actions_class(name)
    lines = [
        f"from {name}_safety.{name}_safety_node_actions_base import {own}Base",
        f"class {own}({own}Base):",
    ]
    for lane in lanes:
        lines += [f"    def level_{lane.name}(self) -> None:", "        pass"]
    return "\n".join(lines) + "\n"


def _actions_class(name: str) -> str:
    return f"{name.capitalize()}SafetyNodeActions"


def _methods(lanes: Sequence[Lane]) -> str:
    return "".join(f"  void level_{lane.name}() override {{}}\n" for lane in lanes)


def _write_system(folder: Path, lanes: Sequence[Lane]) -> None:
    """Write the system of the driver, from which the rules have the types of the topics."""
    driver = _DRIVER.format(
        imus="\n".join(
            f"  topic imu_{lane.name} : sensor_msgs.Imu qos best_effort depth 10" for lane in lanes
        ),
        states="\n".join(f"  topic state_{lane.name} : std_msgs.Bool" for lane in lanes),
    )
    (folder / "driver.rnd").write_text(driver, encoding="utf-8")
    topics = "\n".join(f"  topic {lane.imu}\n  topic {lane.state}" for lane in lanes)
    wiring = "".join(
        f"    connect {port}_{lane.name} to {topic}\n"
        for lane in lanes
        for port, topic in (("imu", lane.imu), ("state", lane.state))
    )
    system = _SYSTEM.format(topics=topics) + "  wirings\n" + wiring
    (folder / "reaction.system").write_text(system, encoding="utf-8")
