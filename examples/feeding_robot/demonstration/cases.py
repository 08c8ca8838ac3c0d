"""The fifteen test cases, in the order in which they are played.

Each says what is done to the robot, which condition that fulfils as the sensors show it, for how
long it must last, and how the robot has to react.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from demonstration.pace import STEP
from demonstration.referee import CYCLE, NOTHING, Condition, Reaction, Referee, RobotState
from demonstration.stage import AUTOMATIC, CONTACTS, LEARN, MANUAL, OverdueError, Stage

SLOW = frozenset({Reaction.LOW_SPEED})
STOP = frozenset({Reaction.STOP})
STOP_AND_ENGINE_OFF = frozenset({Reaction.STOP, Reaction.ENGINE_OFF})

FULL_PEDAL = 1.5
"""Speed, in m/s, with the pedal fully down."""

DRIVING = 0.38
"""Speed, in m/s, from which the mission counts as cruising."""

PLC_TIMEOUT = 0.5
"""Silence, in s, after which the PLC gives the safety node up."""

BEATS = 8
"""Heartbeats, ten a second, in which an input is found missing that the node never heard."""

ATTEMPTS = 5
"""How often a robot is prepared that is stopped meanwhile."""

SIGNS_OF_LIFE = 3
"""Signs of life of the mission after which a command of it has come that was sent after a reset."""

MARGIN = 1.0
"""How long, in s, a case without a reaction is watched once a wrong one would have been due."""


@dataclass(frozen=True)
class Case:
    """One test case.

    Attributes:
        provoke: does to the robot what the title says; may wait for the referee to see it.
        condition: what that fulfils, as the sensors show it.
        hold: for how long, in s, the condition must last for a reaction to be due.
        expected: how the robot must react; nothing else may happen.
        acts: the messages that carry the reaction; its time ends with the last of them.
        driving: whether the mission drives when the case begins.
        simulated: whether the case is played on simulated time.
        silence_of: where the condition is a silence, the messages that are silent.
        within: for how long, in s of real time, a reaction is awaited; on simulated time, how
            long a step may take.
    """

    number: int
    title: str
    provoke: Callable[[Stage, Referee], None]
    condition: Condition
    expected: frozenset[Reaction]
    acts: frozenset[str] = frozenset()
    hold: float = 0.0
    driving: bool = True
    simulated: bool = False
    silence_of: str | None = None
    within: float = 15.0

    def referee(self, state: RobotState) -> Referee:
        """Return a referee who watches this case from ``state`` on."""
        # On simulated time a message may reach the safety node in the step before or after.
        resolution = 1.01 * STEP if self.simulated else CYCLE
        return Referee(
            self.condition,
            self.hold,
            self.expected,
            self.acts,
            state,
            self.silence_of,
            resolution,
        )


def prepare(stage: Stage, driving: bool) -> None:
    """Bring the robot into a clean state: automatic mode, engine on, nothing in the way.

    Where a busy machine holds a node up meanwhile, the robot is stopped as for a lost sensor. Then
    the operator begins anew, as on the field.
    """
    for _ in range(ATTEMPTS):
        _prepare(stage, driving)
        if not driving:
            return
        stage.watch(lambda: _drives(stage.state) or _is_stopped(stage.state), 60.0)
        if _drives(stage.state):
            return
    raise OverdueError(f"prepared the robot {ATTEMPTS} times, and the mission did not drive")


def _is_stopped(state: RobotState) -> bool:
    return state.stop is True or state.motor_stop is True or state.engine_running is False


def _prepare(stage: Stage, driving: bool) -> None:
    stage.forget(heartbeat=None)
    stage.obstacle(math.inf)
    stage.hold_pedal(math.nan)
    stage.level_ground()
    for contact in CONTACTS:
        stage.touch(contact, pressed=False)
    stage.turn_key(False)
    stage.order(False)
    stage.switch_mode(LEARN)
    stage.wait("a safety node that knows whom it hears", _knows_its_inputs, 60.0)
    stage.wait("a robot that stands free", _stands_free)
    _reset_actions(stage)
    if driving:
        _reset_gate(stage)
    _start_engine(stage)
    stage.order(driving)
    stage.switch_mode(AUTOMATIC)
    stage.wait("automatic mode", lambda s: s.mode == AUTOMATIC)


def _start_engine(stage: Stage) -> None:
    """Turn the key, again where the PLC has turned the engine off: it had no sign of life yet.

    At the start the nodes have yet to find each other. In automatic mode the key does nothing.
    """

    def is_off() -> bool:
        return stage.state.engine_running is False

    while True:
        stage.turn_key(True)
        stage.wait("the engine to run", lambda s: s.engine_running is True)
        stage.turn_key(False)
        if not stage.watch(is_off, 2 * PLC_TIMEOUT):
            return


def _knows_its_inputs(state: RobotState) -> bool:
    return state.heartbeat is not None and state.heartbeat >= BEATS


def _drives(state: RobotState) -> bool:
    return state.speed is not None and state.speed > DRIVING


def _stands_free(state: RobotState) -> bool:
    released = all(getattr(state, contact) is False for contact in CONTACTS)
    return state.halted and released and state.nearest == math.inf


def _reset_actions(stage: Stage) -> None:
    """Take the robot over in manual mode, then reset the latched motor stop.

    The safety node hears mode and contacts on topics of their own, in no order that the player
    could rely on; where it refuses, the operator turns the switch again.
    """
    patience_ends = time.monotonic() + 40.0  # at the start the nodes have yet to find each other
    while time.monotonic() < patience_ends:
        stage.switch_mode(LEARN)
        _await_reports(stage, LEARN)
        stage.switch_mode(MANUAL)
        _await_reports(stage, MANUAL)
        granted = stage.state.motor_stop is False or stage.reset("safety")
        if granted and stage.watch(lambda: _is_reset(stage.state), 1.0):
            return
    raise OverdueError("the safety node did not let its actions be reset")


def _reset_gate(stage: Stage) -> None:
    """Reset the gate, which holds the robot since its start, or since the safety node was lost.

    After a crash of the safety node, it refuses that until the dead one is forgotten: 20 s.
    """
    patience_ends = time.monotonic() + 60.0
    while time.monotonic() < patience_ends:
        if stage.reset("gate"):
            _await_zero_commands(stage)
            return
        stage.watch(lambda: False, 0.5)
    raise OverdueError("the gate did not let itself be reset")


def _await_zero_commands(stage: Stage) -> None:
    """Wait until the mission has commanded zero, for which the gate waits after a reset.

    With each sign of life it sends a command. One may have been on its way before the reset.
    """

    def is_another(before: int | None, state: RobotState) -> bool:
        return state.controller_keep_alive != before

    for _ in range(SIGNS_OF_LIFE):
        stage.wait("a command", partial(is_another, stage.state.controller_keep_alive))


def _is_reset(state: RobotState) -> bool:
    actions_off = state.low_speed is False and state.stop is False and state.motor_stop is False
    return actions_off and state.controller_ok is True


def _await_reports(stage: Stage, mode: int) -> None:
    """Wait until the PLC has reported a mode twice: others have then heard it, too."""
    stage.wait(f"mode {mode}", lambda s: s.mode == mode)
    before = stage.state.plc_keep_alive or 0
    stage.wait("the PLC's report", lambda s: (s.plc_keep_alive or 0) >= before + 2)


def play(case: Case, stage: Stage) -> Referee:
    """Play one case from a prepared state and return the referee who watched it.

    Raises:
        OverdueError: if the system has ended.
    """
    referee = case.referee(stage.state)
    stage.listen(referee.feed)
    try:
        case.provoke(stage, referee)
        _await_end(case, stage, referee)
    finally:
        stage.unlisten(referee.feed)
    return referee


def _await_end(case: Case, stage: Stage, referee: Referee) -> None:
    """Wait for the expected reaction; the referee's verdict tells what did not come in time."""
    if not case.expected:
        return
    if not case.simulated:
        stage.watch(lambda: referee.complete, case.within)
        return
    # How fast simulated time passes is the machine's affair, as long as it does.
    end = stage.now + round((case.hold + MARGIN) * 1e9)
    while not referee.complete and stage.now < end:
        if not _moves_on(stage, case.within):
            return


