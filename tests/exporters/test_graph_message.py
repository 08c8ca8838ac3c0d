"""Systems as a message ``rosgraph_msgs/msg/Graph``."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml

from deros.exporters.graph_message import file_name, graph_message
from deros.systems.flatten import flatten
from tests.support.foreign import become
from tests.support.imported import described
from tests.support.systems import load

ROOT = Path(__file__).resolve().parents[2]

LIDAR = """\
node lidar : lidar_driver
lifecycle
parameters
  name rate : double = 5.0 in [0.5, 40.0] read_only "Turns"
  name steps : integer = 3 in [1, 9]
  name names : string[] = ["a", "yes"]
  name raw : byte[] = [0, 255]
publishes
  topic scan : sensor_msgs.LaserScan qos best_effort depth 5 deadline 250 ms
services
  service ~/reset : std_srvs.Trigger
action_clients
  action turn : example_interfaces.Fibonacci
"""

PILOT = """\
node pilot : pilot
subscribes
  topic laser : sensor_msgs.LaserScan qos best_effort keep_all
clients
  client reset : std_srvs.Trigger
actions
  action turn : example_interfaces.Fibonacci
"""

SYSTEM = """\
system courier

imports
  import "nodes/*.rnd"

topics
  topic /left/scan : sensor_msgs.LaserScan
  external topic /left/lidar/change_state

subsystem left namespace /left {
  node lidar : lidar
    parameters
      param rate = 20.0
      param use_sim_time = false
    wirings
      connect turn to /turn
}

node pilot : pilot
  wirings
    connect laser to /left/scan
    connect reset to /left/lidar/reset
    connect turn to /turn
"""


def system(folder: Path, text: str = SYSTEM) -> Path:
    """Write a system and its node types."""
    (folder / "nodes").mkdir()
    (folder / "nodes/lidar.rnd").write_text(LIDAR, encoding="utf-8")
    (folder / "nodes/pilot.rnd").write_text(PILOT, encoding="utf-8")
    path = folder / "courier.system"
    path.write_text(text, encoding="utf-8")
    return path


def test_a_system_becomes_the_graph_that_it_forms(tmp_path: Path) -> None:
    """In the fields and the numbers of the messages."""
    flat = flatten(load(system(tmp_path)))
    exported = graph_message(flat)
    assert (exported.missing, file_name(flat)) == ((), "courier.graph.yaml")
    lidar, pilot = yaml.safe_load(exported.text)["nodes"]
    assert lidar["name"] == "/left/lidar"
    values = dict(
        zip((each["name"] for each in lidar["parameters"]), lidar["parameter_values"], strict=True)
    )
    assert values == {
        "names": {"type": 9, "string_array_value": ["a", "yes"]},
        "rate": {"type": 3, "double_value": 20.0},
        "raw": {"type": 5, "byte_array_value": [0, 255]},
        "steps": {"type": 2, "integer_value": 3},
        "use_sim_time": {"type": 1, "bool_value": False},
    }
    assert lidar["parameters"][1] == {
        "name": "rate",
        "type": 3,
        "description": "Turns",
        "read_only": True,
        "floating_point_range": [{"from_value": 0.5, "to_value": 40.0, "step": 0.0}],
    }
    assert lidar["parameters"][3]["integer_range"] == [{"from_value": 1, "to_value": 9, "step": 0}]
    assert lidar["publishers"] == [
        {
            "name": "/left/scan",
            "type": {"name": "sensor_msgs/msg/LaserScan"},
            "qos": {
                "depth": 5,
                "deadline": {"sec": 0, "nanosec": 250_000_000},
                "lifespan": {"sec": 0, "nanosec": 0},
                "history": 1,
                "reliability": 2,
                "durability": 2,
                "liveliness": 1,
                "liveliness_lease_duration": {"sec": 0, "nanosec": 0},
            },
        }
    ]
    assert {
        "name": "/left/lidar/reset",
        "request_type": {"name": "std_srvs/srv/Trigger_Request"},
        "response_type": {"name": "std_srvs/srv/Trigger_Response"},
    } in lidar["service_servers"]
    managed = [each["request_type"]["name"] for each in lidar["service_servers"][1:]]
    assert "lifecycle_msgs/srv/ChangeState_Request" in managed
    assert pilot["subscriptions"][0]["qos"]["history"] == 2
    turn = pilot["action_servers"][0]
    assert (turn["name"], turn["send_goal"]["name"], turn["feedback"]["type"]["name"]) == (
        "/turn",
        "/turn/_action/send_goal",
        "example_interfaces/action/Fibonacci_FeedbackMessage",
    )


def test_a_graph_is_read_as_the_system_that_it_is_of(tmp_path: Path) -> None:
    """Ends with their policies, and parameters with their types and values."""
    path = system(tmp_path)
    file = tmp_path / "courier.graph.yaml"
    file.write_text(graph_message(flatten(load(path))).text, encoding="utf-8")
    made = become(file)
    assert (made.findings, made.missing) == ([], ())
    read, written = described(made.paths[0]), described(path)
    assert {name: each.ends for name, each in read.items()} == {
        name: each.ends for name, each in written.items()
    }
    assert read["/left/lidar"].parameters == {
        "names": ("string[]", ("a", "yes")),
        "rate": ("double", 20.0),
        "raw": ("byte[]", (0, 255)),
        "steps": ("integer", 3),
    }
    text = (made.paths[0].parent / "nodes/lidar.rnd").read_text(encoding="utf-8")
    assert "lifecycle" in text


@pytest.mark.parametrize("path", sorted(ROOT.glob("examples/*/*.system")), ids=lambda p: p.stem)
def test_graphs_of_the_examples_are_read_as_they_are(path: Path, tmp_path: Path) -> None:
    """With safety nodes and gates, which are nodes like any other in a graph."""
    file = tmp_path / "robot.graph.yaml"
    exported = graph_message(flatten(load(path)))
    file.write_text(exported.text, encoding="utf-8")
    made = become(file)
    assert (exported.missing, made.missing) == ((), ())
    read, written = described(made.paths[0]), described(path)
    assert {name: set(each.ends) for name, each in read.items()} == {
        name: set(each.ends) for name, each in written.items()
    }


def test_what_a_graph_cannot_say_is_listed(tmp_path: Path) -> None:
    """A launch file may start nodes that nobody describes."""
    text = SYSTEM + 'launch "nav.launch.py"\n'
    exported = graph_message(flatten(load(system(tmp_path, text))))
    said = "launch file 'nav' may start nodes that are not in the graph"
    assert [each.endswith(said) for each in exported.missing] == [True]
