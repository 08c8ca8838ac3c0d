"""Rules that can be misread: what the check says of each, and what it lets pass."""

from __future__ import annotations

import re
from pathlib import Path
from typing import NamedTuple

import pytest

from tests.support.checks import checked_rules

TOPICS = """\
odom : nav_msgs.Odometry
p : std_msgs.Bool
q : std_msgs.Bool
left : std_msgs.Bool
right : std_msgs.Bool
button : std_msgs.Bool
scan : sensor_msgs.LaserScan
front : sensor_msgs.Range
rear : sensor_msgs.Range
battery : sensor_msgs.BatteryState
motor : sensor_msgs.Temperature
air : sensor_msgs.Temperature
mode : std_msgs.UInt8
count : std_msgs.UInt8
big : std_msgs.UInt64
raw : std_msgs.Float64
half : std_msgs.Float32
heading : std_msgs.Float64 { data [rad] }
imu : sensor_msgs.Imu
status : diagnostic_msgs.DiagnosticStatus
stop : std_msgs.Bool
"""
SYSTEM = "system Robot\ntopics\n" + "".join(
    f"  external topic /{each}\n" for each in TOPICS.splitlines()
)

INPUTS = {
    "speed": "/odom.twist.twist.linear.x",
    "turn": "/odom.twist.twist.angular.z",
    "x": "/odom.pose.pose.position.x",
    "p": "/p.data",
    "q": "/q.data",
    "left": "/left.data",
    "right": "/right.data",
    "button": "/button.data",
    "scan": "/scan",
    "front": "/front.range",
    "rear": "/rear.range",
    "charge": "/battery.percentage",
    "volt": "/battery.voltage",
    "T": "/motor.temperature",
    "T0": "/air.temperature",
    "mode": "/mode.data",
    "count": "/count.data",
    "big": "/big.data",
    "raw": "/raw.data",
    "half": "/half.data",
    "heading": "/heading.data",
    "orientation": "/imu.orientation",
    "level": "/status.level",
}

STOPS = "if e.r or e.lost then { stop; };"
ONLY = "if e.r then { stop; };"
OPPOSITE = "if not e.r or e.lost then { stop; };"
RELEASES = "if e.bad or e.lost then { stop; }; if e.r then { release; };"
LOGS = 'if e.r then { stop; }; if e.lost then { log_state("lost"); };'
NESTS = "if e.r then { if e.lost then { stop; }; };"


class Row(NamedTuple):
    """A rule ``r`` that can be misread, in a program that needs nothing else.

    Attributes:
        rule: its condition; ``failsafe r:`` may stand before it.
        one_may_think: what a reader may take it for.
        it_means: what it means; where nothing is found, why that is all right, or what is not.
        found: the codes of ``check --strict``, in the order of the file.
        then: the behaviours, which read ``e.r`` and ``e.lost``.
        lost: what ``e.lost`` asks of each input; nothing if empty.
        more: other rules of the entity.
        timeout: that of each input.
    """

    rule: str
    one_may_think: str
    it_means: str
    found: str = ""
    then: str = STOPS
    lost: str = "unknown()"
    more: str = ""
    timeout: str = "timeout 0.5 sec"

    def program(self) -> str:
        """Return the whole text; inputs are those that it names."""
        text = f"{self.rule} {self.more}"
        names = [each for each in INPUTS if re.search(rf"(?<![\w./]){each}\b", text)]
        release = "release" in self.then
        lines = [
            'use "robot.system" import Robot',
            "action stop publishes true on /stop : std_msgs.Bool "
            + ("reset_by release; action release;" if release else "latched;"),
            *(f"input {each} = topic {INPUTS[each]} {self.timeout}" for each in names),
            "entity e {",
            f"  {self.rule if 'r:' in self.rule else 'r: ' + self.rule}; {self.more}",
        ]
        if self.lost:
            lines.append(f"  lost: {' or '.join(f'{each}.{self.lost}' for each in names)};")
        return "\n".join([*lines, "}", self.then, ""])


FAR = "scan.nearest(-30 deg, 30 deg) > 1 m"
NEAR = "scan.nearest(-30 deg, 30 deg) < 0.5 m"
FAST = "bad: speed.abs() > 1 m/s;"
BLIND = "bad: scan.nearest(-30 deg, 30 deg).unknown() or speed.abs() > 1 m/s;"
BEAMS = "nearest(-30 deg, 30 deg).unknown()"
SHUT = "u: front.unknown() for 1 sec;"

