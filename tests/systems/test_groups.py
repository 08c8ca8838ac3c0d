"""Settings of groups: which of several counts, and what a remapping does to the names of a node."""

from __future__ import annotations

from pathlib import Path

from deros.systems.flat import FlatNode
from deros.systems.flatten import flatten
from tests.support.systems import load_text

NODE = """
    node lidar : sensors
    parameters
      name topic_name : string = "points"
      name rate : double = 10.0
      name inputs : string[] = ["near", "far"]
    publishes
      topic scan : sensor_msgs.LaserScan
      topic /tf : tf2_msgs.TFMessage
      topic cloud : sensor_msgs.PointCloud2 via topic_name
    subscribes
      topic input : sensor_msgs.LaserScan via inputs
    services
      service scan : std_srvs.Trigger
    action_clients
      action drive : example_interfaces.Fibonacci
"""


def nodes(folder: Path, body: str) -> dict[str, FlatNode]:
    """Return the nodes of a system, by full name."""
    more = 'import "arm.system"' if (folder / "arm.system").is_file() else ""
    system = load_text(folder, f'system Test imports import "*.rnd" {more} {body}', lidar=NODE)
    return {node.full_name: node for node in flatten(system).nodes}


def variables(node: FlatNode) -> dict[str, str]:
    """Return the environment variables of a node."""
    return {each.name: each.value.text for each in node.environment}


def topics(node: FlatNode) -> list[tuple[str, str]]:
    """Return the name that each port asks for, and the one that it gets."""
    return [(port.requested, port.topic) for port in node.ports]


def test_innermost_setting_counts(tmp_path: Path) -> None:
    """A node's own setting before those of its groups, an inner group's before an outer one's."""
    (tmp_path / "arm.system").write_text(
        'system Arm imports import "lidar.rnd" env A = "arm" node eye : lidar'
    )
    found = nodes(
        tmp_path,
        """
        env A = "system" env B = "system"
        parameters param rate = 1 param use_sim_time = true
        subsystem s {
          env B = "s" parameters param rate = 2
          node one : lidar env B = "node" parameters param rate = 3
          node two : lidar
          subsystem t : Arm namespace t { parameters param rate = 4 }
        }
        node three : lidar
        """,
    )
    assert variables(found["/one"]) == {"A": "system", "B": "node"}
    assert variables(found["/two"]) == {"A": "system", "B": "s"}
    assert variables(found["/t/eye"]) == {"A": "arm", "B": "s"}
    assert variables(found["/three"]) == {"A": "system", "B": "system"}
    rates = {name: dict(node.parameters)["rate"] for name, node in found.items()}
    assert rates == {"/one": 3.0, "/two": 2.0, "/t/eye": 4.0, "/three": 1.0}
    assert all(dict(node.parameters)["use_sim_time"] is True for node in found.values())
    # As ROS 2 tells them apart, an integer for a double would end the node.
    assert {type(value) for value in rates.values()} == {float}


def test_connection_of_a_node_counts_before_its_groups(tmp_path: Path) -> None:
    """One that sets a parameter wins over the group's, and is not remapped once more."""
    node = nodes(
        tmp_path,
        """
        parameters param topic_name = "elsewhere"
        remappings remap scan to /moved remap /cloud to /moved_cloud
        node n : lidar wirings connect cloud to /cloud connect publisher scan to /mine
        """,
    )["/n"]
    assert dict(node.parameters)["topic_name"] == "/cloud"
    assert ("/cloud", "/cloud") in topics(node)
    assert [topic for name, topic in topics(node) if name == "/scan"] == ["/mine", "/moved"]
    assert node.remappings == (("rostopic://scan", "/mine"), ("rosservice://scan", "/moved"))


def test_remapping_is_for_the_full_name_that_a_node_asks_for(tmp_path: Path) -> None:
    """As in ROS 2: in its namespace, also for names from parameters and lists."""
    found = nodes(
        tmp_path,
        """
        remappings remap /tf to tf remap points to cloud remap near to /near/scan
          remap ~/log to /log remap /a/scan to /b/scan remap drive to /go
        node n : lidar namespace a
        node o : lidar namespace b
        """,
    )
    assert topics(found["/a/n"]) == [
        ("/a/scan", "/b/scan"),
        ("/tf", "/a/tf"),
        ("/a/points", "/a/cloud"),
        ("/a/near", "/near/scan"),
        ("/a/far", "/a/far"),
        ("/a/scan", "/b/scan"),
        ("/a/drive", "/go"),
    ]
    assert topics(found["/b/o"])[0] == ("/b/scan", "/b/scan")
    # What no port asks for is passed on all the same: a library may open it.
    assert dict(found["/a/n"].remappings)["~/log"] == "/log"
    assert dict(found["/b/o"].remappings)["/a/scan"] == "/b/scan"


def test_innermost_remapping_of_a_full_name_counts(tmp_path: Path) -> None:
    """However it is written: of two rules, ROS 2 would apply the first."""
    node = nodes(
        tmp_path,
        "remappings remap /scan to /outer subsystem s { remappings remap scan to /inner"
        " node n : lidar }",
    )["/n"]
    assert [topic for name, topic in topics(node) if name == "/scan"] == ["/inner", "/inner"]
    assert node.remappings == (("scan", "/inner"),)


def test_rules_of_inner_groups_stand_first(tmp_path: Path) -> None:
    """For names that may be one elsewhere: ROS 2 applies the first rule of several for a name."""
    node = nodes(
        tmp_path,
        "remappings remap lib to /outer remap odd to /odd"
        " subsystem s { remappings remap /x/lib to /inner node n : lidar }",
    )["/n"]
    assert node.remappings == (("/x/lib", "/inner"), ("lib", "/outer"), ("odd", "/odd"))


def test_group_without_settings_changes_nothing(tmp_path: Path) -> None:
    """Nodes that have none of the parameters are those that were written."""
    node = nodes(tmp_path, "parameters param other = 1 node n : lidar")["/n"]
    assert (node.parameters, node.remappings, node.environment) == ((), (), ())


def test_remapping_of_a_node_counts_before_those_of_its_groups(tmp_path: Path) -> None:
    """It is for that node alone, and what it names is the full name, as in a group."""
    found = nodes(
        tmp_path,
        """
        remappings remap /scan to /outer remap /tf to /outer_tf
        node one : lidar remappings remap scan to /own remap "/library" to tf
        node two : lidar
        """,
    )
    one, two = found["/one"], found["/two"]
    assert [topic for name, topic in topics(one) if name == "/scan"] == ["/own", "/own"]
    assert ("/tf", "/outer_tf") in topics(one)
    assert one.remappings == (("scan", "/own"), ("/library", "/tf"), ("/tf", "/outer_tf"))
    assert two.remappings == (("scan", "/outer"), ("/tf", "/outer_tf"))


def test_own_remapping_gives_way_to_a_connection(tmp_path: Path) -> None:
    """Of the port; for others of that name it counts."""
    node = nodes(
        tmp_path,
        """
        node one : lidar
        wirings connect publisher scan to /mine
        remappings remap scan to /moved
        """,
    )["/one"]
    assert [topic for name, topic in topics(node) if name == "/scan"] == ["/mine", "/moved"]
