"""The models of the robots in physics: they take the faults that the hardware has, and no other."""

from __future__ import annotations

import pytest

from deros.metamodels.load import Repository
from deros.models.node import NodeType
from deros.models.system import System
from tests.support.examples import EXAMPLES, example_module

pytest.importorskip("mujoco", reason="the extra 'physics' is not installed")

physics = example_module("physics", "wheeled_physics.robot")
measures = example_module("physics", "wheeled_physics.measures")

PLANS = {"intelligent_one": ["bank"]}
"""What a robot's driver can be told to do, beside the faults of its hardware."""


@pytest.mark.parametrize("robot", ["frobit", "kobuki", "intelligent_one", "feeding_robot"])
def test_system_and_node_take_each_fault_of_the_robot(robot: str) -> None:
    """One that is missing there could not be tried on a running robot; another would end it."""
    faults = physics.Robot(getattr(measures, robot.upper())).faults
    expected = {"none", *faults, *PLANS.get(robot, [])}
    system = Repository().load(str(EXAMPLES / f"physics/{robot}_in_physics.system")).model
    node = Repository().load(str(EXAMPLES / f"physics/nodes/{robot}_in_physics.rnd")).model
    assert isinstance(system, System)
    assert isinstance(node, NodeType)
    (argument,) = [each for each in system.arguments if str(each.name) == "fault"]
    (parameter,) = [each for each in node.parameters if str(each.name) == "fault"]
    assert set(argument.choices or ()) == expected
    assert set(parameter.choices or ()) == expected