LOGIC = (
    Row("not p within 1 sec", "no p for a second", "p was false once: ambiguous", "DRS369"),
    Row("not p begins", "p ended", "nearly always true: ambiguous", "DRS369"),
    Row("p for 1 sec or q", "p for a second, or q at once", "refused", "DRS003"),
    Row("p for 2 sec within 1 sec", "p lasted, just now", "refused", "DRS003"),
    Row("p and q within 1 sec", "p now, q just now", "both at one instant, just now", "DRS379"),
    Row("(p and q) within 1 sec", "at one instant", "so it is: the parentheses say it"),
    Row("p and (q within 1 sec)", "p now, q just now", "so it is: the parentheses say it"),
    Row("p or q within 1 sec", "p now, or q just now", "p just now, too", "DRS379"),
    Row("p or q for 1 sec", "p at once, q after 1 s", "one of both for 1 s; as in the paper"),
    Row("p and q for 1 sec", "p now, q for 1 s", "both for 1 s; as in the paper"),
    Row("speed = speed", "it is no NaN", "always true", "DRS309"),
    Row("speed != speed", "it is NaN", "never true: a NaN makes it unknown", "DRS308"),
    Row(
        "near and far",
        "near one, far from another",
        "never true, through their names",
        "DRS308",
        more="near: front < 0.3 m; far: front > 2 m;",
    ),
    Row(
        "near or far",
        "near or far",
        "always true, through their names",
        "DRS309",
        more="near: front < 2 m; far: front > 0.3 m;",
    ),
    Row("not p for 1 sec", "p did not last 1 s", "not p, for 1 s: acts later; as English reads"),
    Row("not p and q", "not both", "(not p) and q; as in every language"),
    Row("p or q and button", "(p or q) and button", "p or (q and button): acts more often"),
    Row("mode = 1 or 2", "mode is 1 or 2", "refused", "DRS324"),
    Row("mode != 1 or mode != 2", "neither 1 nor 2", "always true", "DRS309"),
    Row("mode = 1 and mode = 2", "1 as well as 2", "never true", "DRS308"),
    Row("mode in (1, 2)", "1 or 2", "between them: never true", "DRS308"),
    Row("mode not in (1, 2)", "neither 1 nor 2", "not between them: always true", "DRS309"),
    Row("speed not in [0.5, -0.5]", "beyond either", "runs backwards", "DRS307"),
    Row("0.2 < speed < 0.5", "between", "refused", "DRS003"),
    Row("level = ERROR", "ERROR or worse", "ERROR alone, not STALE; the constant is named"),
)
TIMES = (
    Row("p for 0 sec", "at once", "at once, and the time is a slip", "DRS376"),
    Row("p within 0 sec", "now", "now, and the time is a slip", "DRS376"),
    Row("(p begins) for 1 sec", "p began 1 s ago", "never: it holds at one event", "DRS308"),
    Row("p begins and q begins", "together", "at one instant: nearly never", "DRS378"),
    Row("(p begins and q begins) within 1 sec", "in one second", "nearly never", "DRS378"),
    Row("p begins and q begins within 1 sec", "in one second", "q first, then p", "DRS379"),
    Row("(p begins within 1 sec) and (q begins within 1 sec)", "in one second", "so it is"),
    Row("mode = 1 since mode = 1", "since it became 1", "mode = 1", "DRS373"),
    Row("speed >= 3 since speed > 2", "hysteresis", "its bounds are exchanged", "DRS373 DRS381"),
    Row("front < 0.3 m since front < 1 m", "hysteresis", "its bounds are exchanged", "DRS373"),
    Row("front < 1 m since front < 0.3 m", "hysteresis", "as one thinks"),
    Row(
        "near since nearer",
        "hysteresis",
        "its bounds are exchanged, through their names",
        "DRS373",
        more="near: front < 0.3 m; nearer: front < 1 m;",
    ),
    Row("(not q since p) for 1 sec", "p is not answered", "p asks while it lasts: stops too often"),
    Row("(left within 1 sec) and (right within 1 sec)", "pressed together", "tied down counts too"),
    Row("x != x.previous() for 1 sec", "moves", "every message differs: one equal one ends it"),
    Row(
        "speed in [-0.5, 0.5] for 2 sec", "never beyond", "at no message beyond; that is all known"
    ),
)
NUMBERS = (
    Row("speed > 0.5 m/s", "faster than 0.5 m/s", "forwards alone", "DRS381"),
    Row("speed < 0.5 m/s", "slow", "slow, or any speed backwards; acts more often"),
    Row("speed.abs() < 0", "backwards", "never true", "DRS308"),
    Row("speed.abs() > 0.5 m/s", "faster than 0.5 m/s", "both ways round: as one thinks"),
    Row("speed > 0.1 m/s and front < 0.5 m", "towards something", "forwards alone: as one thinks"),
    Row("speed != 0", "moves", "all but one value: noise moves it", "DRS330"),
    Row("speed = 0", "stands", "one value alone: noise moves it", "DRS330"),
    Row("mode != 0", "any other mode", "an integer: as one thinks"),
    Row("orientation.tilt() > 20 grad", "20 deg", "18 deg elsewhere: refused", "DRS006"),
    Row("speed > 5", "5 km/h", "5 m/s, the unit of the field: REP 103", "DRS381"),
    Row("turn > 20", "20 deg/s", "20 rad/s, the unit of the field: REP 103", "DRS381"),
    Row("turn > 20 deg", "20 deg/s", "refused: an angle", "DRS306"),
    Row("orientation.tilt() > 10", "10 deg", "10 rad: never true", "DRS308 DRS348"),
    Row("raw = 0.3", "0.3", "exactly the double", "DRS330"),
    Row("half = 0.3", "0.3", "0.3 rounded as the field is, exactly", "DRS330"),
    Row("half <= 0.3", "0.3 is not above", "0.3 rounded as the field is: as one thinks"),
    Row("charge < 20 %", "below a fifth", "below 0.2: as one thinks"),
    Row("charge < 20", "below a fifth", "always true: the field is 0 to 1", "DRS309"),
    Row("charge > 80", "above four fifths", "never true", "DRS308"),
    Row("T - T0 > 5 degC", "5 degrees warmer", "refused: 5 K", "DRS306"),
    Row("T > 80 C", "80 degC", "coulombs: refused", "DRS306"),
    Row("T > 1.1 * T0", "a tenth warmer", "refused: degC has a zero of its own", "DRS306"),
    Row("T > 80 K", "80 degrees", "-193 degC: acts at once"),
    Row(f"{NEAR[:-5]}speed * 500 ms + 0.3", "0.3 m", "0.3 mm: refused", "DRS372"),
    Row("speed / 500 ms > 1", "1 m/s^2", "1000 m/s^2", "DRS372"),
    Row("speed / turn > 2 m", "a wide curve", "unknown while it drives straight", "DRS348"),
    Row("volt < 11 mV", "11 V", "0.011 V; the unit is written"),
    Row(
        "count - count.previous() > 1", "lost messages", "-255 where it wraps: one in 256 is missed"
    ),
    Row("count - count.previous() < 1", "stuck", "stuck, or wrapped: acts more often"),
    Row("big - big.previous() < 1", "stuck", "rounded: acts while it advances", "DRS375"),
    Row("big = big.previous()", "stuck", "exact: as one thinks"),
    Row("heading.rate() > 1 rad/s", "turns fast", "jumps by a turn at the seam: acts", "DRS367"),
)
SENSORS = (
    Row(NEAR, "something is near", "unknown if no beam is valid", "DRS348"),
    Row(f"failsafe r: {NEAR}", "something is near", "near, or blind", "", ONLY, ""),
    Row("scan.nearest(-30, 30) < 0.5 m", "30 deg", "30 rad", "DRS364 DRS364 DRS348"),
    Row("scan.nearest(30 deg, -30 deg) < 0.5 m", "ahead", "behind", "DRS365 DRS348"),
    Row("scan.ranges[0] < 0.5 m", "ahead", "the beam at angle_min", "DRS382"),
    Row("min(front, rear) < 0.3 m", "either", "unknown while one is", "DRS374", lost="missing()"),
    Row(
        "front.age() > 1 sec",
        "it never came",
        "no timeout: refused",
        "DRS319",
        ONLY,
        "",
        timeout="",
    ),
    Row("front.age() > 0.4 sec", "it never came", "no age before a message", "DRS349", ONLY, ""),
    Row("front.missing()", "it is dead", "no timeout: refused", "DRS319", ONLY, "", timeout=""),
    Row(
        "speed > 1 m/s",
        "it is known",
        "the last value for ever",
        "DRS317 DRS381",
        ONLY,
        "",
        timeout="",
    ),
    Row("front < 0.3 m for 0.5 sec", "lasts", "a NaN ends it", "DRS377", lost="missing()"),
)
LOSSES = (
    Row(
        "front < 0.3 m for 0.5 sec",
        "one of both lasts",
        "a NaN now and then ends either",
        "DRS377",
        then="if e.r or e.u then { stop; };",
        lost="",
        more=SHUT,
    ),
    Row(
        "front < 0.3 m for 0.5 sec",
        "one of both lasts",
        "a NaN now and then ends either, by name",
        "DRS377",
        then="if e.r then { stop; }; if e.u for 1 sec then { stop; };",
        lost="",
        more="u: front.unknown();",
    ),
    Row(
        "front < 0.3 m for 0.5 sec",
        "one of both lasts",
        "the loss has to last since the button",
        "DRS377 DRS349",
        then="if e.r or e.u then { stop; };",
        lost="",
        more="u: button.missing() or (front.unknown() since button);",
    ),
    Row(
        "front < 0.3 m for 0.5 sec",
        "it begins to be lost",
        "at the first NaN: as one thinks",
        then="if e.r or e.u then { stop; };",
        lost="",
        more="u: front.unknown() begins;",
    ),
    Row(
        "front < 0.3 m for 0.5 sec",
        "it was lost",
        "from the first NaN on: as one thinks",
        then="if e.r or e.u then { stop; };",
        lost="",
        more="u: front.unknown() within 1 sec;",
    ),
    Row(
        "(front < 0.3 m or front.unknown()) for 0.5 sec",
        "near or lost lasts",
        "a NaN does not end it: as one thinks",
        "",
        ONLY,
        "",
    ),
    Row(
        "raw - raw.previous() > 1",
        "a jump, or lost for long",
        "a NaN hides the jump",
        "DRS348",
        then="if e.r or e.u then { stop; };",
        lost="",
        more="u: raw.unknown() for 1 sec;",
    ),
    Row(
        "front.missing() and rear.missing()",
        "one sensor is lost",
        "both are; blind on one side",
        "DRS349 DRS349",
        then="if e.r or e.near then { stop; };",
        lost="",
        more="near: front < 0.3 m or rear < 0.3 m;",
    ),
    Row(
        "front < 0.3 m",
        "a loss stops",
        "only while somebody presses the button",
        "DRS349",
        then="if e.r or e.u then { stop; };",
        lost="",
        more="u: (front.missing() and button) or button.missing();",
    ),
    Row(
        "front < 0.3 m",
        "a loss stops",
        "not while it is near: that is unknown",
        "DRS349",
        then="if e.r then { stop; }; if e.u and not e.r then { stop; };",
        lost="",
        more="u: front.missing();",
    ),
    Row(
        "front < 0.3 m and not front.missing()",
        "near, or lost",
        "near and not lost",
        "DRS349",
        ONLY,
        "",
    ),
    Row(
        f"failsafe r: front < 0.3 m and {NEAR}",
        "near, or blind",
        "near to one while the other one is lost, too: as both must be near",
        "",
        ONLY,
        "",
    ),
    Row(
        "button and front < 0.3 m",
        "near while pressed",
        "the loss is asked while pressed, too: as one thinks",
        then="if e.r or e.u or e.v then { stop; };",
        lost="",
        more="u: button and front.missing(); v: button.missing();",
    ),
    Row(
        "button and (front < 0.3 m or front.missing())",
        "near or lost, while pressed",
        "as one thinks",
        then="if e.r or e.v then { stop; };",
        lost="",
        more="v: button.missing();",
    ),
    Row(
        "button and (front < 0.3 m or front.missing() or button.missing())",
        "the loss of the button stops",
        "unknown while it is lost",
        "DRS349",
        ONLY,
        "",
    ),
    Row(
        "speed.abs() > 1 m/s and front < 0.3 m",
        "near and fast",
        "the loss is asked at less speed already: as one thinks",
        then="if e.r or e.u or e.v then { stop; };",
        lost="",
        more="u: speed.abs() > 0.5 m/s and front.missing(); v: speed.missing();",
    ),
    Row(
        "speed.abs() > 1 m/s and front < 0.3 m",
        "near and fast",
        "the loss is asked at more speed alone",
        "DRS349",
        then="if e.r or e.u or e.v then { stop; };",
        lost="",
        more="u: speed.abs() > 2 m/s and front.missing(); v: speed.missing();",
    ),
    Row(
        "front < 0.3 m",
        "pressed or not, a loss stops",
        "so it does, in two behaviours: as one thinks",
        then="if e.r or e.v then { stop; }; if e.u and e.b then { stop; };"
        " if e.u and not e.b then { stop; };",
        lost="",
        more="u: front.missing(); b: button; v: button.missing();",
    ),
    Row("front < 0.3 m", "near, or lost", "near and unknown: never", "DRS349", NESTS),
    Row(
        "front < 0.3 m",
        "near, or lost",
        "lost while the button is pressed",
        "DRS349",
        "if e.r or e.v then { stop; }; if e.b then { if e.lost then { stop; }; };",
        more="b: button; v: button.unknown();",
        lost="missing()",
    ),
    Row(
        "front < 0.3 m",
        "while pressed: near, or lost",
        "as one thinks",
        "",
        "if e.b then { if e.r then { stop; }; if e.u then { stop; }; }; if e.v then { stop; };",
        more="b: button; u: front.unknown(); v: button.unknown();",
        lost="",
    ),
    Row("front < 0.3 m", "the loss stops", "it is logged alone", "DRS349", LOGS),
    Row(NEAR, "being blind stops", "it is logged alone", "DRS349 DRS348", LOGS, BEAMS),
    Row("front < 0.3 m for 1 sec", "a NaN stops", "it is logged alone", "DRS349 DRS377", LOGS),
    Row(
        "front < 0.3 m",
        "near is logged, and the loss",
        "as one thinks: nothing stops",
        "",
        'if e.r or e.u then { log_state("near"); }; if e.b or e.v then { stop; };',
        more="u: front.missing(); b: button; v: button.missing();",
        lost="",
    ),
    Row(
        "front < 0.3 m",
        "the loss stops",
        "the loss releases",
        "DRS349",
        "if e.r then { stop; }; if e.lost then { release; };",
    ),
)
RELEASED = (
    Row(f"failsafe r: {FAR}", "safely clear", "clear, or blind", "DRS350", RELEASES, more=FAST),
    Row(f"failsafe r: {FAR}", "stops if not clear", "not if blind", "DRS350", OPPOSITE),
    Row(FAR, "blind is not clear", "so it is: releases nothing", "", RELEASES, more=BLIND),
    Row(
        "button",
        "pressed now",
        "a press, once; or stuck, after a gap or a start",
        "DRS380",
        RELEASES,
        more=FAST,
    ),
    Row(
        "button and not bad",
        "pressed",
        "or held until danger ends",
        "DRS380",
        RELEASES,
        more=FAST,
    ),
    Row(
        "button begins",
        "a press",
        "or the first message of one that is stuck",
        "DRS380",
        RELEASES,
        more=FAST,
    ),
    Row(
        "button begins and (up within 1 ms)",
        "a press",
        "so it is: it was seen up",
        "",
        RELEASES,
        more=f"{FAST} up: (not button) for 0.1 sec;",
    ),
    Row(
        "(left within 1 sec) and (right within 1 sec)",
        "pressed together",
        "tied down counts as pressed",
        "DRS380",
        RELEASES,
        more=FAST,
    ),
    Row(
        "not bad", "somebody resets", "it resets itself: said by the name", "", RELEASES, more=FAST
    ),
)
ROWS = (*LOGIC, *TIMES, *NUMBERS, *SENSORS, *LOSSES, *RELEASED)


def codes(program: str, folder: Path) -> list[str]:
    """Return the codes of all findings of a program, in the order of the file."""
    return [each.code.name for each in checked_rules(program, SYSTEM, folder)]


@pytest.mark.parametrize("row", ROWS, ids=lambda row: f"{row.rule}; {row.it_means}")
def test_check_says_so(row: Row, tmp_path: Path) -> None:
    """The findings are these, and no others."""
    assert sorted(codes(row.program(), tmp_path)) == sorted(row.found.split())


def test_there_are_enough_of_them() -> None:
    """No row is lost, and no two are equal."""
    assert len(ROWS) >= 60
    assert len({each.program() for each in ROWS}) == len(ROWS)
