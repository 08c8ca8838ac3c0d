"""A robot's reports, drawn: what a safety node with three rules and a gate say."""

from __future__ import annotations

from deros.live.watched import Watched
from tests.support.drawn_diagnostics import Drawn, array, status

OK, WARN, ERROR, STALE = range(4)

GUARD: Drawn = ("/guard", OK, "watching 3 rules", {"state": "watching"})
STOP: Drawn = (
    "/guard: action stop",
    WARN,
    "active",
    {
        "runs": "1",
        "cause": "near",
        "because": "body.near: ahead 0.2 < 0.3 m",
        "since": "2.150 s ago",
    },
)
STOP_RESET: Drawn = ("/guard: action stop", OK, "inactive", {"runs": "1", "cause": "near"})
NEAR: Drawn = (
    "/guard: body.near",
    ERROR,
    "true: near: ahead < 0.3 m;",
    {
        "ahead": "0.2",
        "cause": "ahead 0.2 < 0.3 m",
        "since": "2.150 s ago",
        "line": "7",
        "if values stay": "false in 2.350 s",
        "if no message comes": "unknown in 0.380 s",
    },
)
FAST: Drawn = (
    "/guard: drive.fast",
    OK,
    "false: fast: speed > max_speed;",
    {
        "speed": "0.31",
        "max_speed": "0.5",
        "since": "95.000 s ago",
        "since_ns": "1",
        "line": "8",
        "if no message comes": "unknown in 0.480 s",
    },
)
HOT: Drawn = ("/guard: motor.hot", STALE, "unknown: hot: heat > 80;", {"heat": "unknown"})
INPUTS: Drawn = (
    "/guard: inputs",
    OK,
    "never received: heat",
    {"ahead": "0.120 s ago", "speed": "0.020 s ago", "heat": "never"},
)
GATE: Drawn = (
    "/gate",
    WARN,
    "stop: zero (robot.deros:24); waits for a reset",
    {"since": "2.100 s ago", "since_ns": "1", "refused": "0"},
)
REPORT = (GUARD, STOP, NEAR, FAST, HOT, INPUTS)

TRIGGER_NS = 1_795_808_461_579_784_035
"""19:41:01.579 in UTC."""

TRIGGER: Drawn = (
    "/guard",
    WARN,
    "stop, by near (robot.deros:12): body.near: ahead 0.2 < 0.3 m",
    {"kind": "trigger", "action": "stop", "ros_time_ns": str(TRIGGER_NS)},
)
START: Drawn = (
    "/guard",
    OK,
    "watching 3 rules of robot.deros",
    {"kind": "start", "ros_time_ns": str(TRIGGER_NS - 95 * 10**9)},
)


class Clock:
    """A steady time that a test moves."""

    def __init__(self) -> None:
        """Start at a time that is not zero."""
        self.now = 100.0

    def __call__(self) -> float:
        """Return the time, in seconds."""
        return self.now


def watched(clock: Clock, *reports: tuple[Drawn, ...]) -> Watched:
    """Return what has been taken: by default, two reports of both nodes and their events."""
    found = Watched(silence_s=3.0, now=clock)
    for report in reports or (REPORT, REPORT, (GATE,)):
        found.take(array(*report))
    if not reports:
        for event in (START, TRIGGER):
            found.take_event("/guard", status(*event))
    return found
