"""The models that ``deros new`` starts with: small, complete, and clean under ``deros check``.

Rules come with timelines that pass ``deros test --strict``.
"""

from __future__ import annotations

from string import Template

from deros.metamodels.languages import LANGUAGES, entry_point

_NODE = """\
node $name : $package "What this node does"

parameters
  name max_speed : double = 0.5 [m/s] in [0.0, 2.0] "Fastest allowed speed"

subscribes
  topic odom : nav_msgs.Odometry

publishes
  topic cmd_vel : geometry_msgs.Twist
"""

_BASE_NODE = """\
node ${name}_base : $package "Drives the wheels and measures the speed"

subscribes
  topic cmd_vel : geometry_msgs.Twist

publishes
  topic odom : nav_msgs.Odometry
"""

_PILOT_NODE = """\
node ${name}_pilot : $package "Decides where to go"

parameters
  name cruise_speed : double = 0.3 [m/s] in [0.0, 1.0]

subscribes
  topic odom : nav_msgs.Odometry

publishes
  topic cmd_vel : geometry_msgs.Twist
"""

_SYSTEM = """\
system $name

imports
  import "${name}_base.rnd"
  import "${name}_pilot.rnd"

topics
  topic /odom
  topic /cmd_vel

subsystem Hardware {
  node base : ${name}_base
  wirings
    connect cmd_vel to /cmd_vel
    connect odom to /odom
}

subsystem Mission {
  node pilot : ${name}_pilot
  parameters
    param cruise_speed = 0.4
  wirings
    connect odom to /odom
    connect cmd_vel to /cmd_vel
}
"""

_WATCHED_NODE = """\
node ${name}_robot : $package "The robot that the rules watch"

subscribes
  topic cmd_vel : geometry_msgs.Twist stops after 0.5 sec "What the gate lets through"
  topic stop_robot : std_msgs.Bool qos reliable transient_local "Why it may let nothing through"

publishes
  topic odom : nav_msgs.Odometry
  topic wish : geometry_msgs.Twist "Where to go: zero before setting off, and again after a stop"
  topic resume : std_msgs.Bool
"""

_WATCHED_SYSTEM = """\
system ${name}_system

imports
  import "${name}_robot.rnd"

topics
  topic /odom
  topic /wish
  topic /cmd_vel
  topic /resume
  topic /stop_robot

subsystem Robot {
  node robot : ${name}_robot
  wirings
    connect odom to /odom
    connect wish to /wish
    connect cmd_vel to /cmd_vel
    connect resume to /resume
    connect stop_robot to /stop_robot
}

subsystem Safety {
  // The safety node of these rules and its gate, connected as they say.
  safety "$name.deros"
  parameters
    param startup_grace = 5.0  // so long may sensors take to come before they are missing
}
"""

_RULES = """\
use "${name}.system" import ${name}_system

// Published while the robot must stand still; ends when somebody resumes.
action stop publishes true on /stop_robot : std_msgs.Bool reset_by resume;
action resume;

const max_speed = 0.5 m/s

input speed = topic /odom.twist.twist.linear.x timeout 0.5 sec
input resume_button = topic /resume.data timeout 1 sec

entity drive {
  too_fast: speed.abs() > max_speed for 2 sec;
  blind: speed.unknown();
}

entity operator {
  // A press, seen from released to pressed: a button that is stuck resumes nothing.
  up: (not resume_button) for 0.1 sec;
  resumes: resume_button begins and (up within 1 ms);
  away: resume_button.missing();
}

if drive.too_fast or drive.blind then { stop; log_state("stopped"); };
if operator.resumes then { resume; };
if operator.away for 10 sec then { log_state("nobody at the button"); };

// All commands go through it. What was stopped moves again when somebody means it to: after a lost
// safety node the gate has to be reset, and after every stop the robot has to wish for zero once.
gate /wish -> /cmd_vel : geometry_msgs.Twist rate 20 Hz {
  stop: zero;
  lost heartbeat for 0.3 sec: zero until reset;
  lost input for 0.5 sec: zero;
  resume on zero command;
}
"""

_RULE_TESTS = """\
# The rules of $name

Rules: [$name.deros]($name.deros)

Each table is a test of the rules, which `deros test .` plays: what comes, and what has to happen.

## Too fast

| time until 6 s             | message               | effect             | command             |
|----------------------------|-----------------------|--------------------|---------------------|
| every 0.1 s until 2 s      | speed = 0.4           |                    |                     |
| every 0.1 s until 4.9 s    | resume_button = false |                    |                     |
| every 0.1 s until 1 s      | /wish.linear.x = 0    |                    |                     |
| 0.6 s                      | reset /cmd_vel        |                    | /cmd_vel gate reset |
| 1.1 s to 6 s every 0.1 s   | /wish.linear.x = 0.4  |                    |                     |
| 1.5 s                      |                       |                    | /cmd_vel passed     |
| 2.1 s to 4.4 s every 0.1 s | speed = 0.6           |                    |                     |
| 4.1 s                      |                       | stop, log_state    | /cmd_vel zero       |
| 4.5 s to 6 s every 0.1 s   | speed = 0             |                    |                     |
| 5 s                        | resume_button = true  | resume, stop reset |                     |
| 5.1 s to 6 s every 0.1 s   | resume_button = false |                    |                     |
| 6 s                        |                       |                    | /cmd_vel zero       |

It stands still at the end: it still wishes to move, and has not wished for zero since the stop.

## The speed is missing

| time                  | message               | effect          |
|-----------------------|-----------------------|-----------------|
| every 0.1 s until 2 s | resume_button = false |                 |
| 0.5 s                 |                       | stop, log_state |

## Nobody is at the button

| time                   | message     | effect    |
|------------------------|-------------|-----------|
| every 0.1 s until 12 s | speed = 0.1 |           |
| 11 s                   |             | log_state |
"""

NODE = {"$name.rnd": _NODE}
SYSTEM = {
    "$name.system": _SYSTEM,
    "${name}_base.rnd": _BASE_NODE,
    "${name}_pilot.rnd": _PILOT_NODE,
}
RULES = {
    "$name.deros": _RULES,
    "$name.system": _WATCHED_SYSTEM,
    "${name}_robot.rnd": _WATCHED_NODE,
    "$name.md": _RULE_TESTS,
}

KINDS = {each.kind: each for each in LANGUAGES}
"""The languages by the word that ``deros new`` knows them by."""


def scaffold(kind: str, name: str, package: str) -> dict[str, str]:
    """Return file names and texts of a new model of one of :data:`KINDS`, the main file first."""

    def filled(template: str) -> str:
        return Template(template).substitute(name=name, package=package)

    templates: dict[str, str] = entry_point(KINDS[kind].scaffold)
    return {filled(path): filled(text) for path, text in templates.items()}
