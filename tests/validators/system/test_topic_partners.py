"""Topics that lack an end: which partners are suggested, and which are not."""

from __future__ import annotations

from pathlib import Path

import pytest

from deros.diagnostics import Diagnostic
from tests.support.checks import checked

IMU = """\
node driver : demo publishes topic data : sensor_msgs.Imu topic bias : sensor_msgs.Imu
node compass : demo subscribes topic in : sensor_msgs.Imu
node filter : demo subscribes topic in : sensor_msgs.Imu publishes topic out : sensor_msgs.Imu
node text : demo publishes topic out : std_msgs.String
"""


def _check(folder: Path, system: str) -> list[Diagnostic]:
    for line in IMU.splitlines():
        name = line.split()[1]
        (folder / f"{name}.rnd").write_text(f"{line}\n")
    path = folder / "demo.system"
    path.write_text(f'system Demo\nimports import "*.rnd"\n{system}')
    return checked(path)


def _likely(findings: list[Diagnostic]) -> list[Diagnostic]:
    return [finding for finding in findings if finding.code.name == "DRS214"]


def test_topic_already_in_use_is_suggested(tmp_path: Path) -> None:
    """The right topic may have readers; a free topic with another word is not suggested."""
    (finding,) = _likely(
        _check(
            tmp_path,
            """\
topics topic /imu/data topic /imu/data/bias topic /imu/data_compass
node driver : driver wirings connect data to /imu/data connect bias to /imu/data/bias
node filter : compass wirings connect in to /imu/data
node compass : compass wirings connect in to /imu/data_compass
""",
        )
    )
    assert finding.message.startswith("no node publishes '/imu/data_compass', but '/imu/data'")
    assert finding.hint == "connect /compass to '/imu/data'"


def test_unread_topics_are_suggested_first(tmp_path: Path) -> None:
    """Up to three are named; an unread topic comes before an equally likely one with readers."""
    (finding,) = _likely(
        _check(
            tmp_path,
            """\
topics topic /imu_a topic /a/imu topic /b/imu topic /imu external topic /bias
node a : driver wirings connect data to /imu_a connect bias to /a/imu
node b : driver wirings connect data to /b/imu connect bias to /bias
node r : compass wirings connect in to /a/imu
node s : compass wirings connect in to /imu
""",
        )
    )
    assert finding.hint == "connect /s to '/b/imu', '/a/imu' or '/imu_a', or the other way round"


def test_ends_of_the_same_node_are_not_joined(tmp_path: Path) -> None:
    """A filter does not read its own output, however similar the names."""
    system = """\
topics topic /scan topic /scan_filtered
node filter : filter wirings connect in to /scan connect out to /scan_filtered
"""
    findings = _check(tmp_path, system)
    assert [finding.code.name for finding in findings] == ["DRS210", "DRS211"]
    assert all("/scan" not in finding.hint for finding in findings)


@pytest.mark.parametrize("left", ["left", "robot1/base"])
@pytest.mark.parametrize("right", ["right", "robot2/base"])
def test_topics_of_different_robots_are_not_joined(tmp_path: Path, left: str, right: str) -> None:
    """A reader on one robot is not paired with a publisher on the other."""
    system = f"""\
topics topic /{left}/imu topic /{right}/imu external topic /bias
subsystem left namespace /{left} {{ node driver : driver
  wirings connect data to imu connect bias to /bias }}
subsystem right namespace /{right} {{
  node driver : driver wirings connect data to /bias connect bias to /bias
  node compass : compass wirings connect in to imu }}
"""
    findings = _check(tmp_path, system)
    assert sorted(finding.code.name for finding in findings) == ["DRS210", "DRS211"]
    assert all("imu" not in finding.hint for finding in findings)


def test_topic_of_another_type_is_not_suggested(tmp_path: Path) -> None:
    """Connecting it would be an error."""
    system = """\
topics topic /imu/data topic /imu/dta
node text : text wirings connect out to /imu/data
node compass : compass wirings connect in to /imu/dta
"""
    assert _likely(_check(tmp_path, system)) == []


def test_unread_publisher_gets_a_topic_with_readers_as_hint(tmp_path: Path) -> None:
    """The hint covers a controller that publishes past its drive."""
    system = """\
topics topic /imu/data topic /imu/dta external topic /bias
node good : driver wirings connect data to /imu/data connect bias to /bias
node reader : compass wirings connect in to /imu/data
node wrong : driver wirings connect data to /imu/dta connect bias to /bias
"""
    (finding,) = _check(tmp_path, system)
    assert finding.code.name == "DRS211"
    assert finding.hint.startswith("did you mean '/imu/data'?")


def test_missing_end_in_a_system_used_twice_is_reported_once(tmp_path: Path) -> None:
    """The port is written once, however often its node runs."""
    (tmp_path / "part.system").write_text(
        'system Part imports import "compass.rnd"\nnode compass : compass\n'
    )
    system = """\
import "part.system"
subsystem left : Part namespace /left
subsystem right : Part namespace /right
"""
    findings = [each for each in _check(tmp_path, system) if each.code.name == "DRS213"]
    assert [finding.span.text for finding in findings] == ["compass"]


def test_misspelt_transform_topic_is_reported(tmp_path: Path) -> None:
    """Readers of transforms are in no model, but transforms belong on one topic."""
    node = 'node program : demo executable "program" publishes topic {} : tf2_msgs.TFMessage\n'
    for name, expected in (("/tf", []), ("/ft", ["DRS213"])):
        folder = tmp_path / name.strip("/")
        folder.mkdir()
        (folder / "program.rnd").write_text(node.format(name))
        findings = _check(folder, "node program : program\n")
        assert [finding.code.name for finding in findings] == expected


def test_program_output_is_matched_with_unpublished_external_topics(tmp_path: Path) -> None:
    """The output may have been meant for a topic that leaves the model."""
    (tmp_path / "program.rnd").write_text(
        'node program : demo executable "program" publishes topic maps : nav_msgs.OccupancyGrid\n'
    )
    system = "topics external topic /robot/map : nav_msgs.OccupancyGrid\n"
    findings = _check(tmp_path, f"{system}node program : program namespace /robot\n")
    assert [finding.code.name for finding in findings] == ["DRS213"]
    other = system.replace("/robot/map", "/robot/costs")
    assert _check(tmp_path, f"{other}node program : program namespace /robot\n") == []
