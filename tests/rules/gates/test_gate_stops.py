"""How gates stop: ramps, what is sent, holding, silence, and limits that stand."""

from __future__ import annotations

from typing import Any

import pytest

from deros.generators.runtime.python.deros_runtime.gate_logic import Gate
from deros.generators.runtime.python.deros_runtime.gate_table import ZERO, Line, Table
from deros.rules.gates.gate_engine import GateEngine, Output
from tests.support.gates import STORE
from tests.support.rules import program

MS = 1_000_000
ACTIONS = """action stop publishes true on /stop : std_msgs.Bool latched;
action slow publishes true on /slow : std_msgs.Bool latched;
"""


class Played:
    """A gate whose lines are given, and what it publishes; times in milliseconds."""

    def __init__(self, lines: str, kind: str = "geometry_msgs.Twist") -> None:
        """Build the gate, with a rate of 10 Hz."""
        built = program(f"{ACTIONS}gate /wish -> /command : {kind} rate 10 Hz {{ {lines} }}")
        self.gate = GateEngine(built.gates[0], built.actions, STORE)
        self.state(0, stop=False, slow=False)

    def state(self, t_ms: int, **active: bool) -> list[tuple[int, str, Any]]:
        """Pass states of actions; return what is published."""
        made = [
            self.gate.state(t_ms * MS, f"/{name}", {"data": value})
            for name, value in active.items()
        ]
        return [_shown(each) for outputs in made for each in outputs]

    def command(self, t_ms: int, message: Any) -> list[tuple[int, str, Any]]:
        """Pass a command: of a twist, its ``linear.x`` and ``angular.z``."""
        if isinstance(message, tuple):
            message = twist(*message)
        return [_shown(each) for each in self.gate.command(t_ms * MS, message)]

    def until(self, t_ms: int) -> list[tuple[int, str, Any]]:
        """Let time pass."""
        return [_shown(each) for each in self.gate.advance(t_ms * MS)]


def twist(x: float, z: float) -> dict[str, Any]:
    """Return a command of a speed and a turning rate."""
    return {
        "linear": {"x": x, "y": 0.0, "z": 0.0},
        "angular": {"x": 0.0, "y": 0.0, "z": z},
    }


def _shown(output: Output) -> tuple[int, str, Any]:
    message = output.message
    if "linear" in message:
        return output.t_ns // MS, output.kind, (message["linear"]["x"], message["angular"]["z"])
    return output.t_ns // MS, output.kind, message.get("data", message)


RAMP = "stop: zero ramp linear.x 2 m/s2;"


def test_ramp_falls_by_its_rate_from_the_last_command() -> None:
    """The field goes to zero in half a second; the one without a ramp is zero at once."""
    gate = Played(RAMP)
    assert gate.command(10, (1.0, 0.5)) == [(10, "pass", (1.0, 0.5))]
    assert gate.state(50, stop=True) == [(50, "zero", (1.0, 0.0))]
    assert [each for t_ms in range(150, 651, 100) for each in gate.until(t_ms)] == [
        (150, "zero", (0.8, 0.0)),
        (250, "zero", (0.6, 0.0)),
        (350, "zero", (0.4, 0.0)),
        (450, "zero", (pytest.approx(0.2), 0.0)),
        (550, "zero", (0.0, 0.0)),
        (650, "zero", (0.0, 0.0)),
    ]


def test_ramp_falls_from_below_zero_and_after_a_hang_without_a_jump() -> None:
    """One late message replaces those that are overdue, and is where the ramp is by then."""
    gate = Played(RAMP)
    gate.command(10, (-1.0, 0.0))
    gate.state(50, stop=True)
    late = gate.until(400)
    assert late == [(150, "zero", (pytest.approx(-0.3), 0.0))]
    assert gate.until(450) == [(450, "zero", (pytest.approx(-0.2), 0.0))]


def test_earlier_line_without_a_ramp_stops_at_once() -> None:
    """When it ends, the ramp does not lift the robot to where it would have been."""
    gate = Played("slow: zero; stop: zero ramp linear.x 1 m/s2;")
    gate.command(10, (1.0, 0.0))
    assert gate.state(50, stop=True) == [(50, "zero", (1.0, 0.0))]
    assert gate.state(100, slow=True) == [(100, "zero", (0.0, 0.0))]
    assert gate.state(120, slow=False) == [(120, "zero", (0.0, 0.0))]


