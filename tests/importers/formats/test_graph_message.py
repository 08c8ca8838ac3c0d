"""A message ``rosgraph_msgs/msg/Graph`` as node descriptions and a system."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import event, given, settings

from deros.importers.formats.graph_message import is_graph
from deros.importers.readers import UnreadableError
from deros.models.qos import Policies
from tests.support.foreign import Become, become, damaged, survived
from tests.support.imported import described

GRAPH = """\
nodes:
- name: /left/lidar
  parameters:
  - name: rate
    type: 3
    description: Turns
    additional_constraints: ''
    read_only: true
    dynamic_typing: false
    floating_point_range:
    - {from_value: 0.5, to_value: 40.0, step: 0.0}
    integer_range: []
  - {name: names, type: 9}
  - {name: use_sim_time, type: 1}
  parameter_values:
  - {type: 3, bool_value: false, integer_value: 0, double_value: 10.0, string_value: ''}
  - {type: 9, string_array_value: [a, 'b c']}
  - {type: 1, bool_value: false}
  publishers:
  - name: /left/scan
    type:
      name: sensor_msgs/msg/LaserScan
      hash: {version: 1, value: [0, 1]}
    qos:
      depth: 5
      deadline: {sec: 0, nanosec: 250000000}
      lifespan: {sec: 9223372036, nanosec: 854775807}
      history: 1
      reliability: 2
      durability: 2
      liveliness: 3
      liveliness_lease_duration: {sec: 2, nanosec: 0}
  - name: /rosout
    type: {name: rcl_interfaces/msg/Log}
  subscriptions: []
  service_clients: []
  service_servers:
  - name: /left/lidar/reset
    request_type: {name: std_srvs/srv/Trigger_Request}
    response_type: {name: std_srvs/srv/Trigger_Response}
  - name: /left/lidar/list_parameters
    request_type: {name: rcl_interfaces/srv/ListParameters_Request}
  action_clients: []
  action_servers:
  - name: /left/turn
    send_goal:
      name: /left/turn/_action/send_goal
      request_type: {name: example_interfaces/action/Fibonacci_SendGoal_Request}
- name: /pilot
  parameters: []
  parameter_values: []
  publishers: []
  subscriptions:
  - name: /left/scan
    type: {name: sensor_msgs/msg/LaserScan}
    qos: {depth: 0, history: 2, reliability: 2, durability: 2, liveliness: 1}