def _moves_on(stage: Stage, patience: float) -> bool:
    """Wait for time to pass; return whether it has, within so many seconds of real time."""
    now = stage.now
    return stage.watch(lambda: stage.now > now, patience)


def _obstacle(distance: float, stage: Stage, _referee: Referee) -> None:
    stage.obstacle(distance)


def _touch(contact: str, stage: Stage, _referee: Referee) -> None:
    stage.touch(contact)


def _drive_at(speed: float, stage: Stage, _referee: Referee) -> None:
    stage.hold_pedal(speed / FULL_PEDAL)


def _drive_briefly(speed: float, duration: float, stage: Stage, referee: Referee) -> None:
    """Hold a speed for a while, let go, and watch until a reaction would long have come."""
    stage.hold_pedal(speed / FULL_PEDAL)
    stage.watch(lambda: referee.held(stage.now, duration), 10.0)
    begun = referee.fulfilled
    stage.hold_pedal(math.nan)
    if begun is not None:
        end = begun + round((referee.hold + MARGIN) * 1e9)
        stage.watch(lambda: stage.now >= end, 10.0)


def _kill(stage: Stage, referee: Referee) -> None:
    """Kill the safety node between two heartbeats: the last one has reached everybody by then."""
    stage.watch(lambda: referee.held(stage.now, 0.03), 5.0)
    stage.kill_safety_node()