def test_other_ramp_goes_on_from_where_the_field_is() -> None:
    """0.2 s at 1 m/s2 and 0.1 s at 4 m/s2."""
    gate = Played("slow: zero ramp linear.x 4 m/s2; stop: zero ramp linear.x 1 m/s2;")
    gate.command(0, (1.0, 0.0))
    gate.state(0, stop=True)
    gate.until(100)
    assert gate.state(200, slow=True) == [
        (200, "zero", (0.8, 0.0)),  # the period
        (200, "zero", (0.8, 0.0)),
    ]
    assert gate.until(300) == [(300, "zero", (pytest.approx(0.4), 0.0))]


def test_limit_after_a_hold_narrows_what_was_held() -> None:
    """Of a command that came meanwhile and was never published, nothing gets through."""
    gate = Played("slow: limit linear.x to [-0.2, 0.2] m/s; stop: hold;")
    gate.command(0, (1.0, 0.5))
    assert gate.state(0, stop=True) == [(0, "hold", (1.0, 0.5))]
    assert gate.command(10, (-0.1, 2.0)) == []
    gate.state(20, stop=False)
    assert gate.state(30, slow=True) == [(30, "limited", (0.2, 0.5))]


def test_ramp_after_a_limit_of_a_lost_input_stays_at_zero() -> None:
    """What stood still as the input was lost does not set off again when it returns."""
    gate = Played(f"lost input for 0.3 sec: limit linear.x to [-0.5, 0.5] m/s; {RAMP}")
    gate.command(10, (1.0, 0.0))
    assert gate.state(200, stop=True) == [(200, "zero", (1.0, 0.0))]
    assert gate.until(300) == [(300, "zero", (0.8, 0.0))]
    assert gate.until(310) == [(310, "zero", (0.0, 0.0))]
    assert gate.command(320, (1.0, 0.0)) == [(320, "zero", (0.0, 0.0))]
    assert gate.until(420) == [(420, "zero", (0.0, 0.0))]


def test_ramp_after_a_limit_falls_from_what_was_published() -> None:
    """While the limit leaves the field to the command, it has followed that; it goes on so."""
    gate = Played(f"slow: limit linear.x to [-0.2, 0.2] m/s; {RAMP}")
    gate.command(0, (1.0, 0.0))
    assert gate.state(0, slow=True) == [(0, "limited", (0.2, 0.0))]
    assert gate.state(0, stop=True) == [(0, "zero", (0.2, 0.0))]
    gate.command(10, (-0.1, 0.0))
    assert gate.until(100) == [(100, "zero", (-0.1, 0.0))]
    assert gate.state(120, slow=False) == [(120, "zero", (pytest.approx(-0.06), 0.0))]
    assert gate.until(220) == [(220, "zero", (0.0, 0.0))]


def test_ramp_goes_on_after_a_line_that_ended_for_a_moment() -> None:
    """Without a command meanwhile, the robot still obeys the last step of the ramp."""
    gate = Played(RAMP)
    gate.command(0, (1.0, 0.0))
    gate.state(0, stop=True)
    assert gate.until(100) == [(100, "zero", (0.8, 0.0))]
    assert gate.state(120, stop=False) == []
    assert gate.state(150, stop=True) == [(150, "zero", (0.8, 0.0))]
    assert gate.until(250) == [(250, "zero", (pytest.approx(0.6), 0.0))]


def test_ramp_goes_on_while_the_gate_waits() -> None:
    """A line that ends in the middle of its ramp does not make the robot stop at once."""
    gate = Played(f"{RAMP} resume on zero command;")
    gate.command(0, (0.0, 0.0))
    gate.command(10, (1.0, 0.0))
    gate.state(50, stop=True)
    assert gate.state(60, stop=False) == []
    assert gate.until(150) == [(150, "zero", (0.8, 0.0))]
    assert gate.command(200, (1.0, 0.0)) == []
    assert gate.command(220, (0.0, 0.0)) == [(220, "pass", (0.0, 0.0))]


