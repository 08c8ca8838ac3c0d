"""Common mistakes: each gives one finding, and its hint fixes it."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import pytest

from deros import codes
from deros.diagnostics import Diagnostic, Severity
from deros.interfaces.store import InterfaceStore
from tests.support.checks import checked

BASE = {
    "camera.rnd": """\
node camera : camera_driver "Takes pictures"
parameters
  name width : integer = 640 in [1, 4096] // pixels
  name rate : double = 30.0 [Hz]
  name range : double = 5.0 [m]
  name frame : string = "camera" one_of ["camera", "rear"]
  name flip : bool = false
publishes
  topic image : sensor_msgs.Image qos sensor_data
  topic pose : nav_msgs.Odometry
  topic state : std_msgs.Bool
subscribes
  topic stop : std_msgs.Bool
services
  service reset : std_srvs.Trigger
timers
  timer grab every 20 ms
""",
    "p.yaml": """\
/front/camera:
  ros__parameters: {rate: 20.0}
""",
    "viewer.rnd": """\
node viewer : image_viewer
subscribes
  topic image : sensor_msgs.Image qos sensor_data
clients
  client reset : std_srvs.Trigger
""",
    "demo.system": """\
system Demo
imports
  import "camera.rnd"
  import "viewer.rnd"
topics
  topic /image
  topic /pose
  topic /state
  topic /stop
  external topic /wish
  external topic /health : diagnostic_msgs.DiagnosticArray
  external topic /cmd_vel
subsystem front namespace /front {
  node camera : camera
    parameters
      param width = 320
      param range = 2.5
    wirings
      connect image to /image
      connect pose to /pose
      connect state to /state
      connect stop to /stop
      connect reset to /reset
}
node viewer : viewer
  wirings
    connect image to /image
    connect reset to /reset
""",
    "demo.deros": """\
use "demo.system" import Demo
action stop publishes true on /stop : std_msgs.Bool latched
action beep
const limit = 0.5 m/s
input speed = topic /pose.twist.twist.linear.x timeout 0.5 sec
input ready = topic /state.data timeout 1 sec
input lidar = topic /health.status[name = "lidar"].level timeout 1 sec
entity drive {
  fast: speed > limit for 0.2 sec;
  odd: speed not in [-1, 2] or speed < -0.5 and not ready;
  gone: speed.missing() or ready.missing();
  ill: lidar >= 2 or lidar.unknown();
  idle: ready = false;
}
if drive.fast or drive.gone then { stop; };
if drive.odd for 2 sec then { beep; stop; }
if drive.idle then { beep; }
if drive.ill then { stop; }
""",
    "varied.system": """\
system Varied
imports
  import "camera.rnd"
argument robot : string = "one"
argument slow : bool = false
argument speed : double = 10.0 in [1, 30]
argument mode : string = "auto" one_of ["auto", "manual", "off"]
topics
  external topic "/${robot}/image"
  external topic /pose
  external topic /state
  external topic /stop
node camera : camera when not slow or mode in ["auto", "off"]
  parameters
    param rate = $speed * 2 when mode = "auto"
    param range = $speed
  wirings
    connect image to "/${robot}/image"
    connect pose to /pose
    connect state to /state
    connect stop to /stop
    connect reset to /reset
""",
    "beacon.rnd": "node beacon : beacons lifecycle",
    "managed.system": """\
system Managed autostart timeout 5 sec
imports
  import "beacon.rnd"
node first : beacon autostart on failure stop
node second : beacon autostart on failure continue
""",
    "later.system": """\
system Later
imports
  import "beacon.rnd"
process first : "first"
process next : "next" after exit of first
process late : "late" delay 3 sec on exit stop all
process watched : "watched" after node seen
node seen : beacon autostart
container main { }
""",
    "lens.rnd": 'node lens : optics plugin "optics::Lens"',
    "boxed.system": """\
system Boxed
imports
  import "lens.rnd"
