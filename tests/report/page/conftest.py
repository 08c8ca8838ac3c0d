"""A system whose page has everything."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser

from deros.diagnostics import Diagnostic
from deros.models.system import System
from deros.pipeline.workspace import check_one
from tests.support.browser import browser

LIDAR = """
node lidar : lidar_driver "Reads the laser </script><img src=x onerror=alert(1)>"
parameters
  name rate : double = 20.0 [Hz] in [1.0, 100.0]
  name frame : string = "laser"
  name hosts : string[] = ["a"]
publishes
  topic scan : sensor_msgs.LaserScan { ranges [m] } qos best_effort depth 5
"""
SLAM = """
node slam : slam_toolbox lifecycle
publishes
  topic map : nav_msgs.OccupancyGrid qos reliable transient_local depth 1
subscribes
  topic scan : sensor_msgs.LaserScan qos reliable
services
  service save : std_srvs.Trigger
"""
DRIVE = """
node drive : base_driver
parameters
  name limit : double = 0.5 [m/s]
publishes
  topic odom : nav_msgs.Odometry
subscribes
  topic cmd_vel : geometry_msgs.Twist
clients
  client save : std_srvs.Trigger
"""
SYSTEM = """\
system Courier "Carries <b>parcels</b>"
argument robot : string = "courier" "Whose topics"
argument slam : bool = true
argument mode : string = "auto" one_of ["auto", "hand"]
argument speed : double = 0.5 [m/s] in [0.1, 2.0)
argument times : int = 2
imports
  import "*.rnd"
topics
  external topic "/${robot}/cmd_vel" : geometry_msgs.Twist "From the operator"
  topic /unused when mode = "hand"
subsystem Sensors namespace $robot {
  node lidar : lidar
  parameters
    param frame = "${robot}_laser"
    param hosts = [$robot, "${env(HOST, here)}"]
  process recorder : "ros2" arguments ["bag", "record", "-a"] when mode = "hand"
}
subsystem Drive namespace $robot "Moves" {
  node drive : drive
  parameters
    param limit = $speed * $times
  wirings
    connect save to /slam/save
  subsystem Mapping when slam and mode != "hand" {
    node slam : slam
    wirings
      connect scan to scan
      connect save to /slam/save
  }
}
"""


@pytest.fixture
def courier(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> tuple[System, list[Diagnostic]]:
    """Return the system with its findings; its files are in the working folder."""
    monkeypatch.chdir(tmp_path)
    for name, text in (("lidar", LIDAR), ("slam", SLAM), ("drive", DRIVE)):
        Path(f"{name}.rnd").write_text(text)
    Path("courier.system").write_text(SYSTEM)
    loaded, findings = check_one("courier.system", ())
    assert isinstance(loaded.model, System)
    return loaded.model, findings


@pytest.fixture(scope="module")
def chromium() -> Iterator[Browser]:
    """Run the browser for the tests of a module."""
    with browser() as program:
        yield program