def test_flag_is_sent_and_its_safe_value_ends_the_wait() -> None:
    """False is what the line sends: a command of it lets the next ones pass."""
    lines = "stop: send { data = false } until reset; resume on zero command;"
    gate = Played(lines, "std_msgs.Bool")
    gate.gate.reset(0)
    assert gate.command(10, {"data": True}) == []
    assert gate.command(20, {"data": False}) == [(20, "pass", False)]
    assert gate.command(30, {"data": True}) == [(30, "pass", True)]
    assert gate.state(40, stop=True) == [(40, "send", False)]
    assert gate.until(140) == [(140, "send", False)]


def test_value_that_is_sent_need_not_be_zero() -> None:
    """A brake is applied by true: only such a command ends the wait, zero does not."""
    gate = Played("stop: send { data = true }; resume on zero command;", "std_msgs.Bool")
    assert gate.command(10, {"data": False}) == []
    assert gate.command(20, {"data": True}) == [(20, "pass", True)]


def test_array_is_emptied() -> None:
    """The names of the joints are those of the last command."""
    gate = Played("stop: send { points = [] };", "trajectory_msgs.JointTrajectory")
    header = {"stamp": {"sec": 1, "nanosec": 0}, "frame_id": "arm"}
    point = {
        **{name: [1.0] for name in ("positions", "velocities", "accelerations", "effort")},
        "time_from_start": {"sec": 1, "nanosec": 0},
    }
    gate.command(10, {"header": header, "joint_names": ["a"], "points": [point]})
    ((_, kind, message),) = gate.state(20, stop=True)
    assert (kind, message["points"], message["joint_names"]) == ("send", [], ["a"])
    assert message["header"] == {"stamp": {"sec": 0, "nanosec": 20 * MS}, "frame_id": "arm"}


def test_hold_repeats_the_last_command_while_there_is_one() -> None:
    """After a zero there is none: the robot is not set going again."""
    gate = Played("stop: zero; slow: hold;")
    gate.command(10, (1.0, 0.5))
    assert gate.state(20, slow=True) == [(20, "hold", (1.0, 0.5))]
    assert gate.command(30, (0.2, 0.0)) == []
    assert gate.until(120) == [(120, "hold", (1.0, 0.5))]
    assert gate.state(130, stop=True) == [(130, "zero", (0.0, 0.0))]
    assert gate.state(140, stop=False) == []
    assert gate.until(900) == []


def test_silence_publishes_nothing_and_leaves_nothing_to_hold() -> None:
    """A ramp after a silence does not start from a command that is no longer obeyed."""
    gate = Played("slow: silence; stop: zero ramp linear.x 1 m/s2;")
    gate.command(10, (1.0, 0.0))
    assert gate.state(20, slow=True) == []
    assert gate.until(900) == []
    assert gate.state(910, stop=True) == []
    assert gate.state(920, slow=False) == [(920, "zero", (0.0, 0.0))]


def test_standing_limits_hold_from_the_first_command_on() -> None:
    """They hold beside the limits of other lines, whatever the order."""
    gate = Played(
        "slow: limit linear.x to [-2, 0.3] m/s; always: limit linear.x to [-0.5, 1] m/s,"
        " angular.z to [0, 0];"
    )
    assert gate.command(10, (3.0, 0.5)) == [(10, "limited", (1.0, 0.0))]
    assert gate.command(20, (0.5, 0.0)) == [(20, "pass", (0.5, 0.0))]
    assert gate.state(30, slow=True) == [(30, "limited", (0.3, 0.0))]
    assert gate.command(40, (-3.0, 0.0)) == [(40, "limited", (-0.5, 0.0))]
    assert gate.gate.standing == ("always: limit linear.x to [-0.5, 1] m/s, angular.z to [0, 0]",)
    assert gate.gate.applying == (True, False)


def test_number_left_to_the_command_keeps_within_standing_limits() -> None:
    """An earlier limit leaves it to the command, where no line waits for a zero."""
    gate = Played(
        "slow: limit linear.x to [-2, 2] m/s; always: limit linear.x to [-0.5, 1] m/s; stop: zero;"
    )
    gate.state(5, slow=True)
    gate.command(10, (3.0, 0.5))
    assert gate.state(20, stop=True) == [(20, "zero", (1.0, 0.0))]


def test_step_back_of_the_clock_ends_a_ramp() -> None:
    """Nothing is known about what has been published in another time."""
    gate = Played(RAMP)
    gate.command(500, (1.0, 0.0))
    gate.state(600, stop=True)
    assert gate.until(100) == [(100, "zero", (0.0, 0.0))]