container main multi_threaded {
  node camera : lens intra_process
}
node rear : lens plugin "optics::Rear" into main
container other {
  node front : lens
}
node server : lens namespace /s own_name
inside server {
  node part : lens namespace /p
}
""",
}


class Mistake(NamedTuple):
    """A mistake: the right text in a file of the base, the wrong text, and words of the hint."""

    file: str
    right: str
    wrong: str
    words: str
    fix: bool = True


def _r(right: str, wrong: str, words: str, fix: bool = True) -> Mistake:
    return Mistake("demo.deros", right, wrong, words, fix)


def _s(right: str, wrong: str, words: str, fix: bool = True) -> Mistake:
    return Mistake("demo.system", right, wrong, words, fix)


def _v(right: str, wrong: str, words: str, fix: bool = True) -> Mistake:
    return Mistake("varied.system", right, wrong, words, fix)


def _m(right: str, wrong: str, words: str, fix: bool = True) -> Mistake:
    return Mistake("managed.system", right, wrong, words, fix)


def _c(right: str, wrong: str, words: str, fix: bool = True) -> Mistake:
    return Mistake("boxed.system", right, wrong, words, fix)


def _l(right: str, wrong: str, words: str, fix: bool = True) -> Mistake:
    return Mistake("later.system", right, wrong, words, fix)


def _n(right: str, wrong: str, words: str, fix: bool = True) -> Mistake:
    return Mistake("camera.rnd", right, wrong, words, fix)


MISTAKES = [
    # Operators of other languages
    _r("] or speed", "] || speed", "write 'or'"),
    _r("] or speed", "] | speed", "write 'or'"),
    _r("] or speed", "] OR speed", "write 'or'"),
    _r("-0.5 and not", "-0.5 && not", "write 'and'"),
    _r("-0.5 and not", "-0.5 & not", "write 'and'"),
    _r("-0.5 and not", "-0.5 AND not", "write 'and'"),
    _r("and not ready", "and !ready", "write 'not'"),
    _r("and not ready", "and NOT ready", "write 'not'"),
    _r("and not ready", "and ~ready", "write 'not'"),
    _r("ready = false", "ready == False", "write 'false'"),
    _r("ready = false", "ready = FALSE", "write 'false'"),
    _r("ready = false", "ready === false", "write '='"),
    _r("ready = false", "ready := false", "write '='"),
    _r("ready = false", "ready is false", "write '='"),
    _r("ready = false", "ready <> true", "write '!='"),
    _r("ready = false", "ready ~= true", "write '!='"),
    _r("ready = false", "ready is not true", "write '!='"),
    _r("speed > limit", "speed => limit", "write '>='"),
    _r("speed > limit", "speed ≥ limit", "write '>='"),
    _r("speed not in [-1, 2]", "not speed in [-1 .. 2]", "write ','"),
    _r("speed not in [-1, 2]", "speed not in [-1; 2]", "write ','"),
    _r("speed not in [-1, 2]", "speed not in [-1 to 2]", "write ','"),
    _r("speed not in [-1, 2]", "-1 < speed < 2", "in (-1, 2)"),
    _r("speed not in [-1, 2]", "0 <= speed <= 2 m/s", "in [0, 2 m/s]"),
    _r("speed not in [-1, 2]", "speed !in [-1, 2]", "write 'not in'"),
    _r("speed not in [-1, 2]", "speed not between [-1, 2]", "write 'in'"),
    _r("speed not in [-1, 2]", "speed in not [-1, 2]", "write 'not in'"),
    _r("gone: speed.missing()", "gone: speed is null", "missing()"),
    _r("gone: speed.missing()", "gone: speed = None", "missing()", False),
    # Behaviours
    _r("drive.gone then { stop; };", "drive.gone { stop; };", "write 'then'"),
    _r("drive.gone then { stop; };", "drive.gone: { stop; };", "write 'then'"),
    _r("drive.gone then { stop; };", "drive.gone => { stop; };", "write 'then'"),
    _r("drive.gone then { stop; };", "drive.gone -> { stop; };", "write 'then'"),
    _r("drive.gone then { stop; };", "drive.gone then stop;", "braces"),
    _r("drive.gone then { stop; };", "drive.gone then: { stop; };", "remove ':'"),
    _r("drive.gone then { stop; };", "drive.gone do { stop; };", "write 'then'"),
    _r("drive.gone then { stop; };", "drive.gone THEN { stop; };", "'then'"),
    _r("if drive.fast", "IF drive.fast", "'if'"),
    _r("if drive.fast", "when drive.fast", "write 'if'"),
    _r("if drive.fast or drive.gone then", "if (drive.fast or drive.gone)", "write 'then'"),
    _r("if drive.idle", "else if drive.idle", "its own condition"),
    _r("if drive.idle", "elif drive.idle", "its own condition"),
    _r("{ beep; }", "{ beep; } else { stop; }", "its own condition", False),
    _r("if drive.odd for 2 sec then", "if drive.odd then for 2 sec", "before 'then'"),
    _r("fast: speed > limit for 0.2 sec", "fast: speed > limit until 0.2 sec", "for T", False),
    _r("fast: speed > limit for 0.2 sec", "fast: for 0.2 sec speed > limit", "'for'"),
    _r("for 0.2 sec", "for 0.2", "0.2 sec", False),
    _r("for 0.2 sec", "for 0.2 Sec", "'sec'"),
    _r("limit = 0.5 m/s", "limit = 0,5 m/s", "write '0.5'"),
    _r("limit = 0.5 m/s", "limit := 0.5 m/s", "write '='"),
    _r("limit = 0.5 m/s", "limit: 0.5 m/s", "write '='"),
    _r("limit = 0.5 m/s", "limit 0.5 m/s", "write '='"),
    _r("const limit", "constant limit", "'const'"),
    _r("const limit", "let limit", "write 'const'"),
    _r("topic /pose.twist", "/pose/twist", "'/pose'", False),
    _r("input speed = topic", "input speed : topic", "write '='"),
    _r("input speed = topic", "input speed <- topic", "write '='"),
    _r("timeout 0.5 sec", "timeout: 0.5 sec", "remove ':'"),
    _r("timeout 0.5 sec", "timeout = 0.5 sec", "remove '='"),
    _r('[name = "lidar"]', "[name = lidar]", "'[name = \"lidar\"]'"),
    _r('[name = "lidar"]', "[name = 'lidar']", "'[name = \"lidar\"]'"),
    _r('[name = "lidar"]', '[name: "lidar"]', "'[name = \"lidar\"]'"),
    _r('[name = "lidar"]', '["lidar"]', "'[name = \"lidar\"]'"),
    _r('[name = "lidar"]', '[header.frame_id = "map"]', "that the element itself has", False),
    _r('[name = "lidar"]', "[-1]", "0 is the first element", False),
    _r("timeout 0.5 sec", "time_out 0.5 sec", "'timeout'"),
    _r("on /stop : std_msgs.Bool", "on /stop : std_msgs::msg::Bool", "std_msgs.Bool"),
    _r("publishes true on", "publish true on", "'publishes'"),
    _r("publishes true on", "publishes True on", "write 'true'"),
    _r("publishes true on", "publishes true to", "write 'on'"),
    _r('use "demo.system" import Demo', 'import "demo.system"', "use", False),
    _r('use "demo.system" import Demo', "use demo.system import Demo", "quotes"),
    _r('use "demo.system" import Demo', "use 'demo.system' import Demo", "double quotes"),
    _r("entity drive {", "entity drive:", "write '{'"),
    _r("entity drive {", "Entity drive {", "'entity'"),
    _r("entity drive {", "entity drive", "write '{'"),
    _r("idle: ready = false;\n}", "idle: ready = false;\n", "'}'"),
    _r("action beep", "# beeps\naction beep", "a comment begins with '//'"),
    _r("action beep", "-- beeps\naction beep", "a comment begins with '//'"),
    _r("action beep", "action beep()\u00a0;", "plain space"),
    # Node descriptions
    _n("publishes\n", "publisher\n", "'publishes'"),
    _n("publishes\n", "publishes:\n", "remove ':'"),
    _n("publishes\n", "publishes;\n", "remove ';'"),
    _n("subscribes\n", "subscriber\n", "'subscribes'"),
    _n("subscribes\n", "subscriptions\n", "'subscribes'"),
    _n("parameters\n", "params\n", "'parameters'"),
    _n("node camera :", "Node camera :", "'node'"),
    _n(
        "topic image : sensor_msgs.Image",
        "topic image : sensor_msgs::msg::Image",
        "sensor_msgs.Image",
    ),
    _n("topic image : sensor_msgs.Image", "topic image sensor_msgs.Image", "write ':'"),
    _n("topic image : sensor_msgs.Image", "image : sensor_msgs.Image", "write 'topic'"),
    _n("topic image : sensor_msgs.Image", 'topic "image" : sensor_msgs.Image', "without quotes"),
    _n("topic image : sensor_msgs.Image", "topic image : Image", "PACKAGE.Image", False),
    _n("topic image : sensor_msgs.Image", "topic image : sensor_msg.Image", "'sensor_msgs'"),
    _n("topic pose : nav_msgs.Odometry", "topic pose : nav_msg/Odometry", "'nav_msgs'"),
    _n("topic pose : nav_msgs.Odometry", "topic pose : nav2_msgs.Odometry", "--interfaces"),
    _n("qos sensor_data", "qos sensor-data", "'sensor_data'"),
    _n("qos sensor_data", "qos: sensor_data", "remove ':'"),
    _n("qos sensor_data", "qos best-effort depth 5", "'best_effort'"),
    _n("qos sensor_data", "qos BEST_EFFORT depth 5", "lower case"),
    _n("name rate : double", "name rate : float64", "'double'"),
    _n("name width : integer", "name width : int32", "'integer'"),
    _n("name frame : string", "name frame : str", "'string'"),
    _n("name flip : bool", "name flip : boolean", "'bool'"),
    _n("= false", "= False", "write 'false'"),
    _n("= false", "= no", "write 'false'"),
    _n("name rate : double = 30.0", "name rate = 30.0 : double", "the type"),
    _n("name rate : double = 30.0", "double rate = 30.0", "write 'name"),
    _n("= 5.0 [m]", "= 500 cm [m]", "unit", False),
    _n("= 5.0 [m]", "= 5.0 m", "[m]"),
    _n("= 640 in [1, 4096]", "= 640 in 1..4096", "[1, 4096]"),
    _n("= 640 in [1, 4096]", "= 640 range [1, 4096]", "write 'in'"),
    _n('= "camera"', "= 'camera'", "double quotes"),
    _n('= "camera"', "= “camera”", "plain quotes"),
    _n('= "camera"', "= camera", "quotes"),
    _n('one_of ["camera", "rear"]', 'one_of {"camera", "rear"}', "brackets"),
    _n('one_of ["camera", "rear"]', 'one of ["camera", "rear"]', "'one_of'"),
    _n('one_of ["camera", "rear"]', 'oneof ["camera", "rear"]', "'one_of'"),
    _n("every 20 ms", "20 ms", "write 'every'"),
    _n("every 20 ms", "every 50 Hz", "20 ms", False),
    _n("every 20 ms", "every 20", "20 ms", False),
    _n("// pixels", "# pixels", "a comment begins with '//'"),
    _n("services\n", "service\n", "'services'"),
    # System descriptions
    _s(
        "connect image to /image\n      connect pose",
        "connect image -> /image\n      connect pose",
        "write 'to'",
    ),
    _s(
        "connect image to /image\n      connect pose",
        "connect image = /image\n      connect pose",
        "write 'to'",
    ),
    _s(
        "connect image to /image\n      connect pose",
        "remap image to /image\n      connect pose",
        "connect image to /image",
    ),
    _s(
        "connect image to /image\n      connect pose",
        "remap image:=/image\n      connect pose",
        "connect image to /image",
    ),
    _s(
        "connect image to /image\n      connect pose",
        "image -> /image\n      connect pose",
        "connect image to /image",
    ),
    _s("param width = 320", "param width: 320", "write '='"),
    _s("param width = 320", "param width := 320", "write '='"),
    _s("param width = 320", "width = 320", "param width = 320"),
    _s("param width = 320", "width: 320", "param width = 320"),
    _s("param width = 320", "name width = 320", "write 'param'"),
    _s("param range = 2.5", "param range = 250 cm", "unit", False),
    _s("param range = 2.5", "param range = 2,5", "write '2.5'"),
    _s("    parameters\n", "  parameters from ./p.yaml parameters\n", "write '\"./p.yaml\"'"),
    _s("    parameters\n", '  from "p.yaml" parameters\n', "write 'parameters from'"),
    _s('  import "camera.rnd"', '  import camera from "camera.rnd"', 'import "FILE"'),
    _s("node camera : camera", 'node camera : camera from "camera.rnd"', 'import "FILE"', False),
    _s("subsystem front", "front", "write 'subsystem'"),
    # Programs and groups
    _s("node camera : camera", 'node camera : camera args ["-v"]', "write 'arguments'"),
    _s("node camera : camera", 'node camera : camera arguments "-v"', 'arguments ["-v"]'),
    _s("node camera : camera", "node camera : camera arguments [-v]", '"-v"'),
    _s("node camera : camera", 'node camera : camera environment A = "x"', "write 'env'"),
    _s("node camera : camera", 'node camera : camera env A = "x", B = "y"', "write 'env'"),
    _s("node camera : camera", 'node camera : camera env { A = "x" }', 'env A = "x"'),
    _s("node camera : camera", "node camera : camera prefix gdb", '"gdb"'),
    _s("node camera : camera", 'node camera : camera launch-prefix "gdb"', "write 'prefix'"),
    _s("topics\n", "remappings remap tf:=/tf\ntopics\n", "write 'to'"),
    _s("topics\n", "remappings connect tf to /tf\ntopics\n", "write 'remap'"),
    _s("topics\n", "remap tf to /tf\ntopics\n", "write 'remappings'"),
    _s("topics\n", "param use_sim_time = false\ntopics\n", "write 'parameters'"),
    _s("subsystem front", "process bag : rosbag\nsubsystem front", '"rosbag"'),
    _s("subsystem front", 'executable bag : "rosbag"\nsubsystem front', "write 'process'"),
    _s("subsystem front", 'process b : "x" work_dir "/"\nsubsystem front', "write 'cwd'"),
    _s("subsystem front", 'process b : "x" namespace /b\nsubsystem front', ".rnd", False),
    _s("node camera : camera", "node camera camera", "write ':'"),
    _s("node camera : camera", "node camera = camera", "write ':'"),
    _s("node camera : camera", "node camera: camera()", "remove '()'"),
    _s("namespace /front {", "namespace: /front {", "remove ':'"),
    _s("namespace /front {", "ns /front {", "'namespace'"),
    _s('  import "camera.rnd"', '  include "camera.rnd"', "'import'"),
    _s('  import "camera.rnd"', "  import camera.rnd", "quotes"),
    _s("topics\n", "topic\n", "'topics'"),
    _s("  topic /pose\n", "  - /pose\n", "write 'topic"),
    _s("  topic /pose\n", "  /pose\n", "write 'topic"),
    # Managed nodes
    _m("Managed autostart", "Managed auto_start", "'autostart'"),
    _m("first : beacon autostart", "first : beacon auto-start", "write 'autostart'"),
    _m("on failure stop", "on_failure stop", "write 'on failure'"),
    _m("on failure stop", "on failure shutdown", "write 'on failure stop'"),
    _m("on failure continue", "on failure go on", "write 'on failure continue'"),
    # Later starts
    _l("after exit of first", "after first", "write 'after exit of first'"),
    _l("after exit of first", "after exit first", "write 'of' before"),
    _l("after exit of first", "on_exit first", "write 'after exit of'"),
    _l("after exit of first", "on exit of first", "write 'after exit of'"),
    _l("after node seen", "after node /seen", "no '/' before"),
    _l("after node seen", "after start of seen", "write 'after node seen'"),
    _l("after node seen", "wait_for node seen", "write 'after'"),
    _l("after node seen", "after nodes seen", "write 'after node NAME'", False),
    _l("delay 3 sec", "after 3 sec", "write 'delay'"),
    _l("delay 3 sec", "start after 3 sec", "write 'delay'"),
    _l("on exit stop all", "on exit shutdown", "write 'on exit stop all'"),
    _l("on exit stop all", "on_exit=Shutdown()", "write 'on exit stop all'"),
    # Containers
    _c("node camera : lens", "component camera : lens", "write 'node'"),
    _c("node camera : lens", "composable_node camera : lens", "write 'node'"),
    _c("container main", "component_container main", "write 'container'"),
    _c("main multi_threaded", "main multithreaded", "write 'multi_threaded'"),
    _c("main multi_threaded", "main single_threaded", "leave it out"),
    _c('plugin "optics::Rear"', "plugin optics::Rear", '"optics::Rear"'),
    _c("intra_process", "use_intra_process_comms", "write 'intra_process'"),
    _c("into main", "load_into main", "write 'into'"),
    _c("container other {", "container other", "braces"),
    _c("own_name", "keep_name", "write 'own_name'"),
    _c("own_name", "unnamed", "write 'own_name'"),
    _c("inside server {", "inside server", "braces"),
    _c("into main", "inside main", "has 'into NAME' behind its type", fix=False),
    # Arguments of systems
    _v('to "/${robot}/image"', "to /${robot}/image", "stands in quotes"),
    _v('to "/${robot}/image"', "to ${robot}/image", "stands in quotes"),
    _v('to "/${robot}/image"', "to /$robot/image", "stands in quotes"),
    _v('to "/${robot}/image"', 'to "/${robot/image"', "'$${' stands for", False),
    _v('topic "/${robot}/image"', "topic /$robot/image", "stands in quotes"),
    _v("range = $speed", "range = speed", "write '$speed'"),
    _v("range = $speed", "range = ${speed}", "write '$speed'"),
    _v("range = $speed", "range = $(var speed)", "write '$speed'"),
    _v("range = $speed", "range = $(arg speed)", "write '$speed'"),
    _v("range = $speed", "range = $", "directly behind '$'", False),
    _v("$speed * 2", "2 * speed", "write '$speed'"),
    _v('mode = "auto"', 'mode == "auto"', "write '='"),
    _v("not slow or", "!slow or", "write 'not'"),
    _v("not slow or", "NOT slow or", "write 'not'"),
    _v("slow or", "slow ||", "write 'or'"),
    _v("slow or", "slow OR", "write 'or'"),
    _v("slow or", "slow &&", "write 'and'"),
    _v("mode in", "mode not in", "write 'not mode in'"),
    _v("when mode", "if mode", "write 'when'"),
    _v("when mode", "unless mode", "write 'when not'"),
    _v("when not slow", "if not slow", "write 'when'"),
    _v("argument slow", "arg slow", "write 'argument'"),
    _v("argument robot", "arguments argument robot", "remove 'arguments'"),
]


def _findings(folder: Path, changed: str, text: str) -> list[Diagnostic]:
    for name, sound in BASE.items():
        (folder / name).write_text(sound, encoding="utf-8")
    systems = ("demo.system", "varied.system", "managed.system", "boxed.system")
    named = tuple(folder / name for name in (*systems, "demo.deros"))
    findings = checked(*named, texts={folder / changed: text}, store=InterfaceStore(()))
    return [each for each in findings if each.severity is not Severity.INFO]


@pytest.mark.parametrize("name", [name for name in BASE if name != "p.yaml"])
def test_base_has_no_findings(name: str, tmp_path: Path) -> None:
    """The base files without a mistake are sound."""
    assert _findings(tmp_path, name, BASE[name]) == []


@pytest.mark.parametrize("mistake", MISTAKES, ids=[f"{m.right}|{m.wrong}" for m in MISTAKES])
def test_mistake_gives_one_finding_with_a_working_hint(mistake: Mistake, tmp_path: Path) -> None:
    """There is one finding; applying its edit, the likeliest one, or its advice leaves none."""
    right = BASE[mistake.file]
    assert mistake.right in right
    text = right.replace(mistake.right, mistake.wrong, 1)
    findings = _findings(tmp_path, mistake.file, text)
    descriptions = [f"{each.code.name} {each.message} | {each.hint}" for each in findings]
    assert len(findings) == 1, descriptions
    (finding,) = findings
    assert mistake.words in f"{finding.message} | {finding.hint}"
    edits = [finding.fix] if finding.fix is not None else finding.choices
    assert bool(edits) == mistake.fix, descriptions
    if edits:
        span = edits[0].span
        mended = f"{text[: span.start]}{edits[0].text}{text[span.end :]}"
        assert _findings(tmp_path, mistake.file, mended) == []


_GATED = """\
use "demo.system" import Demo
action stop publishes true on /stop : std_msgs.Bool latched
input speed = topic /pose.twist.twist.linear.x timeout 0.5 sec
input ready = topic /state.data timeout 1 sec
entity drive { fast: speed.abs() > 0.5 m/s or speed.unknown(); idle: not ready or ready.missing(); }
if drive.fast or drive.idle then { stop; };
gate /wish -> /cmd_vel : TYPE rate 20 Hz {
  always: limit FIELDlinear.x to [-1, 1] m/s, FIELDangular.z to [-1, 1] rad/s;
  lost heartbeat for 0.3 sec: zero until reset;
  lost input for 0.5 sec: zero;
  stop: STOP;
  resume on zero command;
}
"""


@pytest.mark.parametrize("kind", ["Twist", "TwistStamped"])
@pytest.mark.parametrize(
    ("wrong", "advice"),
    [
        ("zero at 1 m/s^2", "zero ramp FIELDlinear.x 1 m/s^2"),
        ("zero with 60 deg/s2", "zero ramp FIELDangular.z 60 deg/s2"),
        ("zero by 0.5 m/s/s", "zero ramp FIELDlinear.x 0.5 m/s/s"),
        ("zero 1 m/s2", "zero ramp FIELDlinear.x 1 m/s2"),
        ("zero ramp 1 m/s2", "zero ramp FIELDlinear.x 1 m/s2"),
        ("zero within 0.8 sec", "zero ramp FIELDlinear.x RATE"),
        ("zero over 2 sec", "zero ramp FIELDlinear.x RATE"),
    ],
)
def test_ramp_without_field_says_what_to_write(
    kind: str, wrong: str, advice: str, tmp_path: Path
) -> None:
    """There is one finding; its advice, with a rate for RATE, is accepted."""
    prefix = "twist." if kind == "TwistStamped" else ""
    rules = _GATED.replace("TYPE", f"geometry_msgs.{kind}").replace("FIELD", prefix)
    advice = advice.replace("FIELD", prefix)
    (finding,) = _findings(tmp_path, "demo.deros", rules.replace("STOP", wrong))
    assert finding.code is codes.SYNTAX_ERROR
    assert finding.span.text in wrong.split()
    assert f"'{advice}'" in finding.hint
    mended = rules.replace("STOP", advice.replace("RATE", "1 m/s2"))
    assert _findings(tmp_path, "demo.deros", mended) == []


def test_table_has_at_least_sixty_mistakes() -> None:
    """The table of mistakes does not shrink."""
    assert len(MISTAKES) >= 60
