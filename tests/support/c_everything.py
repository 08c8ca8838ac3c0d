"""Rules with every construct that the monitor in C can be asked for."""

from __future__ import annotations

import functools
import tempfile
from collections.abc import Mapping
from pathlib import Path

from deros.diagnostics import has_errors
from deros.generators.monitor.c.interface import render_monitor
from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from deros.models.rules import Rules
from deros.rules.compiler.build import build
from deros.rules.program.ir import Program
from tests.support.examples import EXAMPLES

_TOPICS = {
    "/odom": "nav_msgs.Odometry",
    "/imu": "sensor_msgs.Imu",
    "/scan": "sensor_msgs.LaserScan",
    "/joints": "sensor_msgs.JointState",
    "/battery": "sensor_msgs.BatteryState",
    "/diagnostics": "diagnostic_msgs.DiagnosticArray",
    "/mode": "std_msgs.UInt8",
    "/state": "std_msgs.String",
    "/flag": "std_msgs.Bool",
    "/beats": "std_msgs.UInt64",
    "/ticks": "std_msgs.Int64",
    "/levels": "std_msgs.Int16MultiArray",
    "/counters": "std_msgs.UInt64MultiArray",
}

NODE = "node robot : robot\npublishes\n" + "".join(
    f"  topic {topic} : {kind}\n" for topic, kind in _TOPICS.items()
)
SYSTEM = (
    'system Robot\nimports\n  import "robot.rnd"\ntopics\n'
    + "".join(f"  topic {topic}\n" for topic in _TOPICS)
    + "subsystem Base {\n  node robot : robot\n  wirings\n"
    + "".join(f"    connect {topic} to {topic}\n" for topic in _TOPICS)
    + "}\n"
)