---
nodes: []
"""


def graph(folder: Path, text: str) -> Become:
    """Return what a message becomes."""
    path = folder / "graph.yaml"
    path.write_text(text, encoding="utf-8")
    return become(path)


def test_a_graph_becomes_a_system_that_checks_clean(tmp_path: Path) -> None:
    """Nodes, ends, QoS and parameters are those of the first message; what nodes have is not."""
    made = graph(tmp_path, GRAPH)
    assert (made.findings, made.missing) == ([], ())
    found = described(made.paths[0])
    assert {name: each.ends for name, each in found.items()} == {
        "/left/lidar": {
            ("publisher", "/left/scan", "sensor_msgs/msg/LaserScan"): Policies(
                reliability="best_effort",
                deadline=250_000_000,
                liveliness="manual_by_topic",
                lease=2 * 10**9,
                depth=5,
            ),
            ("service", "/left/lidar/reset", "std_srvs/srv/Trigger"): None,
            ("action", "/left/turn", "example_interfaces/action/Fibonacci"): None,
        },
        "/pilot": {
            ("subscriber", "/left/scan", "sensor_msgs/msg/LaserScan"): Policies(
                reliability="best_effort", depth=float("inf")
            ),
        },
    }
    assert found["/left/lidar"].parameters == {
        "rate": ("double", 10.0),
        "names": ("string[]", ("a", "b c")),
    }
    texts = {path.name: path.read_text(encoding="utf-8") for path in made.paths}
    assert 'name rate : double in [0.5, 40.0] read_only "Turns"' in texts["lidar.rnd"]
    assert "parameters open" in texts["pilot.rnd"]


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("/pilot", "/left/lidar", "node '/left/lidar' is left out: another one has its name"),
        ("/pilot", "/_pilot", "names that begin with '_' are those of tools"),
        ("/pilot", "/pi-lot", "its name contains '-'"),
        ("- name: /pilot", "- '...'\n- name: /pilot", "a node has no fields; print it in full"),
        ("- {name: names, type: 9}", "- '...'", "an entry of 'parameters' has no fields"),
        ("  - {name: names, type: 9}\n", "", "are left out: 2 have 3 values"),
        ("- {type: 9, ", "- {type: 0, ", "parameter 'names' of '/left/lidar' is left out: it has"),
        ("[a, 'b c']", "[a, 1]", "its value is of another type"),
        ("double_value: 10.0", "double_value: " + "9" * 400, "of more than 64 bits"),
        ("from_value: 0.5", "from_value: " + "9" * 400, "has a range that its value is not in"),
        ("from_value: 0.5", "from_value: 50.5", "has a range that its value is not in"),
        ("step: 0.0", "step: 0.5", "goes in steps of 0.5"),
        ("reliability: 2\n", "reliability: 3\n", "'reliability: 3', which says nothing"),
        ("name: sensor_msgs/msg/LaserScan\n", "name: no_msgs/msg/Scan\n", "there is no definition"),
        ("name: /left/scan", "name: /left scan", "its name contains ' '"),
        ("name: names", "name: " + "x" * 300, "its name is too long"),
        ("- {type: 1, bool_value: false}", "- {type: 2, integer_value: 1}", "it is not of type"),
        ("name: /left/lidar/reset", 'name: "/left/\\x07"', "its name contains '?'"),
        ("/rosout", "/left/scan", "comes again, with another type or QoS"),
    ],
)
def test_what_a_model_cannot_say_is_listed(old: str, new: str, said: str, tmp_path: Path) -> None:
    """With file and line."""
    assert old in GRAPH
    made = graph(tmp_path, GRAPH.replace(old, new, 1))
    assert [str(each) for each in made.findings] == []
    found = [each for each in made.missing if said in each]
    assert found, made.missing
    assert all(each.split(":")[1].isdigit() for each in found)


@pytest.mark.parametrize(
    ("name", "text", "is_one"),
    [
        ("g.yaml", "nodes: [{name: /a, publishers: []}]\n", True),
        ("g.json", '{"nodes": [{"name": "/a", "publishers": []}]}', True),
        ("g.txt", "nodes: [{name: /a, publishers: []}]\n", False),
        ("g.yaml", "nodes: []\n", False),
        ("g.yaml", "nodes: [a]\n", False),
        ("g.yaml", "nodes: {a: 1}\n", False),
    ],
)
def test_a_graph_is_known_by_its_nodes(name: str, text: str, is_one: bool, tmp_path: Path) -> None:
    """Other YAML has nodes, too."""
    (tmp_path / name).write_text(text, encoding="utf-8")
    assert is_graph(tmp_path / name) is is_one


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("nodes: 3\n", "this is no graph, which has a list of 'nodes'"),
        ("nodes: []\n", "there is no node in this graph"),
        ("nodes: [a]\n", "there is no node in this graph"),
    ],
)
def test_what_has_no_nodes_cannot_be_read(text: str, said: str, tmp_path: Path) -> None:
    """The error names the file."""
    path = tmp_path / "graph.yaml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(UnreadableError, match=said):
        become(path, word="graph")
    with pytest.raises(UnreadableError, match="a graph is in one file"):
        become(path, path, word="graph")


@settings(deadline=None, max_examples=60)
@given(data=damaged(GRAPH))
def test_a_damaged_graph_ends_in_a_clean_model_or_an_error(data: bytes) -> None:
    """Whatever stands in it; a graph with faults of its own has findings, and no traceback."""
    findings = {"DRS208", "DRS228", "DRS229", "DRS232"}  # types and QoS that do not fit
    made = survived(data, "graph.yaml", "graph", allowed=findings)
    event("models" if made else "error")
