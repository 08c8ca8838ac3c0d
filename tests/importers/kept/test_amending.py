"""What people write above the line, of a thing that is imported, takes its place."""

from __future__ import annotations

from pathlib import Path

import pytest

from deros.generators.output.writer import write
from deros.importers.kept.files import Renewed, joined, renewed
from deros.importers.kept.statements import statements
from deros.importers.results import Parts
from deros.live.snapshots import End, SeenNode, SeenParameter, Snapshot
from deros.metamodels.load import Repository
from deros.models.common import QosProfile
from deros.models.node import NodeType, ParameterType, Port, PortKind
from deros.models.system import NodeInstance, System, Topic
from tests.support.checks import checked
from tests.support.imported import described, import_into

NODE = Parts(
    'node base : unknown_package\n  executable "base"\n',
    """\
parameters
  name frame : string read_only "Of the odometry"
  name rate : double in [0.5, 40.0]

publishes
  topic odom : nav_msgs.Odometry qos best_effort volatile
  topic state : std_msgs.String qos reliable transient_local

subscribes
  topic /cmd_vel : geometry_msgs.Twist qos reliable volatile

services
  service ~/enable : std_srvs.SetBool

// parameter steps goes in steps of 2
""",
)
SYSTEM = Parts(
    "system robot\n",
    """\
argument speed : double = 1.0 "How fast"

topics
  external topic /scan : sensor_msgs.LaserScan qos best_effort  // 602 messages
  topic /odom : nav_msgs.Odometry

process view : "rviz2" arguments ["-d"]

node base : base
  parameters
    param rate = 2.0
    param frame = "odom"
  wirings
    connect odom to /odom

subsystem left namespace /left {
  node lidar : lidar  // it was inactive

  node camera : camera
}

subsystem right namespace /right {
  node lidar : lidar
}
""",
)


def amend(folder: Path, parts: Parts, own: str, name: str) -> Renewed:
    """Import again a file into whose upper part something was written."""
    (folder / name).write_text(joined(Parts(f"{parts.head}\n{own}", parts.body)), encoding="utf-8")
    new = renewed({name: parts}, folder)
    assert new.edited == ()
    write(new.files, folder)
    return new


def lower(new: Renewed) -> str:
    """Return the imported part of the only file."""
    (file,) = new.files.values()
    return file.text.partition("// digest: ")[2].partition("\n\n")[2]


def said(new: Renewed) -> list[str]:
    """Return what is listed, each with the line in its file."""
    return [f"{each.line}: {each.what} {each.why}" for each in new.otherwise]


# Node descriptions ------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("own", "gone"),
    [
        (
            "subscribes\n  topic /cmd_vel : geometry_msgs.Twist stops after 0.5 sec\n",
            "subscribes\n  topic /cmd_vel : geometry_msgs.Twist qos reliable volatile\n\n",
        ),
        (
            "subscribes topic cmd_vel : geometry_msgs.Twist\n",  # its node stands in the root
            "subscribes\n  topic /cmd_vel : geometry_msgs.Twist qos reliable volatile\n\n",
        ),
        (
            "publishes\n  topic odom : nav_msgs.Odometry qos sensor_data\n",
            "  topic odom : nav_msgs.Odometry qos best_effort volatile\n",
        ),
        (
            'parameters\n  name rate : double = 1.0 [Hz] in [0.5, 40.0] "Turns"\n',
            "  name rate : double in [0.5, 40.0]\n",
        ),
        (
            'services service ~/enable : std_srvs.SetBool "On"\n',
            "services\n  service ~/enable : std_srvs.SetBool\n\n",
        ),
    ],
)
def test_part_of_a_node_takes_the_place_of_the_imported_one(
    own: str, gone: str, tmp_path: Path
) -> None:
    """The rest stays, in its sections; what people say besides is theirs, and not listed."""
    new = amend(tmp_path, NODE, own, "base.rnd")
    assert gone in NODE.body
    assert lower(new) == NODE.body.replace(gone, "")
    assert said(new) == []
    assert checked(tmp_path / "base.rnd") == []


@pytest.mark.parametrize(
    ("own", "listed"),
    [
        (
            "subscribes topic /cmd_vel : geometry_msgs.TwistStamped\n",
            "4: subscriber /cmd_vel: topic /cmd_vel : geometry_msgs.Twist qos reliable volatile",
        ),
        (
            "publishes topic odom : nav_msgs.Odometry\n",
            "4: publisher odom: topic odom : nav_msgs.Odometry qos best_effort volatile",
        ),
        (
            "parameters\n  name rate : double\n",
            "5: parameter rate: name rate : double in [0.5, 40.0]",
        ),
        (
            'parameters name frame : string "Of the odometry"',
            '4: parameter frame: name frame : string read_only "Of the odometry"',
        ),
    ],
)
def test_what_people_lack_or_have_otherwise_is_listed(
    own: str, listed: str, tmp_path: Path
) -> None:
    """With its line: type, QoS, range and description."""
    assert said(amend(tmp_path, NODE, own, "base.rnd")) == [listed]


