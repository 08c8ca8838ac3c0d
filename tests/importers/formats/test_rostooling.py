"""Models of RosTooling as node descriptions and systems."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import event, given, settings

from deros.importers.formats.rostooling import is_rostooling
from deros.importers.readers import UnreadableError
from deros.models.common import QosProfile
from deros.models.node import Parameter, PortKind
from tests.support.foreign import Become, become, damaged, survived
from tests.support.imported import described

LIDAR = """\
lidar_driver:
  fromGitRepo: "https://example.org/lidar.git:main"
  artifacts:
    lidar_exe:
      node: lidar # of the front
      publishers:
        scan:
          type: "sensor_msgs/msg/LaserScan"
          qos:
            profile: sensor_qos
            depth: 5
        'status':
          type: std_msgs/String
          ns: GlobalNamespace
        'left/~x': {type: std_msgs/msg/Bool}
      serviceservers:
        reset:
          type: 'std_srvs/srv/Trigger'
          ns: PrivateNamespace [a, b]
      actionservers:
        turn:
          type: "example_interfaces/action/Fibonacci"
      parameters:
        rate: {type: Double, value: 10}
        name: {type: String, default: on}
        on: {type: Boolean, value: False}
        count: {type: Integer, value: -3}
        limits: {type: 'Array[Double]', value: [1, 2.5]}
        frames:
          type: Array [String]
          value: "['a', 'b']"
        port:
          type: String
"""

PILOT = """\
pilot_pkg:
  artifacts:
    pilot:
      node: pilot
      subscribers:
        laser:
          type: "sensor_msgs/msg/LaserScan"
          qos:
            profile: sensor_qos
            reliability: best_effort
            durability: volatile
            history: keep_all
      serviceclients:
        reset_lidar: {type: std_srvs/srv/Trigger}
      actionclients:
        turn: {type: example_interfaces/action/Fibonacci}
"""

SYSTEM = """\
robot:
  fromFile: "robot_bringup/launch/robot.launch.py"
  subSystems:
    rear
  nodes:
    lidar:
      from: "lidar_driver.lidar"
      namespace: "/front"
      interfaces:
        - scan_front: pub-> "lidar::scan"
        - "trigger": ss-> "lidar::~/a/b/reset"
        - turning: as->"lidar::turn"
      parameters:
        - front_rate: "lidar::rate"
          value: 20.5
        - front_port: "lidar::port"
          value: /dev/lidar
    pilot:
      from: "pilot_pkg.pilot"
      interfaces:
        - laser_in: sub-> "pilot::laser"
        - resetting: sc-> "pilot::reset_lidar"
        - turn_it: ac-> "pilot::turn"
  connections:
    -[scan_front, laser_in]
    -[ resetting, trigger ]
    - [turning, turn_it]
"""

REAR = """\
rear:
  nodes:
    rear_lidar:
      from: "lidar_driver.lidar_exe"
      parameters:
        - p: "lidar::port"
          value: "/dev/rear"
