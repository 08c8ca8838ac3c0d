"""The safety node whose cost is measured, made from rules by ``deros generate``."""

from __future__ import annotations

import sys
from pathlib import Path

from support.processes import run

TOPICS = ("imu", "odometry", "scan", "rear_scan", "stop", "slow", "go")
"""The topics of the safety node, without the leading slash."""

_DRIVER = """\
node sensors : cost_sensors "Publishes what the robot senses"
publishes
  topic imu : sensor_msgs.Imu qos best_effort depth 10
  topic odometry : nav_msgs.Odometry qos best_effort depth 10
  topic scan : sensor_msgs.LaserScan qos best_effort depth 10
  topic rear_scan : sensor_msgs.LaserScan qos best_effort depth 10
subscribes
  topic stop : std_msgs.Bool
  topic slow : std_msgs.Bool
  topic go : std_msgs.Bool
"""

_SYSTEM = """\
system Cost
imports
  import "sensors.rnd"
topics
  topic /imu
  topic /odometry
  topic /scan
  topic /rear_scan
  topic /stop
  topic /slow
  topic /go
node sensors : sensors
  wirings
    connect imu to /imu
    connect odometry to /odometry
    connect scan to /scan
    connect rear_scan to /rear_scan
    connect stop to /stop
    connect slow to /slow
    connect go to /go
"""

_RULES = """\
use "cost.system" import Cost
action stop publishes true on /stop : std_msgs.Bool latched
action slow publishes true on /slow : std_msgs.Bool reset_by go_on
action go_on publishes true on /go : std_msgs.Bool reset_by slow
input orientation = topic /imu.orientation timeout 0.5 sec
input turn = topic /imu.angular_velocity timeout 0.5 sec
input speed = topic /odometry.twist.twist.linear.x timeout 0.5 sec
input scan = topic /scan timeout 0.5 sec
input rear_scan = topic /rear_scan
entity body {
  tilted: (orientation.roll() not in [-8 deg, 8 deg] or
           orientation.pitch() not in [-8 deg, 8 deg]) for 4 sec;
  rolling_over: orientation.roll() not in [-20 deg, 20 deg] or
                orientation.pitch() not in [-20 deg, 20 deg];
  spinning: turn.norm() > 90 deg/s for 0.4 sec;
  silent: orientation.missing();
}
entity drive {
  stopped: speed in [-0.05, 0.05];
  moving: speed not in [-0.05, 0.05];
  fast: (speed > 0.5 m/s for 4 sec) or (speed < -0.25 m/s for 2 sec);
  too_fast: speed > 1.0 m/s or speed < -0.4 m/s;
  silent: speed.missing();
}
entity surroundings {
  clear: scan.nearest(-30 deg, 30 deg) >= 4.0;
  far: scan.nearest(-30 deg, 30 deg) in [2.0, 4.0);
  near: scan.nearest(-30 deg, 30 deg) < 2.0;
  behind: rear_scan.nearest(-30 deg, 30 deg) < 1.0;
  silent: scan.missing();
}
behaviour tilt: if body.tilted and drive.moving or body.rolling_over then { stop; };
behaviour spin: if body.spinning then { stop; };
behaviour speed_limit: if drive.too_fast or drive.fast then { stop; };
behaviour keep_off: if surroundings.near and drive.moving then { stop; };
behaviour back_off: if surroundings.behind and drive.moving then { stop; };
behaviour slow_down: if surroundings.far and drive.moving then { slow; };
behaviour free: if surroundings.clear and not drive.stopped then { go_on; };
behaviour lost: if body.silent or drive.silent or surroundings.silent then { slow; };
"""


def generate(folder: Path) -> Path:
    """Generate the safety node; return the folder of its package, ``cost_safety``.

    Its node and module are ``cost_safety_node``.

    Raises:
        ProcessError: if deros refuses the rules.
    """
    models = folder / "models"
    models.mkdir()
    (models / "sensors.rnd").write_text(_DRIVER, encoding="utf-8")
    (models / "cost.system").write_text(_SYSTEM, encoding="utf-8")
    rules = models / "cost.deros"
    rules.write_text(_RULES, encoding="utf-8")
    deros = [sys.executable, "-c", "from deros.cli.main import main; main()"]
    run([*deros, "generate", str(rules), "--target", "python", "--output", str(folder)])
    return folder / "cost_safety"