def test_ports_of_one_name_and_two_kinds_are_two(tmp_path: Path) -> None:
    """A publisher above is not the subscription below, and `x` is not `/x` where there are both."""
    body = (
        "publishes\n  topic x : std_msgs.Bool\n  topic /x : std_msgs.Bool\n\n"
        "subscribes\n  topic x : std_msgs.Bool\n"
    )
    parts = Parts(NODE.head, body)
    new = amend(tmp_path, parts, "publishes topic /x : std_msgs.Bool\n", "base.rnd")
    assert lower(new) == body.replace("  topic /x : std_msgs.Bool\n", "")


# Systems ----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("own", "gone", "listed"),
    [
        (
            'argument speed : double = 2.0 "How fast"',
            'argument speed : double = 1.0 "How fast"\n\n',
            ['3: argument speed: argument speed : double = 1.0 "How fast"'],
        ),
        (
            'topics external topic scan : sensor_msgs.LaserScan qos best_effort reliable "Front"',
            "  external topic /scan : sensor_msgs.LaserScan qos best_effort  // 602 messages\n",
            [],
        ),
        (
            "topics external topic /odom : nav_msgs.Odometry",
            "  topic /odom : nav_msgs.Odometry\n",
            ["3: topic /odom: topic /odom : nav_msgs.Odometry"],
        ),
        (
            'process view : "rviz2" arguments ["-d"] respawn',
            'process view : "rviz2" arguments ["-d"]\n\n',
            [],
        ),
        (
            "node base : base respawn\n  parameters\n    param rate = 3.0\n    param more = 1\n"
            '    param frame = "odom"\n  wirings connect odom to odom\n',
            'node base : base\n  parameters\n    param rate = 2.0\n    param frame = "odom"\n'
            "  wirings\n    connect odom to /odom\n\n",
            ["3: node base: param rate = 2.0"],
        ),
        (
            "node base : other_base",
            'node base : base\n  parameters\n    param rate = 2.0\n    param frame = "odom"\n'
            "  wirings\n    connect odom to /odom\n\n",
            [
                "3: node base: param rate = 2.0",
                '3: node base: param frame = "odom"',
                "3: node base: connect odom to /odom",
                "3: node base: node base : base",
            ],
        ),
        (
            "node lidar : lidar namespace /left respawn",
            "  node lidar : lidar  // it was inactive\n\n",
            [],
        ),
        (
            "subsystem other namespace right { node lidar : lidar }",
            "\nsubsystem right namespace /right {\n  node lidar : lidar\n}\n",
            [],
        ),
        (
            "subsystem left namespace /left { node lidar : radar }",
            "subsystem left namespace /left {\n  node lidar : lidar  // it was inactive\n\n"
            "  node camera : camera\n}\n\n",
            ["3: subsystem left: node camera : camera", "3: node lidar: node lidar : lidar"],
        ),
        (
            "subsystem left { node camera : camera  node lidar : lidar }",
            "subsystem left namespace /left {\n  node lidar : lidar  // it was inactive\n\n"
            "  node camera : camera\n}\n\n",
            ["3: subsystem left: subsystem left namespace /left"],
        ),
        (
            'process left : "left"',
            "subsystem left namespace /left {\n  node lidar : lidar  // it was inactive\n\n"
            "  node camera : camera\n}\n\n",
            [
                "3: process left: subsystem left namespace /left",
                "3: process left: node lidar : lidar",
                "3: process left: node camera : camera",
            ],
        ),
    ],
)
def test_part_of_a_system_takes_the_place_of_the_imported_one(
    own: str, gone: str, listed: list[str], tmp_path: Path
) -> None:
    """A node by its name in the graph, wherever it stands; all that a subsystem lacks is listed."""
    new = amend(tmp_path, SYSTEM, own, "robot.system")
    assert gone in SYSTEM.body
    assert lower(new).strip() == SYSTEM.body.replace(gone, "").strip()
    assert sorted(said(new)) == sorted(listed)


@pytest.mark.parametrize(
    ("rate", "is_other"),
    [("rate 9 Hz", False), ("rate 11.5 Hz", False), ("rate 7 Hz", True), ("", True)],
)
def test_measured_rates_are_never_quite_the_same(rate: str, is_other: bool, tmp_path: Path) -> None:
    """One that is a fifth off is the same one."""
    parts = Parts("system robot\n", "topics\n  external topic /a : std_msgs.Bool rate 10 Hz\n")
    own = f"topics external topic /a : std_msgs.Bool {rate}\n"
    assert bool(said(amend(tmp_path, parts, own, "robot.system"))) is is_other


def test_settings_of_a_group_may_follow_members_of_the_upper_part(tmp_path: Path) -> None:
    """As an import of a launch file writes them; behind a member of their own part they may not."""
    body = 'parameters from "p.yaml"\n\nenv X = "1"\n\nprocess view : "rviz2"\n'
    (tmp_path / "p.yaml").write_text("/**: {ros__parameters: {use_sim_time: false}}\n")
    amend(tmp_path, Parts("system robot\n", body), 'process bag : "ros2"\n', "robot.system")
    assert checked(tmp_path / "robot.system") == []
    amend(tmp_path, Parts("system robot\n", f"{body}\nenv Y = '2'\n"), "", "robot.system")
    assert [each.code.name for each in checked(tmp_path / "robot.system")] != []


