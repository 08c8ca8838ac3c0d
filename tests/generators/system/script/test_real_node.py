"""A generated node gets parameters from files through the script, on the real middleware."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import pytest

from tests.support.cli import deros
from tests.support.stand_ins import Run

pytestmark = pytest.mark.ros

NODE = """node fusion : state_fusion
parameters
  name accel_noise : double = 0.1 > 0
  name hdop : double = 4.0
  name mode : string = "auto"
  name rate : double = 1.0
  name frames : string[] = ["map"]
"""
SYSTEM = """system Rover
imports import "fusion.rnd"
argument robot : string = "husky" one_of ["husky", "jackal"]
parameters from "common.yaml"
subsystem front namespace front {
  node fusion : fusion
  parameters from "${robot}.yaml"
  parameters
    param hdop = 7
}
"""
COMMON = """/**:
  ros__parameters:
    accel_noise: 2.0
    hdop: 2.0
    mode: "off"
    rate: 2.0
"""
HUSKY = """front:
  fusion:
    ros__parameters:
      accel_noise: 3.0
      hdop: 3.0
/**/fusion:
  ros__parameters:
    mode: "7"
    frames: [odom, map]
"""
PROGRAM = """import json

from state_fusion.fusion_base import FusionBase, run


class Fusion(FusionBase):
    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        found = {name: value.value for name, value in self.get_parameters_by_prefix('').items()}
        print(json.dumps({name: found[name] for name in sorted(found) if '_time' not in name
                          and 'service' not in name}), flush=True)
        raise SystemExit(0)


def main(args=None):
    run(Fusion, args)
"""


def test_node_has_the_values_of_its_files(tmp_path: Path, ros_env: dict[str, str]) -> None:
    """The more specific key of a later file wins, and the system over all of them."""
    for name, text in (
        ("fusion.rnd", NODE),
        ("rover.system", SYSTEM),
        ("common.yaml", COMMON),
        ("husky.yaml", HUSKY),
        ("jackal.yaml", HUSKY.replace("3.0", "5.0")),
    ):
        (tmp_path / name).write_text(text)
    for model, target in (("fusion.rnd", "python"), ("rover.system", "script")):
        outcome = deros("generate", tmp_path / model, "--target", target, "-o", tmp_path / "ws")
        assert outcome.code == 0, outcome
    (tmp_path / "ws/state_fusion/state_fusion/fusion.py").write_text(PROGRAM)
    for robot, noise in (("husky", 3.0), ("jackal", 5.0)):
        command: list[str | Path] = [
            sys.executable,
            tmp_path / "ws/rover.py",
            "--install",
            tmp_path / "ws",
        ]
        run = Run([*command, f"robot:={robot}"], ros_env)
        assert run.end() == 0, run.lines
        line = next(each for each in run.lines if each.startswith("[fusion] {"))
        assert json.loads(line.removeprefix("[fusion] ")) == {
            "accel_noise": noise,
            "frames": ["odom", "map"],
            "hdop": 7.0,
            "mode": "7",
            "rate": 2.0,
        }
