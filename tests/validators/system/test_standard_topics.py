"""Standard topics whose other ends are in no model: not reported as dangling, types checked."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from deros.diagnostics import Diagnostic
from deros.interfaces import standard_topics
from deros.interfaces.standard_topics import standard_topic
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import InterfaceType
from tests.support.checks import checked

TABLE = Path(standard_topics.__file__).with_name("standard_topics.json")


def _type(text: str) -> InterfaceType:
    package, name = text.replace("/", ".").split(".")
    return InterfaceType(package, "msg", name)


def _check(folder: Path, ports: str, system: str = "") -> list[Diagnostic]:
    (folder / "user.rnd").write_text(f"node user : demo {ports}\n")
    path = folder / "demo.system"
    path.write_text(f'system Demo\nimports import "user.rnd"\n{system or "node user : user"}\n')
    return checked(path, store=InterfaceStore())


@pytest.mark.parametrize(
    ("name", "kind"),
    [
        ("/tf", "tf2_msgs.TFMessage"),
        ("/tf_static", "tf2_msgs.TFMessage"),
        ("/robot1/tf", "tf2_msgs.TFMessage"),
        ("/clock", "rosgraph_msgs.Clock"),
        ("/rosout", "rcl_interfaces.Log"),
        ("/parameter_events", "rcl_interfaces.ParameterEvent"),
        ("/diagnostics", "diagnostic_msgs.DiagnosticArray"),
        ("/robot1/diagnostics", "diagnostic_msgs.DiagnosticArray"),
        ("/robot1/robot_description_semantic", "std_msgs.String"),
        ("/robot_description", "std_msgs.String"),
        ("/lidar/transition_event", "lifecycle_msgs.TransitionEvent"),
        ("/dock/_action/status", "action_msgs.GoalStatusArray"),
        ("/dock/_action/feedback", "example_interfaces.Int32"),
        ("/camera/image_raw/compressed", "sensor_msgs.CompressedImage"),
        ("/camera/image_raw/compressedDepth", "sensor_msgs.CompressedImage"),
        ("/global_costmap/costmap_updates", "map_msgs.OccupancyGridUpdate"),
        ("/points/draco", "point_cloud_interfaces.CompressedPointCloud2"),
        ("/goal_pose", "geometry_msgs.PoseStamped"),
        ("/bond", "bond.Status"),
    ],
)
def test_standard_topics_are_external(tmp_path: Path, name: str, kind: str) -> None:
    """One end suffices, whether or not the topic is declared or connected."""
    missing = {"DRS101", "DRS102"}  # some of the packages may not be installed
    wired = f"node user : user wirings connect {name} to {name}"
    for section in ("publishes", "subscribes"):
        port = f"{section} topic {name} : {kind}"
        for system in ("", wired, f"topics topic {name}\n{wired}"):
            codes = {each.code.name for each in _check(tmp_path, port, system)}
            assert codes <= missing, (section, system)


def test_topic_of_another_type_is_not_standard(tmp_path: Path) -> None:
    """A topic in a namespace may have the same name and another type."""
    findings = _check(tmp_path, "publishes topic /air/tf : std_msgs.Bool")
    assert [each.code.name for each in findings] == ["DRS213"]


@pytest.mark.parametrize("name", ["/tf", "/clock", "/rosout", "/parameter_events"])
def test_wrong_type_on_a_standard_topic_is_an_error(tmp_path: Path, name: str) -> None:
    """It is the only finding, whatever the system declares."""
    port = f"publishes topic {name} : std_msgs.String"
    wired = f"node user : user wirings connect {name} to {name}"
    for system in ("", wired, f"topics external topic {name}\n{wired}"):
        codes = [each.code.name for each in _check(tmp_path, port, system)]
        assert [code for code in codes if code != "DRS213"] == ["DRS232"], system
    pinned = f"topics topic {name} : std_msgs.String\n{wired}"
    codes = [each.code.name for each in _check(tmp_path, port, pinned)]
    assert codes == ["DRS232", "DRS232"]


def test_declared_type_overrides_a_convention(tmp_path: Path) -> None:
    """No client library depends on the type of /diagnostics."""
    port = "publishes topic /diagnostics : std_msgs.String"
    system = "topics external topic /diagnostics : std_msgs.String\n"
    system += "node user : user wirings connect /diagnostics to /diagnostics"
    assert _check(tmp_path, port, system) == []
    assert [each.code.name for each in _check(tmp_path, port)] == ["DRS213", "DRS232"]


def test_markers_need_a_publisher_but_no_reader(tmp_path: Path) -> None:
    """Marker topics are read by tools."""
    kind = "visualization_msgs.MarkerArray"
    wired = "topics topic /markers\nnode user : user wirings connect m to /markers"
    assert _check(tmp_path, f"publishes topic m : {kind}", wired) == []
    findings = _check(tmp_path, f"subscribes topic m : {kind}", wired)
    assert [each.code.name for each in findings] == ["DRS210"]


def test_interactive_markers_need_no_partners(tmp_path: Path) -> None:
    """Neither updates nor feedback of a marker server need another end, wired or not."""
    ports = """
    publishes topic marker/update : visualization_msgs.InteractiveMarkerUpdate
    subscribes topic marker/feedback : visualization_msgs.InteractiveMarkerFeedback
    """
    wired = """
    topics topic /update topic /feedback
    node user : user wirings connect marker/update to /update connect marker/feedback to /feedback
    """
    assert _check(tmp_path, ports) == []
    assert _check(tmp_path, ports, wired) == []


def test_each_standard_topic_has_a_reason() -> None:
    """Each entry has a reason, and its types are interface names."""
    table = json.loads(TABLE.read_text(encoding="utf-8"))
    for entry in (*table["topics"], *table["derived"], table["shown"], table["operated"]):
        assert len(entry["why"]) > 20
        assert all(kind.count("/") == 1 for kind in entry["types"])
        if "name" in entry and entry["types"]:
            standard = standard_topic(entry["name"], _type(entry["types"][0]))
            assert standard is not None
            assert standard.why == entry["why"]
