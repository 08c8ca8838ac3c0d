"""The listings of the paper that deros comes from, as printed there.

Where a listing prints an ellipsis, it is cut, or the lines that belong there stand between
``FILLED`` comments. Section and figure numbers are those of "Rule-based Dynamic Safety Monitoring
for Mobile Robots".
"""

from __future__ import annotations

from pathlib import Path

FIGURE_2 = """\
use "RobotSafety.system" import RobotSafety

action stop;
const max_tilt = toRad(10 deg)
const max_speed = 0.5 m/s
input orientation = topic /fmInformation/imu.orientation
input linear_speed = topic /fmKnowledge/encoder_odom.twist.twist.linear.x

entity imu_sensor_system
{
  tilt_not_ok:
    orientation.roll() not in [-max_tilt, max_tilt] or
    orientation.pitch() not in [-max_tilt, max_tilt];
}

entity drive_system
{
  max_speed_exceeded: linear_speed > max_speed for 2 sec;
}

if imu_sensor_system.tilt_not_ok then { stop; };

if drive_system.max_speed_exceeded for 0.4 sec then {stop; };
"""

SECTION_4_2 = """\
use "RobotSafety.system" import RobotSafety

action stop;

const max_tilt = toRad(10 deg)
const max_speed = 0.5 m/s

input orientation =
  topic /fmInformation/imu.orientation
// FILLED
input linear_speed = topic /fmKnowledge/encoder_odom.twist.twist.linear.x
// FILLED

entity imu_sensor_system {
  tilt_not_ok:
    orientation.roll()
    not in [-max_tilt, max_tilt] or
    // FILLED
    orientation.pitch() not in [-max_tilt, max_tilt];
}
    // FILLED

entity drive_system {
  max_speed_exceeded:
    linear_speed > max_speed for 2 sec;
}

if imu_sensor_system.tilt_not_ok
  for 0.4 sec then { stop; };
if drive_system.max_speed_exceeded
  then { stop; };
"""

FIGURE_9 = """\
// FILLED
use "RobotSafety.system" import RobotSafety
action stop;
// FILLED
const max_speed = 0.5 m/s

input linear_speed =topic
  /fmKnowledge/encoder_odom.
  twist.twist.linear.x

entity drive_system {
  max_speed_exceeded :
  linear_speed > max_speed
  for 2 sec;
// FILLED
}
// FILLED

if drive_system.max_speed_exceeded
  then
  {
    stop;
  };
"""

FIGURE_11 = """\
node ci_safety_node : ci_safety

parameters
  name time_update_freq : double = 10.0
  name publish_freq : double = 10.0
  name upside_down : bool = false

publishes
  topic stop_robot : std_msgs.Bool

subscribes
  topic /fmInformation/imu : sensor_msgs.Imu
  topic /fmKnowledge/encoder_odom :
    nav_msgs.Odometry
"""

FIGURE_12 = """\
system RobotSafety

imports
  import "vectornav_vn100_node.rnd"
  import "differential_odometry_node.rnd"
  // FILLED
  import "ci_safety_node.rnd"
  import "plc_node.rnd"
  // FILLED
topics
  topic /fmInformation/imu
  topic /fmKnowledge/encoder_odom
  // FILLED
  external topic /plc/state
  topic /stop_robot
  // FILLED
subsystem Safety
{
  subsystem fmSensors
  {
    node vectornav_vn100:vectornav_vn100_node
    parameters
      param publish_topic_id =
        "/fmInformation/imu"
      param frame_id = "imu_link"
    wirings
      connect publish_topic_id to
        /fmInformation/imu
  }

  subsystem fmProcessors
  {
    // FILLED
    node plc : plc_node
    wirings
      connect state to /plc/state
      connect stop_robot to /stop_robot
    node ci_safety : ci_safety_node
    wirings
      connect /fmInformation/imu to /fmInformation/imu
      connect fmKnowledge/encoder_odom to /fmKnowledge/encoder_odom
      connect stop_robot to /stop_robot
    // FILLED
    node differential_odometry : odometry_node
    wirings
      connect odom_pub to
        /fmKnowledge/encoder_odom
  }
}
"""

SECTION_6_3 = """\
// FILLED
use "RobotSafety.system" import RobotSafety
// FILLED
action low_speed;
action stop;
action motor_stop;
action controllerOk;

const max_tilt_neg = toRad(-8 deg)
const max_tilt_pos = toRad(8 deg)
const danger_tilt_neg = toRad(-10.0 deg)
const danger_tilt_pos = toRad(10.0 deg)

// FILLED
input orientation = topic /fmInformation/imu.orientation
input speed = topic /fmKnowledge/encoder_odom.twist.twist.linear.x
input plc = topic /plc/state.data
// FILLED

entity imu_sensor_system {
  tilt_not_ok:
    ((orientation.pitch() not in
      [max_tilt_neg , max_tilt_pos])
    or (orientation.roll() not in
      [max_tilt_neg , max_tilt_pos])) for 4sec;

  rollover_imminent:
    ((orientation.pitch() not in
      [danger_tilt_neg , danger_tilt_pos])
    or (orientation.roll() not in
      [danger_tilt_neg , danger_tilt_pos]));
}

// FILLED
entity drive_system { moving: speed not in [-0.05 m/s, 0.05 m/s]; fast: speed > 0.5 m/s; }
entity PLC_system {
  stop_button_activated: plc in [5, 6];
  manual_mode: plc = 2;
  learn_mode: plc in [3, 5];
  auto_mode: plc in [6, 8];
}
if drive_system.fast then { low_speed; };
// FILLED

//tilt limit exceeded
if((imu_sensor_system.tilt_not_ok
  and drive_system.moving
  and PLC_system.auto_mode)
  or imu_sensor_system.rollover_imminent) then

{ motor_stop; stop;
  log_state("motor stop: max tilt exceeded");
};

//stop button activated
if(PLC_system.stop_button_activated
  and (PLC_system.auto_mode
  or PLC_system.learn_mode)) then
{ motor_stop; stop;
  log_state("motor stop: stop button activated");
};

if( PLC_system.manual_mode) then
{ controllerOk;
  log_state("safety: manual mode");
};
"""

_IMU = """\
node vectornav_vn100_node : vectornav_vn100
parameters
  name publish_topic_id : string = "imu"
  name frame_id : string = "base_link"
publishes
  topic imu : sensor_msgs.Imu via publish_topic_id
"""

_ODOMETRY = """\
node odometry_node : differential_odometry
publishes
  topic odom_pub : nav_msgs.Odometry
"""

_PLC = """\
node plc_node : plc_bridge
publishes
  topic state : std_msgs.UInt8
subscribes
  topic stop_robot : std_msgs.Bool
"""

RULES = {
    "figure_2": FIGURE_2,
    "section_4_2": SECTION_4_2,
    "figure_9": FIGURE_9,
    "section_6_3": SECTION_6_3,
}
"""The DeRoS programs, by where they stand."""


def write_system(directory: Path) -> Path:
    """Write the system of figure 12 with the node types that it imports; return its path."""
    files = {
        "vectornav_vn100_node.rnd": _IMU,
        "differential_odometry_node.rnd": _ODOMETRY,
        "ci_safety_node.rnd": FIGURE_11,
        "plc_node.rnd": _PLC,
        "RobotSafety.system": FIGURE_12,
    }
    for name, text in files.items():
        (directory / name).write_text(text, encoding="utf-8")
    return directory / "RobotSafety.system"