def _nothing(_stage: Stage, _referee: Referee) -> None:
    pass


def _between(lower: float, upper: float) -> Condition:
    return lambda s: s.nearest is not None and lower <= s.nearest < upper


def _faster(speed: float) -> Condition:
    return lambda s: s.speed is not None and s.speed > speed


def _faster_backward(speed: float) -> Condition:
    return lambda s: s.speed is not None and s.speed < -speed


def _contact(name: str) -> Condition:
    return lambda s: getattr(s, name) is True


def _anything(_state: RobotState) -> bool:
    return True


def _idles(state: RobotState) -> bool:
    return state.halted and state.engine_running is True and state.mode == AUTOMATIC


ENGINE_STOP = frozenset({"stop", "motor_stop"})

CASES: tuple[Case, ...] = (
    Case(
        1,
        "Obstacle, warning zone",
        partial(_obstacle, 3.5),
        _between(2.0, 4.0),
        SLOW,
        frozenset({"low_speed"}),
    ),
    Case(
        2,
        "Obstacle, stop zone",
        partial(_obstacle, 1.5),
        _between(0.8, 2.0),
        STOP,
        frozenset({"stop"}),
    ),
    Case(
        3,
        "Obstacle, collision zone",
        partial(_obstacle, 0.6),
        _between(0.0, 0.8),
        STOP,
        frozenset({"stop"}),
    ),
    Case(
        4,
        "Front bumper",
        partial(_touch, "front_bumper"),
        _contact("front_bumper"),
        STOP_AND_ENGINE_OFF,
        ENGINE_STOP,
    ),
    Case(
        5,
        "Rear bumper",
        partial(_touch, "rear_bumper"),
        _contact("rear_bumper"),
        STOP_AND_ENGINE_OFF,
        ENGINE_STOP,
    ),
    Case(
        6,
        "Feeding arm hit",
        partial(_touch, "feeding_arm"),
        _contact("feeding_arm"),
        STOP_AND_ENGINE_OFF,
        ENGINE_STOP,
    ),
    Case(
        7,
        "Stop button",
        partial(_touch, "stop_button"),
        _contact("stop_button"),
        STOP_AND_ENGINE_OFF,
        ENGINE_STOP,
    ),
    Case(
        8,
        "Above 0.5 m/s for 3 s",
        partial(_drive_briefly, 0.75, 3.0),
        _faster(0.5),
        NOTHING,
        hold=4.0,
    ),
    Case(
        9,
        "Above 0.5 m/s for 4 s",
        partial(_drive_at, 0.75),
        _faster(0.5),
        STOP_AND_ENGINE_OFF,
        ENGINE_STOP,
        hold=4.0,
    ),
    Case(
        10,
        "Above 1 m/s",
        partial(_drive_at, 1.3),
        _faster(1.0),
        STOP_AND_ENGINE_OFF,
        ENGINE_STOP,
    ),
    Case(
        11,
        "Back 0.25 m/s for 1.3 s",
        partial(_drive_briefly, -0.32, 1.3),
        _faster_backward(0.25),
        NOTHING,
        hold=2.0,
    ),
    Case(
        12,
        "Back 0.25 m/s for 2 s",
        partial(_drive_at, -0.32),
        _faster_backward(0.25),
        STOP_AND_ENGINE_OFF,
        ENGINE_STOP,
        hold=2.0,
    ),
    Case(
        13,
        "Back above 0.4 m/s",
        partial(_drive_at, -0.6),
        _faster_backward(0.4),
        STOP_AND_ENGINE_OFF,
        ENGINE_STOP,
    ),
    Case(
        14,
        "Safety node killed",
        _kill,
        _anything,
        STOP_AND_ENGINE_OFF,
        frozenset({"engine_enabled"}),
        hold=PLC_TIMEOUT,
        silence_of="heartbeat",
    ),
    Case(
        15,
        "Ten minutes at a stand",
        _nothing,
        _idles,
        STOP_AND_ENGINE_OFF,
        ENGINE_STOP,
        hold=600.0,
        driving=False,
        simulated=True,
    ),
)