WAIT = "wait 200 ms before moving: slow; lost input for 5 sec: zero;"


def test_command_that_moves_waits_for_the_action() -> None:
    """It is held at zero for as long; the wish that comes after that passes."""
    gate = Played(WAIT)
    assert gate.command(10, (0.4, 0.0)) == []  # zero goes on
    assert gate.gate.applying == (True, False)
    assert gate.state(50, slow=True) == []
    assert gate.command(100, (0.4, 0.0)) == [(100, "zero", (0.0, 0.0))]
    assert gate.until(249) == [(200, "zero", (0.0, 0.0))]
    assert gate.command(249, (0.4, 0.0)) == []
    assert gate.command(250, (0.4, 0.0)) == [(250, "pass", (0.4, 0.0))]
    assert gate.gate.applying == (False, False)
    assert gate.command(260, (0.5, 0.0)) == [(260, "pass", (0.5, 0.0))]
    assert gate.until(900) == []


def test_wait_counts_from_the_wish_though_the_action_is_older() -> None:
    """A horn that has sounded for a while did not warn of this motion."""
    gate = Played(WAIT)
    gate.state(0, slow=True)
    gate.command(500, (0.4, 0.0))
    assert gate.command(650, (0.4, 0.0)) == [(600, "zero", (0.0, 0.0))]
    assert gate.command(700, (0.4, 0.0)) == [
        (700, "zero", (0.0, 0.0)),
        (700, "pass", (0.4, 0.0)),
    ]


def test_zero_command_passes_and_ends_the_wait() -> None:
    """Whoever stands again is warned again before the next motion."""
    gate = Played(WAIT)
    gate.state(0, slow=True)
    gate.command(10, (0.4, 0.0))
    assert gate.command(50, (0.0, 0.0)) == [(50, "pass", (0.0, 0.0))]
    assert gate.command(210, (0.4, 0.0)) == [(210, "zero", (0.0, 0.0))]
    gate.until(400)
    assert gate.command(410, (0.4, 0.0))[-1] == (410, "pass", (0.4, 0.0))
    assert gate.command(420, (0.0, 0.0)) == [(420, "pass", (0.0, 0.0))]
    assert gate.command(430, (0.4, 0.0)) == [(430, "zero", (0.0, 0.0))]


def test_action_that_ends_meanwhile_starts_the_wait_over() -> None:
    """So does one that the gate does not know any more, or knows from another node."""
    gate = Played(WAIT)
    gate.state(0, slow=True)
    gate.command(0, (0.4, 0.0))
    gate.state(150, slow=False)
    gate.state(160, slow=True)
    assert gate.command(350, (0.4, 0.0))[-1][1] == "zero"
    assert gate.command(360, (0.4, 0.0))[-1] == (360, "pass", (0.4, 0.0))
    unknown = Played(WAIT)
    unknown.command(0, (0.4, 0.0))
    unknown.gate.state(10 * MS, "/slow", {"data": True}, is_trusted=False)
    assert unknown.command(900, (0.4, 0.0))[-1][1] == "zero"


def test_stop_has_the_next_motion_wait_again() -> None:
    """After a stop the robot stands."""
    gate = Played(f"stop: zero; {WAIT}")
    gate.state(0, slow=True)
    gate.command(0, (0.4, 0.0))
    gate.until(190)
    gate.command(200, (0.4, 0.0))
    assert gate.state(300, stop=True) == [(300, "zero", (0.0, 0.0))]
    gate.state(310, stop=False)
    assert gate.command(320, (0.4, 0.0)) == [(320, "zero", (0.0, 0.0))]


def test_untrusted_state_says_more_if_an_action_is_awaited() -> None:
    """So a gate that does not know the sender of a message finds out whose it is."""
    lines = (Line("wait", action="horn", wait_ns=200), Line("stop", action="stop", stop=ZERO))
    gate = Gate(Table(lines, ("horn", "stop"), (), 100), 0, lambda _what, _values: None)
    assert gate.on_state(1, {"stop": True}, False)
    assert not gate.on_state(2, {"horn": True}, False)
    assert gate.on_state(3, {"horn": True}, True)
    assert gate.on_state(4, {"horn": True}, False)
    gate.on_no_safety_node(5)
    assert not gate.on_state(6, {"horn": True}, False)