# All of it --------------------------------------------------------------------------------------

SEEN = QosProfile(reliability="best_effort", durability="transient_local")


def robot() -> Snapshot:
    """Return a graph with every kind of end, parameters and namespaces."""
    ends = tuple(
        End(kind, f"/left/{kind.name.lower()}_{number}", of_type, qos)
        for number in range(2)
        for kind, of_type, qos in (
            (PortKind.PUBLISHER, "std_msgs/msg/Bool", SEEN),
            (PortKind.SUBSCRIPTION, "std_msgs/msg/Bool", SEEN),
            (PortKind.SERVICE, "std_srvs/srv/Trigger", None),
            (PortKind.CLIENT, "std_srvs/srv/Trigger", None),
            (PortKind.ACTION, "example_interfaces/action/Fibonacci", None),
            (PortKind.ACTION_CLIENT, "example_interfaces/action/Fibonacci", None),
        )
    )
    parameters = (
        SeenParameter("rate", ParameterType.DOUBLE, 2.0, description="Turns"),
        SeenParameter("frame", ParameterType.STRING, "a"),
    )
    return Snapshot(
        (
            SeenNode("/left/arm", ends, parameters),
            SeenNode("/pilot", (End(PortKind.PUBLISHER, "/beat", "std_msgs/msg/Bool", SEEN),), ()),
        )
    )


def _moved(path: Path) -> list[str]:
    """Return all that is imported into a file, each as people would write it above."""
    model = Repository().load(path).model
    assert isinstance(model, NodeType | System)
    found = []
    for each in statements(model):
        section = {Port: getattr(getattr(each.part, "kind", None), "value", ""), Topic: "topics"}
        word = section.get(type(each.part), "")
        if each.what.startswith("parameter "):
            word = "parameters"
        text = each.span.text
        if isinstance(each.part, NodeInstance) and each.namespace != "/":
            text = text.replace("\n", f" namespace {each.namespace}\n", 1)
        found.append(f"{word}\n{text}\n")
    return found


@pytest.mark.parametrize("name", ["nodes/arm.rnd", "nodes/pilot.rnd", "robot.system"])
def test_what_is_moved_above_changes_nothing(name: str, tmp_path: Path) -> None:
    """Each statement by itself: the system is the same, nothing is listed, nothing is twice."""
    import_into(tmp_path, robot())
    before = described(tmp_path / "robot.system")
    path = tmp_path / name
    text = path.read_text(encoding="utf-8")
    moved = _moved(path)
    assert moved
    for own in moved:
        path.write_text(text.replace("// Imported", f"{own}\n// Imported", 1), encoding="utf-8")
        assert any(each.is_error for each in checked(tmp_path / "robot.system")), own
        import_into(tmp_path, robot())
        assert described(tmp_path / "robot.system") == before
        assert [e.message for e in checked(tmp_path / "robot.system") if e.is_error] == [], own
        states = {each: each.stat().st_mtime_ns for each in tmp_path.rglob("*")}
        import_into(tmp_path, robot())
        assert {each: each.stat().st_mtime_ns for each in tmp_path.rglob("*")} == states
        path.write_text(text, encoding="utf-8")
    import_into(tmp_path, robot())
    assert path.read_text(encoding="utf-8") == text


def test_cut_from_below_and_pasted_above_is_no_edit(tmp_path: Path) -> None:
    """As long as the rest is what the import writes; with other changes it is one."""
    line = "  topic odom : nav_msgs.Odometry qos best_effort volatile\n"
    path = tmp_path / "base.rnd"
    own = f"publishes\n{line}"
    cut = joined(Parts(f"{NODE.head}\n{own}", NODE.body))
    head, mark, body = cut.partition("// digest")
    path.write_text(f"{head}{mark}{body.replace(line, '')}", encoding="utf-8")
    new = renewed({"base.rnd": NODE}, tmp_path)
    assert (new.edited, new.otherwise) == ((), ())
    assert lower(new) == NODE.body.replace(line, "")
    other = body.replace(line, "").replace("std_srvs.SetBool", "std_srvs.Trigger")
    path.write_text(f"{head}{mark}{other}", encoding="utf-8")
    assert renewed({"base.rnd": NODE}, tmp_path).edited == ("base.rnd",)


def test_upper_part_with_faults_takes_no_place(tmp_path: Path) -> None:
    """What cannot be read is nobody's word for something; the rest of the upper part counts."""
    own = "publishes\n  topic odom : : nav_msgs.Odometry\nservices service ~/enable : a.B\n"
    new = amend(tmp_path, NODE, own, "base.rnd")
    assert "topic odom" in lower(new)
    assert "~/enable" not in lower(new)
    assert said(new) == ["6: service ~/enable: service ~/enable : std_srvs.SetBool"]
