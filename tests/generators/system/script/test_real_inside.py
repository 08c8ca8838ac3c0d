"""One program with several nodes gets through the script what is for each, on the real middleware.

What is held here is what the words rely on: of several rules the first one counts, a rule that
begins with a name is for that node alone, and a node with a command line of its own keeps its name.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import pytest

from deros.generators.builtin import rossystem_script
from deros.generators.output.writer import write
from tests.support.stand_ins import Run
from tests.support.systems import CONTEXT, load_text

pytestmark = pytest.mark.ros

PROGRAM = """#!{python}
import json, sys
import rclpy
from rclpy.node import Node
from std_msgs.msg import Bool

rclpy.init(args=sys.argv)
found = {{}}
for name, more in (('manager', {{}}), ('wheels', {{}}), ('other', {{}}), ('map', {{'cli_args': [
        '--ros-args', '-r', '__node:=map', '-r', '__ns:=/map']}})):
    node = Node(name, allow_undeclared_parameters=True,
                automatically_declare_parameters_from_overrides=True, **more)
    found[name] = [
        node.get_fully_qualified_name(),
        node.create_publisher(Bool, 'state', 1).topic_name,
        node.create_publisher(Bool, '~/odom', 1).topic_name,
        {{key: each.value for key, each in node.get_parameters_by_prefix('').items()
          if key in ('rate', 'radius', 'label')}}]
print(json.dumps(found), flush=True)
"""
MANAGER = """node manager : control executable "manager"
parameters name rate : int = 100 name label : string = ""
publishes topic state : std_msgs.Bool
"""
WHEELS = """node wheels : controllers
parameters name radius : double = 1.0 name label : string = ""
publishes topic state : std_msgs.Bool topic ~/odom : std_msgs.Bool
"""
BODY = """system Shared imports import "*.rnd"
topics topic /odom topic /state topic /here topic /map
node NAME : manager NAMED namespace /n
parameters from "p.yaml" parameters param rate = 25
wirings connect state to /state
inside NAME {
  node wheels : wheels namespace WHERE parameters param radius = 2
  wirings connect ~/odom to /odom connect state to /here
  node map : wheels namespace /map wirings connect ~/odom to /map
}
"""
FILE = """/**: {ros__parameters: {label: all}}
/n/wheels: {ros__parameters: {label: wheels, radius: 7.0}}
"""


def answered(folder: Path, environment: dict[str, str], body: str) -> dict[str, list[Any]]:
    """Return what the nodes of the program say, by the names in its text."""
    program = folder / "lib" / "control" / "manager"
    program.parent.mkdir(parents=True)
    program.write_text(PROGRAM.format(python=sys.executable))
    program.chmod(0o755)
    (folder / "p.yaml").write_text(FILE)
    model = load_text(folder, body, manager=MANAGER, wheels=WHEELS)
    write(rossystem_script(model, CONTEXT), folder / "made")
    run = Run([sys.executable, folder / "made" / "shared.py", "--install", folder], environment)
    assert run.end() == 0, run.lines
    (line,) = (each for each in run.lines if "{" in each)
    found: dict[str, list[Any]] = json.loads(line.partition("] ")[2])
    return found


def test_nodes_keep_their_names_with_a_program_that_names_itself(
    tmp_path: Path, ros_env: dict[str, str]
) -> None:
    """None is renamed, also none that the system does not describe."""
    body = BODY.replace("NAMED", "own_name").replace("NAME", "manager").replace("WHERE", "/n")
    assert answered(tmp_path, ros_env, body) == {
        "manager": ["/n/manager", "/state", "/n/manager/odom", {"label": "all", "rate": 25}],
        "wheels": ["/n/wheels", "/here", "/odom", {"label": "wheels", "radius": 2.0}],
        "other": ["/n/other", "/n/state", "/n/other/odom", {"label": "all"}],
        "map": ["/map/map", "/map/state", "/map", {"label": "all"}],
    }


def test_nodes_keep_their_names_in_a_program_that_is_renamed(
    tmp_path: Path, ros_env: dict[str, str]
) -> None:
    """What the system does not describe has the name of the program, and what is for that."""
    body = BODY.replace("NAMED", "").replace("NAME", "boss").replace("WHERE", "/far")
    assert answered(tmp_path, ros_env, body) == {
        "manager": ["/n/boss", "/state", "/n/boss/odom", {"label": "all", "rate": 25}],
        "wheels": ["/far/wheels", "/here", "/odom", {"label": "all", "radius": 2.0}],
        "other": ["/n/boss", "/state", "/n/boss/odom", {"label": "all", "rate": 25}],
        "map": ["/map/map", "/map/state", "/map", {"label": "all"}],
    }


def test_parameters_of_a_named_node_alone_are_for_its_process(
    tmp_path: Path, ros_env: dict[str, str]
) -> None:
    """So has launch them, of a node without a name."""
    body = 'system Shared imports import "*.rnd" node manager : manager own_name namespace /n '
    found = answered(tmp_path, ros_env, f"{body} parameters param rate = 3")
    assert [each[3] for each in found.values()] == [{"rate": 3}] * 4
    assert [each[0] for each in found.values()] == [
        "/n/manager",
        "/n/wheels",
        "/n/other",
        "/map/map",
    ]