RULES = """\
use "robot.system" import Robot
action stop publishes true on /stop : std_msgs.Bool reset_by ok
action motor_stop publishes true on /motor_stop : std_msgs.Bool latched
action horn publishes true on /horn : std_msgs.Bool latched
action ok reset_by stop
action beep(times, text, loud, pitch)
const max_speed = 0.5 m/s
input speed = topic /odom.twist.twist.linear.x timeout 0.5 sec
input height = topic /odom.pose.pose.position.z
input attitude = topic /imu.orientation timeout 0.1 sec
input turn = topic /imu.angular_velocity
input scan = topic /scan timeout 0.2 sec
input mud = topic /scan no_return 0 timeout 0.2 sec
input positions = topic /joints.position
input names = topic /joints.name
input elbow = topic /joints.velocity[2] timeout 1 sec
input cells = topic /battery.cell_voltage
input first = topic /diagnostics.status[0].name
input level = topic /diagnostics.status[1].level timeout 2 sec
input mode = topic /mode.data
input state = topic /state.data timeout 3 sec
input enabled = topic /flag.data
input beats = topic /beats.data on_second_publisher unknown timeout 0.3 sec
input ticks = topic /ticks.data
input levels = topic /levels.data
input counters = topic /counters.data
input place = topic /odom.pose.pose.position
input rear = topic /scan mounted (-0.2, 0, 0.1) m yaw 135 deg timeout 0.2 sec
zone yard = polygon (0, 0) (4, 0) (4, 3) (2.5, 1.5) (0, 3) m "where it drives"
zone pit = circle (1, -0.5) 25 cm
zone behind = rectangle (-1, -0.4) (-0.3, 0.4) m
entity drive {
  too_fast: speed > max_speed for 2 sec;
  jerky: speed.rate() > 2 and not enabled;
  climbing: (height.rate().abs() >= 0.1 or height.rate(1 sec) > 0.5) for 0.5 sec;
  old: scan.latency() not in [0 sec, 0.2 sec] or cells.latency().previous() > 1 sec;
  silent: speed.missing() or scan.age() > 1 sec or elbow.missing() or beats.age() >= 0.1 sec;
  seldom: scan.frequency(3) < 8 Hz or mode.frequency(2) not in [1 Hz, 50 Hz);
}
entity body {
  tilted: attitude.roll() not in [-10 deg, 10 deg] or
          attitude.pitch() not in [-10 deg, 10 deg);
  turned: attitude.yaw() > 90 deg or attitude.tilt() > 5 deg;
  turning: turn.norm() >= 90 deg/s or attitude.yaw().rate() > 2 or
           attitude.yaw().rate(0.5 sec) < -2;
  near: scan.nearest(-30 deg, 30 deg) < 0.4 or mud.nearest(150 deg, -150 deg) < 0.2;
  dirty: mud.blind(150 deg, -150 deg) > 20 % or scan.blind_gap(-30 deg, 30 deg) > 5 deg;
  bent: positions.max() > 1.5 or positions.min() < -1.5 or elbow.abs() > 2;
  joints: names.count() != 6 or positions.count() < 6;
  empty: cells.min() < 3.0;
}
entity controller {
  manual: mode = 0;
  auto: mode != 0 and enabled;
  named: state = "automatic" or state = "säge" or state != "it's \\"so\\"??/";
  broken: first = "motor" and level > 1;
  counted: beats > 5 and ticks in [-3, 9000000000) and levels.max() >= 3 and levels.min() > -2;
  overflowing: counters.max() > 18446744073709551614 or counters.count() = 0;
  same: ticks = ticks;
}
entity way {
  stopping: speed * speed / (2 * 0.7 m/s^2) >= scan.nearest(-20 deg, 20 deg) - 0.3 m;
  jumping: abs(speed - speed.previous()) > 0.4 m/s or max(level, mode, 2) - ticks > 2.5;
  leaning: hypot(speed, sqrt(2 * 9.81 m/s^2 * abs(height))) in (0.5, 2 m/s)
    and sin(attitude.yaw()) / mode < 0.5;
}
entity area {
  left: not place.inside(yard) or place.inside(pit);
  blocked: rear.points_in(behind) >= 4 or rear.points_in(behind).unknown();
}
entity doubt {
  blind: scan.nearest(-30 deg, 30 deg).unknown() or not speed.unknown() and attitude.unknown();
  failsafe hidden: (attitude.tilt() > 20 deg and state = "automatic") for 0.2 sec;
  failsafe absent: elbow.rate() > 3 or state.missing();
  lasting: (enabled since mode = 3) or not (hidden since absent);
  recent: (mode = 3 begins within 2 sec) or ((not absent) within 0.5 sec);
  often: absent 2 times within 3 sec;
  halted: motor_stop.active and (enabled or not absent for 1 sec);
}
if drive.too_fast and controller.auto then { stop; log_state("too fast: don't ünd so"); };
behaviour tilt: if body.tilted for 0.4 sec then {
  motor_stop;
  if not controller.manual for 1 sec
  then { beep(3, "a", true, 0.5); if body.turned then { horn; }; };
  stop;
};
optional behaviour near: if body.near or body.turning or drive.silent or drive.seldom or drive.jerky
  or drive.old
then { stop; };
if body.bent or body.joints or body.empty or drive.climbing then { horn; };
if controller.named and not controller.broken or controller.counted or controller.same
then { beep(-9000000000, "", false, -1.5e-3); };
if controller.manual or controller.overflowing then { ok; };
if area.left or area.blocked then { horn; };
if doubt.blind or doubt.hidden and not doubt.absent then { horn; };
if doubt.lasting since controller.manual then { horn; };
if way.stopping or way.jumping or way.leaning then { horn; };
if doubt.recent within 1 sec then { horn; };
if doubt.often or (doubt.recent 3 times within 8 sec) then { horn; };
if doubt.halted or motor_stop.active for 5 sec then { horn; };
gate /nav -> /cmd : geometry_msgs.Twist rate 20 Hz { stop: zero; lost heartbeat for 0.3 sec: zero; }
"""


_OF_EXAMPLES = {path.stem: path for path in sorted(EXAMPLES.glob("*/*.deros"))}

NAMES = ("everything", *_OF_EXAMPLES)
"""The names of the program of these rules, and of those of the example robots."""


@functools.cache
def named(name: str) -> Program:
    """Return the program of a name."""
    path = _OF_EXAMPLES.get(name)
    if path is None:
        return built(RULES, name)
    return built(path.read_text(encoding="utf-8"), name, path.parent)


@functools.cache
def texts_of(name: str) -> Mapping[str, str]:
    """Return the files of the monitor in C of a named program."""
    return render_monitor(named(name))


def everything() -> Program:
    """Return the program of these rules."""
    return named("everything")


def examples() -> list[Program]:
    """Return the programs of the example robots."""
    return [named(name) for name in _OF_EXAMPLES]


def built(rules: str, name: str, folder: Path | None = None) -> Program:
    """Return the program of rules that stand in a folder, or beside the robot of this module."""
    if folder is None:
        with tempfile.TemporaryDirectory(prefix="deros-rules-") as made:
            (Path(made) / "robot.rnd").write_text(NODE, encoding="utf-8")
            (Path(made) / "robot.system").write_text(SYSTEM, encoding="utf-8")
            return built(rules, name, Path(made))
    repository = Repository()
    loaded = repository.load_text(folder / f"{name}.deros", rules)
    model = loaded.model
    assert isinstance(model, Rules), loaded.diagnostics
    assert not has_errors(loaded.diagnostics), loaded.diagnostics
    result = build(model, InterfaceStore())
    assert result.program is not None, result.diagnostics
    return result.program