"""


def models(folder: Path, **texts: str) -> Become:
    """Return what files become: ``lidar_ros2`` is the text of ``lidar.ros2``."""
    paths = []
    for name, text in texts.items():
        paths.append(folder / name.replace("_ros", ".ros"))
        paths[-1].write_text(text, encoding="utf-8")
    return become(*paths)


def node_lines(folder: Path, lines: str) -> Become:
    """Return what a node with some sections becomes."""
    text = "a_package:\n  artifacts:\n    x:\n      node: x\n"
    return models(folder, a_ros2=text + "".join(f"      {each}\n" for each in lines.splitlines()))


def test_a_node_has_the_interfaces_of_its_file(tmp_path: Path) -> None:
    """Names with their namespaces, types, QoS and values; what is left out is listed."""
    made = models(tmp_path, lidar_ros2=LIDAR)
    assert made.findings == []
    assert made.paths == (tmp_path / "models/nodes/lidar.rnd",)
    node = made.node
    assert (node.name, node.package, node.executable) == ("lidar", "lidar_driver", "lidar_exe")
    assert [(each.kind, each.name, str(each.type), each.qos) for each in node.ports] == [
        (
            PortKind.PUBLISHER,
            "scan",
            "sensor_msgs/msg/LaserScan",
            QosProfile(preset="sensor_data", depth=5),
        ),
        (PortKind.PUBLISHER, "/status", "std_msgs/msg/String", None),
        (PortKind.SERVICE, "~/a/b/reset", "std_srvs/srv/Trigger", None),
        (PortKind.ACTION, "turn", "example_interfaces/action/Fibonacci", None),
    ]
    assert [(each.name, each.type.value, each.default) for each in node.parameters] == [
        ("rate", "double", 10.0),
        ("name", "string", "on"),
        ("on", "bool", False),
        ("count", "integer", -3),
        ("limits", "double[]", (1.0, 2.5)),
        ("frames", "string[]", ("a", "b")),
    ]
    assert node.takes_any_parameter
    assert made.missing == (
        "lidar.ros2:32: parameter 'port' of type String is left out: it has no value, and a "
        "declared one without a value must be set",
        "lidar.ros2:15: publisher 'left/~x' is left out: ROS 2 rejects the name 'left/~x': it has "
        "'~' after its start",
    )
    text = made.paths[0].read_text(encoding="utf-8")
    assert text.startswith(
        "// From https://example.org/lidar.git:main\nnode lidar : lidar_driver\n"
    )


def test_a_system_connects_what_the_file_connects(tmp_path: Path) -> None:
    """Ends of a connection have the name of its first one, others their own name in the system."""
    made = models(
        tmp_path, lidar_ros2=LIDAR, pilot_ros2=PILOT, robot_rossystem=SYSTEM, rear_rossystem=REAR
    )
    assert made.findings == []
    assert [path.name for path in made.paths] == [
        "robot.system",
        "rear.system",
        "lidar.rnd",
        "pilot.rnd",
    ]
    found = described(made.paths[0])
    assert {name: set(each.ends) for name, each in found.items()} == {
        "/front/lidar": {
            ("publisher", "/front/scan_front", "sensor_msgs/msg/LaserScan"),
            ("publisher", "/status", "std_msgs/msg/String"),
            ("service", "/front/trigger", "std_srvs/srv/Trigger"),
            ("action", "/front/turning", "example_interfaces/action/Fibonacci"),
        },
        "/pilot": {
            ("subscriber", "/front/scan_front", "sensor_msgs/msg/LaserScan"),
            ("client", "/front/trigger", "std_srvs/srv/Trigger"),
            ("action_client", "/front/turning", "example_interfaces/action/Fibonacci"),
        },
        "/rear_lidar": {
            ("publisher", "/scan", "sensor_msgs/msg/LaserScan"),
            ("publisher", "/status", "std_msgs/msg/String"),
            ("service", "/rear_lidar/a/b/reset", "std_srvs/srv/Trigger"),
            ("action", "/turn", "example_interfaces/action/Fibonacci"),
        },
    }
    parameters = {name: each.parameters for name, each in found.items()}
    assert parameters["/front/lidar"]["rate"] == ("double", 20.5)
    # Each node of the type is given a port, so that the parameter can be declared.
    assert parameters["/front/lidar"]["port"] == ("string", "/dev/lidar")
    assert parameters["/rear_lidar"]["port"] == ("string", "/dev/rear")
    text = made.paths[0].read_text(encoding="utf-8")
    assert text.startswith("// From robot_bringup/launch/robot.launch.py\nsystem robot\n")
    assert [each for each in made.missing if "rossystem" in each] == []


@pytest.mark.parametrize(
    ("lines", "said"),
    [
        ("publishers:\n  a: {type: no_such_msgs/msg/A}", "unknown interface package"),
        ("publishers:\n  a: {type: std_msgs/srv/Bool}", "is no type of a publisher"),
        ("publishers:\n  a: {ns: GlobalNamespace}", "'' is no type of a publisher"),
        ("publishers:\n  a: std_msgs/msg/Bool", "has a value in place of keys"),
        ("publishers:\n  a: {type: std_msgs/msg/Bool, ns: Mine}", "namespace that cannot be read"),
        ("publishers:\n  a: {type: std_msgs/msg/Bool, rate: 3}", "has 'rate', which is not known"),
        ("publishers:\n  a: {type: std_msgs/msg/Bool, qos: {depth: 0}}", "'depth: 0'"),
        ("publishers:\n  a: {type: std_msgs/msg/Bool, qos: {profile: x}}", "'profile: x'"),
        ("publishers:\n  a: {type: std_msgs/msg/Bool, qos: {history: [1]}}", "'history: None'"),
        (
            "publishers:\n  a: {type: std_msgs/msg/Bool, qos: {history: keep_all, depth: 3}}",
            "keeps all messages, so that it has no depth",
        ),
        ("parameters:\n  a: {type: Date, value: 3}", "has no type 'Date'"),
        ("parameters:\n  a: {type: 'Array[Integer]', value: [1, x]}", "'a' has no value here"),
        ("parameters:\n  a: {type: 'Array[Date]', value: []}", "has no type 'Array[Date]'"),
        (f"parameters:\n  a: {{type: Double, value: {'9' * 400}}}", "of more than 64 bits"),
        ("parameters:\n  a: {type: Integer, value: {b: 1}}", "it has keys, and is no value"),
        ("parameters:\n  a: {type: Integer, value: [\n    b: 1\n    c: 2]}", "it has keys"),
        ("parameters:\n  a: {type: Boolean, value: None}", "it is of another type"),
        ("parameters:\n  a: {type: Integer, value: 1, default: 2}", "has a default, too"),
        ("parameters:\n  a: {type: Integer, value: 1, qos: {}}", "has 'qos'"),
        ("timers:\n  a: {period: 3}", "'timers' is left out"),
    ],
)
def test_what_a_node_cannot_say_is_listed(lines: str, said: str, tmp_path: Path) -> None:
    """With its line, and in the description."""
    made = node_lines(tmp_path, lines)
    assert made.findings == []
    assert any(said in each for each in made.missing), made.missing
    assert all(each.startswith(("a.ros2:5: ", "a.ros2:6: ", "a.ros2:7: ")) for each in made.missing)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("p_q:\n  artifacts:\n    a: {}\n", "a.ros2:3: artifact 'a' has no node"),
        ("p_q:\n  artifacts:\n    a: {node: b}\n  licence: c\n", "has 'licence'"),
        ("p_q:\n  artifacts: [a]\n", "with artifacts has a value in place of keys"),
        ("P Q:\n  artifacts:\n    a: {node: b}\n", "package 'P Q' is left out: its name contains"),
        ("p_q:\n  artifacts:\n    a b/..: {node: b}\n", "artifact 'a b/..' is left out: its name"),
        ("p_q:\n  artifacts:\n    a: {node: b}\n  dependencies: [c]\n", "has 'dependencies'"),
    ],
)
def test_what_a_package_cannot_say_is_listed(text: str, said: str, tmp_path: Path) -> None:
    """Also where there is nothing to describe."""
    text += "r_s:\n  artifacts:\n    z: {node: z}\n"
    made = models(tmp_path, a_ros2=text)
    assert made.findings == []
    assert any(said in each for each in made.missing), made.missing


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("lidar_driver.lidar", "lidar_driver.radar", "none of the files has its type"),
        ('"/front"', '"front lidar"', "is in no namespace here"),
        ("    pilot:\n", "    pi-lot:\n", "node 'pi-lot' is left out: its name contains '-'"),
        ("pub->", "sub->", "the type has no subscriber 'scan' here"),
        ("as->", "act->", "cannot be read: 'act->"),
        ("scan_front: pub", "'scan front': pub", "has no name of its own here"),
        ("value: 20.5", "value: fast", "parameter 'rate' of 'lidar' is left out: it is of another"),
        ("lidar::rate", "lidar::speed", "its type has no parameter of that name here"),
        ("          value: 20.5\n", "", "parameter 'front_rate' of 'lidar' is left out: it has no"),
        ("[scan_front, laser_in]", "[scan_front, turn_it]", "no interfaces of these names"),
        ("[scan_front, laser_in]", "[scan_front]", "it has two ends"),
        ("    rear\n", "    front\n", "subsystem 'front' is left out: none of the files has it"),
        ("    rear\n", "    robot\n", "subsystem 'robot' is left out: it contains itself"),
        ("  connections:", "  processes:\n    p: {nodes: [lidar]}\n  connections:", "process 'p'"),
        ("  connections:", "  parameters:\n    p: {type: String}\n  connections:", "parameter 'p'"),
        ("  connections:", "  machines: 3\n  connections:", "'machines' is left out"),
        ("      namespace:", "      host: here\n      namespace:", "has 'host'"),
    ],
)
def test_what_a_system_cannot_say_is_listed(old: str, new: str, said: str, tmp_path: Path) -> None:
    """The rest of the system stays, and checks clean."""
    assert old in SYSTEM
    made = models(
        tmp_path,
        lidar_ros2=LIDAR,
        pilot_ros2=PILOT,
        robot_rossystem=SYSTEM.replace(old, new, 1),
        rear_rossystem=REAR,
    )
    assert made.findings == []
    assert any("robot.rossystem:" in each and said in each for each in made.missing), made.missing


def test_a_connection_of_two_types_is_left_out(tmp_path: Path) -> None:
    """Its ends keep their names, which are different."""
    made = models(
        tmp_path,
        lidar_ros2=LIDAR,
        pilot_ros2=PILOT.replace("LaserScan", "Imu"),
        robot_rossystem=SYSTEM.replace("    rear\n", ""),
    )
    assert made.findings == []
    said = "is left out: sensor_msgs/msg/LaserScan is not sensor_msgs/msg/Imu"
    assert any(said in each for each in made.missing)
    assert ("subscriber", "/laser_in", "sensor_msgs/msg/Imu") in described(made.paths[0])[
        "/pilot"
    ].ends


def test_names_of_keywords_can_be_names(tmp_path: Path) -> None:
    """Words of the languages may be names of nodes, ports and parameters."""
    words = ["node", "topic", "parameters", "publishes", "name", "system", "qos", "open", "in"]
    lines = "publishers:\n" + "".join(f"  {each}: {{type: std_msgs/msg/Bool}}\n" for each in words)
    lines += "parameters:\n" + "".join(f"  {each}: {{type: Integer, value: 1}}\n" for each in words)
    made = node_lines(tmp_path, lines)
    assert (made.findings, made.missing) == ([], ())
    assert [each.name for each in made.node.ports] == words
    assert [each.name for each in made.node.parameters] == words


def test_a_file_is_known_by_its_name(tmp_path: Path) -> None:
    """Models of ROS 1 and of messages are not of this kind."""
    names = ("a.ros2", "a.rossystem", "a.ros1", "a.ros", "a.yaml")
    assert [is_rostooling(tmp_path / each) for each in names] == [True, True, False, False, False]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "has no keys at its top"),
        ("a: [", "a.ros2:1: this is not YAML"),
        ("a_b:\n\tartifacts:\n", "a.ros2:2: this is not YAML"),
        ("a_b: {}", "there is no node in these files"),
    ],
)
def test_what_says_nothing_cannot_be_read(text: str, said: str, tmp_path: Path) -> None:
    """The error names the file."""
    with pytest.raises(UnreadableError, match=said):
        models(tmp_path, a_ros2=text)


@settings(deadline=None, max_examples=60)
@given(data=damaged(LIDAR))
def test_a_damaged_node_ends_in_a_clean_model_or_an_error(data: bytes) -> None:
    """Whatever stands in the file."""
    event("models" if survived(data, "lidar.ros2") else "error")


@settings(deadline=None, max_examples=60)
@given(data=damaged(SYSTEM))
def test_a_damaged_system_ends_in_a_clean_model_or_an_error(data: bytes) -> None:
    """Whatever stands in the file; the node types beside it are as they were."""
    beside = {"lidar.ros2": LIDAR, "pilot.ros2": PILOT, "rear.rossystem": REAR}
    event("models" if survived(data, "robot.rossystem", beside=beside) else "error")


def test_parameters_have_no_constraints(tmp_path: Path) -> None:
    """The format has none, and none are made up."""
    made = node_lines(tmp_path, "parameters:\n  a: {type: Integer, value: 1}")
    assert made.node.parameters == (
        Parameter(
            "a",
            made.node.parameters[0].type,
            1,
            made.node.parameters[0].span,
            made.node.parameters[0].name_span,
        ),
    )
