"""The robots whose faults are shown: what is started, and what the safety node is to say."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path

EXAMPLES = Path(__file__).resolve().parents[2]

_ANSWER = "stop: a wheel does not turn in spite of thrust"
_ASTRAY = "stop: a wheel does not follow its setpoint"
_FAST = "stop: too fast"
_TILTED = "stop: tilted"
_SPINS = "stop: it spins"
_NEAR = "stop: obstacle in the stop zone"
_SILENT = "stop: a wheel or the odometry is silent"


@dataclass(frozen=True)
class Robot:
    """A robot and its faults.

    Attributes:
        name: of its folder among the examples.
        system: the model that is started, in a folder of the examples.
        folders: those of the examples whose packages it needs.
        faults: the value of the argument ``fault`` for each, and how the reason begins that the
            safety node gives.
        arguments: others of the system.
        argument: the one that names the fault, empty if the robot has one fault only.
        motion: the topic on which the robot says how it moves.
        stop: the topic on which the safety node stops it.
    """

    name: str
    system: str
    folders: tuple[str, ...]
    faults: dict[str, str]
    arguments: dict[str, str] = field(default_factory=dict)
    argument: str = "fault"
    motion: str = "/odometry"
    stop: str = "/safety/stop"


ROBOTS = (
    Robot(
        "frobit",
        "frobit/frobit.system",
        ("frobit",),
        {"left_encoder": _ANSWER, "right_motor": _ASTRAY, "left_throttle": _ASTRAY},
        {"rehearsal": "true"},
    ),
    Robot(
        "kobuki",
        "kobuki/kobuki.system",
        ("kobuki",),
        {
            "throttle": _FAST,
            "spin": _SPINS,
            "load": "stop: the pilot needs too much of the processor",
            "astray": "stop: outside the yard",
        },
    ),
    Robot(
        "intelligent_one",
        "intelligent_one/intelligent_one.system",
        ("intelligent_one",),
        {"speed": _FAST},
        argument="",
        stop="/stop",
    ),
    # Without physics, its fifteen cases are another demo.
    Robot(
        "feeding_robot", "feeding_robot/feeding_robot.system", ("feeding_robot",), {}, argument=""
    ),
)

_IN_PHYSICS = {
    "frobit": {
        "left_encoder": _ANSWER,
        "right_motor": _ASTRAY,
        "left_throttle": _ASTRAY,
        "runaway": _FAST,
        "line": _SILENT,
    },
    "kobuki": {
        "left_encoder": _SPINS,
        "runaway": _FAST,
        "gyro": _SPINS,
        "line": "stop: ",  # three rules lose their sensors at once
    },
    # One that runs away is stopped, but does not come to rest: there is no relay.
    "intelligent_one": {
        "gyro": _TILTED,
        "line": "stop: ",  # both rules do
        "bank": _TILTED,
    },
    # A cut encoder is found by the walls that come near, but the wheel does not come to rest.
    "feeding_robot": {
        "obstacle": _NEAR,
        "person": _NEAR,
        "crate": "motor stop: bumper",
        "ramp": "motor stop: tilt limit exceeded",
        "runaway": "motor stop: speed limit exceeded",
        "lidar_dirt": "stop: a sensor is silent",
    },
}

_REHEARSED = {"feeding_robot": {"rehearsal": "true"}}


def in_physics(robot: Robot, simulated: bool = False) -> Robot:
    """Return a robot with its hardware in physics, and the faults that this can have.

    All its nodes have the time of the machine, or that of the physics.
    """
    return replace(
        robot,
        system=f"physics/{robot.name}_in_physics.system",
        # The drivers of two robots there reckon their way with what the Frobit has for that.
        folders=(*dict.fromkeys((*robot.folders, "frobit")), "physics"),
        faults=_IN_PHYSICS[robot.name],
        arguments={
            **robot.arguments,
            **_REHEARSED.get(robot.name, {}),
            "use_sim_time": str(simulated).lower(),
        },
        argument="fault",
        motion="/truth",
    )
