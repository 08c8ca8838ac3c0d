"""The reference gate: one timeline for each sentence of its definition."""

from __future__ import annotations

import pytest

from deros.rules.gates.gate_engine import GateEngine
from tests.support.gate_driver import HEARTBEAT, INPUT, LOW, STOP, Driver, at, shown, twist
from tests.support.rules import embedded_store, program

# Lines of actions ---------------------------------------------------------------------------------


def test_command_passes_unchanged_and_at_once() -> None:
    """If no line applies, the same message is published at the same time."""
    gate = Driver(STOP, LOW, HEARTBEAT, INPUT).open()
    command = twist(5.0, -3.0)
    (output,) = gate.engine.command(at(20), command)
    assert (output.t_ns, output.kind) == (at(20), "pass")
    assert output.message is command


def test_stop_publishes_zero_at_once_and_periodically() -> None:
    """A stop publishes zero immediately without a command, and then every period."""
    gate = Driver(STOP, HEARTBEAT).open()
    gate.drive(10, 0.5)
    assert gate.state(33, "stop", True) == [(33, "zero", 0.0)]
    assert gate.wait(150) == [(83, "zero", 0.0), (133, "zero", 0.0)]


def test_commands_are_not_published_during_a_stop() -> None:
    """Commands neither pass nor cause extra zeros; the period is unchanged."""
    gate = Driver(STOP).open()
    gate.state(0, "stop", True)
    assert gate.drive(20, 0.5) == gate.drive(49, 0.5) == []
    assert gate.wait(100) == [(50, "zero", 0.0), (100, "zero", 0.0)]


def test_no_stored_command_is_published_after_a_stop() -> None:
    """The next command is the first to pass."""
    gate = Driver(STOP).open()
    gate.state(0, "stop", True)
    gate.drive(20, 0.5)
    assert gate.state(30, "stop", False) == []
    assert gate.wait(1000) == []
    assert gate.drive(1001, 0.6) == [(1001, "pass", 0.6)]


def test_limit_applies_to_commands() -> None:
    """Only limited fields beyond their bounds change; the bounds are included."""
    gate = Driver(LOW).open()
    gate.state(0, "low_speed", True)
    (output,) = gate.engine.command(at(10), twist(0.5, -3.0))
    assert output.kind == "limited"
    assert output.message == {
        "linear": {"x": 0.1, "y": 7.0, "z": 0.0},
        "angular": {"x": 0.0, "y": 0.0, "z": -0.2},
    }
    assert gate.drive(20, -0.1, 0.2) == [(20, "pass", -0.1)]


def test_limit_applies_at_once_to_the_executed_command() -> None:
    """The last command is published again within the limit, unless it complies already."""
    gate = Driver(LOW).open()
    gate.drive(10, 0.5)
    assert gate.state(15, "low_speed", True) == [(15, "limited", 0.1)]
    assert gate.wait(1000) == []
    assert gate.state(1001, "low_speed", False) == []
    gate.drive(1002, 0.05)
    assert gate.state(1003, "low_speed", True) == []


def test_limit_after_zeros_publishes_no_old_command() -> None:
    """Commands received while zeros were published were never executed."""
    gate = Driver(STOP, LOW).open()
    gate.drive(0, 0.5)
    gate.state(0, "stop", True)
    gate.drive(20, 0.5)
    gate.state(30, "stop", False)
    assert gate.state(40, "low_speed", True) == []


def test_looser_limit_does_not_speed_up() -> None:
    """When the tighter of two limits ends, the next command is the first to be faster."""
    gate = Driver(
        "stop: limit linear.x to [0, 0.1];", "low_speed: limit linear.x to [0, 0.3];"
    ).open()
    gate.state(0, "stop", True)
    gate.state(0, "low_speed", True)
    assert gate.drive(10, 0.5) == [(10, "limited", 0.1)]
    assert gate.state(20, "stop", False) == []
    assert gate.drive(30, 0.5) == [(30, "limited", 0.3)]


def test_earlier_zero_line_overrides_a_limit() -> None:
    """With the zero line first, zero is published while both are active."""
    gate = Driver(STOP, LOW).open()
    gate.state(0, "low_speed", True)
    gate.state(10, "stop", True)
    assert gate.drive(20, 0.5) == []
    assert gate.wait(60) == [(60, "zero", 0.0)]


def test_earlier_limit_applies_to_its_own_fields() -> None:
    """A limit before the zero line keeps its fields; all others are zero."""
    gate = Driver(LOW, STOP).open()
    gate.drive(0, 0.5, 0.1)
    assert gate.state(5, "low_speed", True) == [(5, "limited", 0.1)]
    (output,) = gate.engine.state(at(10), "/stop", {"data": True})
    assert output.kind == "zero"
    assert output.message == {
        "linear": {"x": 0.1, "y": 0.0, "z": 0.0},
        "angular": {"x": 0.0, "y": 0.0, "z": 0.1},
    }


def test_end_of_a_limit_before_a_zero_line_is_zero_at_once() -> None:
    """The limited fields become zero immediately, and the period restarts."""
    gate = Driver(LOW, STOP).open()
    gate.drive(0, 0.5)
    gate.state(5, "low_speed", True)
    gate.state(10, "stop", True)
    assert gate.state(20, "low_speed", False) == [(20, "zero", 0.0)]
    assert gate.wait(70) == [(70, "zero", 0.0)]


# Unknown states -----------------------------------------------------------------------------------


def test_action_is_active_before_its_first_state() -> None:
    """At the start nothing passes, and zeros are published from the beginning."""
    gate = Driver(STOP)
    assert gate.wait(120) == [(0, "zero", 0.0), (50, "zero", 0.0), (100, "zero", 0.0)]
    assert gate.drive(130, 0.5) == []
    assert gate.state(140, "stop", False) == []
    assert gate.drive(150, 0.5) == [(150, "pass", 0.5)]


def test_limit_is_active_before_its_first_state() -> None:
    """A command before the state of the action is limited."""
    gate = Driver(LOW)
    assert gate.drive(10, 0.5) == [(10, "limited", 0.1)]
    gate.state(20, "low_speed", False)
    assert gate.drive(30, 0.5) == [(30, "pass", 0.5)]


def test_action_is_active_from_a_loss_until_its_next_state() -> None:
    """A heartbeat alone does not reopen the gate: the known state may be outdated."""
    gate = Driver(STOP, HEARTBEAT).open()
    gate.wait(400)
    gate.beat(410)
    assert gate.drive(415, 0.5) == []
    gate.state(420, "stop", False)
    assert gate.drive(425, 0.5) == [(425, "pass", 0.5)]


def test_state_during_a_loss_counts_after_it() -> None:
    """The first state after the start of the loss counts, even if the heartbeat comes later."""
    gate = Driver(STOP, HEARTBEAT).open()
    gate.wait(400)
    gate.state(405, "stop", False)
    gate.beat(410)
    assert gate.drive(415, 0.5) == [(415, "pass", 0.5)]


def test_undecodable_state_counts_as_active() -> None:
    """The state of the action is then unknown."""
    gate = Driver(STOP).open()
    assert shown(gate.engine.state(at(10), "/stop", None)) == [(10, "zero", 0.0)]


def test_states_of_one_topic_are_distinguished_by_value() -> None:
    """Each of two actions on one topic is active while the field has its value."""
    built = program(
        """action stop publishes 2 on /gear : std_msgs.UInt8;
        action low publishes 1 on /gear : std_msgs.UInt8;
        gate /nav -> /cmd_vel : geometry_msgs.Twist rate 20 Hz {
          stop: zero; low: limit linear.x to [0, 0.1]; }"""
    )
    engine = GateEngine(built.gates[0], built.actions, embedded_store())
    for value, expected in ((0, ["pass"]), (1, ["limited"]), (2, []), (3, ["pass"])):
        engine.state(at(value), "/gear", {"data": value})
        assert [each.kind for each in engine.command(at(value), twist(0.5))] == expected


def test_float_states_are_compared_in_the_precision_of_the_field() -> None:
    """0.1 in a float32 differs from 0.1, and is still the value that the action publishes."""
    built = program(
        """action slow publishes 0.1 on /pace : std_msgs.Float32;
        gate /nav -> /cmd_vel : geometry_msgs.Twist rate 20 Hz { slow: zero; }"""
    )
    engine = GateEngine(built.gates[0], built.actions, embedded_store())
    engine.state(0, "/pace", {"data": 0.0})
    assert engine.command(0, twist(0.5))[0].kind == "pass"
    engine.state(1, "/pace", {"data": 0.10000000149011612})
    assert engine.command(1, twist(0.5)) == []


# Losses -------------------------------------------------------------------------------------------


def test_heartbeat_is_lost_from_the_start() -> None:
    """The line applies until the second heartbeat: the first has nothing to advance from."""
    gate = Driver(HEARTBEAT)
    assert gate.wait(60) == [(0, "zero", 0.0), (50, "zero", 0.0)]
    assert gate.beat(70) == []
    assert gate.drive(72, 0.5) == []
    assert gate.beat(75) == []
    assert gate.drive(80, 0.5) == [(80, "pass", 0.5)]


@pytest.mark.parametrize("counter", [2, 1, 0])
def test_heartbeat_that_does_not_advance_is_lost_at_once(counter: int) -> None:
    """The next one has to advance from it."""
    gate = Driver(STOP, HEARTBEAT).open()
    gate.drive(10, 0.5)
    assert gate.beat(20, counter) == [(20, "zero", 0.0)]
    assert gate.beat(30, counter) == []
    assert gate.drive(31, 0.5) == []
    assert gate.beat(40, counter + 1) == []
    assert gate.drive(41, 0.5) == []  # the stop has counted as active since the loss
    gate.state(42, "stop", False)
    assert gate.drive(43, 0.5) == [(43, "pass", 0.5)]


def test_constant_heartbeat_never_opens_the_gate() -> None:
    """This holds however often it is received."""
    gate = Driver(HEARTBEAT)
    for t_ms in range(10, 500, 10):
        gate.beat(t_ms, 1)
        assert [each for each in gate.drive(t_ms, 0.5) if each[1] != "zero"] == []


def test_heartbeat_may_skip_counts() -> None:
    """A lost message is not a lost node; the largest counter is valid too."""
    gate = Driver(HEARTBEAT)
    gate.beat(10, 2**64 - 5)
    gate.beat(20, 2**64 - 1)
    assert gate.drive(21, 0.5) == [(21, "pass", 0.5)]


def test_lost_safety_node_makes_everything_unknown() -> None:
    """Zero at once; then two heartbeats and every state are needed, as at the start."""
    gate = Driver(STOP, HEARTBEAT).open()
    gate.drive(10, 0.5)
    assert gate.lose(20) == [(20, "zero", 0.0)]
    assert gate.beat(30) == []
    gate.state(31, "stop", False)
    assert gate.drive(32, 0.5) == []
    assert gate.beat(40) == []
    assert gate.drive(41, 0.5) == [(41, "pass", 0.5)]


def test_lost_safety_node_makes_every_action_active() -> None:
    """A gate without a heartbeat line forgets the states as well."""
    gate = Driver(STOP).open()
    gate.drive(10, 0.5)
    assert gate.lose(20) == [(20, "zero", 0.0)]
    gate.state(30, "stop", False)
    assert gate.drive(31, 0.5) == [(31, "pass", 0.5)]


def test_untrusted_state_may_stop_but_not_release() -> None:
    """Active counts from any publisher, inactive only from the safety node."""
    gate = Driver(STOP)
    gate.wait(0)
    gate.state(1, "stop", False, is_trusted=False)
    assert gate.drive(2, 0.5) == []
    gate.state(3, "stop", False)
    assert gate.drive(4, 0.5) == [(4, "pass", 0.5)]
    assert gate.state(5, "stop", True, is_trusted=False) == [(5, "zero", 0.0)]
    assert gate.state(6, "stop", False, is_trusted=False) == []
    gate.state(7, "stop", False)
    assert gate.drive(8, 0.5) == [(8, "pass", 0.5)]


def test_heartbeat_is_lost_exactly_after_its_time() -> None:
    """A nanosecond before, commands pass; at the deadline zero is published."""
    gate = Driver(HEARTBEAT).open()
    gate.beat(100)
    assert gate.engine.advance(at(400) - 1) == []
    assert gate.drive(400 - 1e-6, 0.5) == [(400 - 1e-6, "pass", 0.5)]
    assert gate.wait(400) == [(400, "zero", 0.0)]


def test_deadline_precedes_a_message_at_the_same_time() -> None:
    """A heartbeat at the time of the loss is too late to prevent it, and ends it."""
    gate = Driver(HEARTBEAT).open()
    gate.drive(10, 0.5)
    assert gate.beat(300) == [(300, "zero", 0.0)]
    assert gate.drive(300, 0.5) == [(300, "pass", 0.5)]


def test_late_timer_changes_nothing() -> None:
    """The zero of a loss has its own time, and the old state counts until then."""
    gate = Driver(STOP, HEARTBEAT).open()
    assert gate.drive(310, 0.5) == [(300, "zero", 0.0)]


def test_overdue_zeros_are_replaced_by_one() -> None:
    """After a hang the gate publishes one zero instead of a thousand, and keeps its period."""
    gate = Driver(STOP)
    gate.wait(50)
    assert shown(gate.engine.advance(at(1_000_070))) == [(100, "zero", 0.0)]
    assert gate.engine.next_deadline == at(1_000_100)


def test_input_is_lost_at_the_start_and_after_its_time() -> None:
    """Zeros until the first command, and again from 0.5 s after the last one."""
    gate = Driver(INPUT)
    assert gate.wait(60) == [(0, "zero", 0.0), (50, "zero", 0.0)]
    assert gate.drive(70, 0.5) == [(70, "pass", 0.5)]
    assert gate.wait(620) == [(570, "zero", 0.0), (620, "zero", 0.0)]
    assert gate.drive(630, 0.4) == [(630, "pass", 0.4)]


@pytest.mark.parametrize("bad", [float("nan"), float("inf"), float("-inf")])
def test_refused_command_is_a_lost_input_at_once(bad: float) -> None:
    """It is never published; zeros follow until the next valid command."""
    gate = Driver(INPUT).open()
    gate.drive(10, 0.5)
    assert gate.drive(20, bad) == [(20, "zero", 0.0)]
    assert gate.wait(70) == [(70, "zero", 0.0)]
    assert gate.drive(80, 0.5) == [(80, "pass", 0.5)]


def test_undecodable_command_is_refused() -> None:
    """It is treated like one with NaN."""
    gate = Driver(INPUT).open()
    assert shown(gate.engine.command(at(10), None)) == [(10, "zero", 0.0)]


def test_refused_command_does_not_keep_the_input_alive() -> None:
    """Without an input line nothing follows, and the refused command is not executed."""
    gate = Driver(LOW, HEARTBEAT).open()
    gate.drive(10, 0.05)
    assert gate.drive(20, float("nan")) == []
    assert gate.state(30, "low_speed", True) == []


def test_loss_line_may_limit() -> None:
    """The executed command is slowed down, and so are later ones."""
    gate = Driver("lost heartbeat for 0.3 sec: limit linear.x to [-0.1, 0.1];").open()
    gate.drive(10, 0.5)
    assert gate.wait(1000) == [(300, "limited", 0.1)]
    assert gate.drive(1010, -0.5) == [(1010, "limited", -0.1)]


def test_limit_of_an_action_does_not_apply_after_a_loss() -> None:
    """A low-speed line before the zero does not keep driving when the safety node is dead."""
    gate = Driver(LOW, HEARTBEAT).open()
    gate.state(0, "low_speed", True)
    gate.drive(10, 0.5)
    assert gate.wait(300) == [(300, "zero", 0.0)]
    gate.beat(310)
    assert gate.drive(320, 0.5) == [(320, "limited", 0.1)]


def test_limit_of_an_action_does_not_apply_without_commands() -> None:
    """The same holds when the controller is dead."""
    gate = Driver(LOW, INPUT).open()
    gate.state(0, "low_speed", True)
    gate.drive(10, 0.5)
    assert gate.wait(510) == [(510, "zero", 0.0)]


def test_limit_of_a_loss_replaces_that_of_an_action() -> None:
    """It is written later, but the limit of the action no longer applies."""
    gate = Driver(LOW, "lost input for 0.5 sec: limit linear.x to [-0.05, 0.05];").open()
    gate.state(0, "low_speed", True)
    gate.drive(10, 0.5)
    assert gate.wait(1000) == [(510, "limited", 0.05)]


def test_limit_before_a_zero_line_is_zero_with_a_lost_input() -> None:
    """There is no current command for the limited fields, so they are zero too."""
    gate = Driver("lost input for 0.5 sec: limit linear.x to [-0.2, 0.2];", STOP).open()
    gate.state(0, "stop", True)
    gate.drive(100, 0.5)
    assert gate.wait(650)[-2:] == [(600, "zero", 0.0), (650, "zero", 0.0)]


def test_two_loss_lines_apply_in_sequence() -> None:
    """First slower, then zero; limits of actions end with the first."""
    gate = Driver(
        "lost heartbeat for 0.6 sec: zero;",
        "lost heartbeat for 0.3 sec: limit linear.x to [-0.2, 0.2];",
        LOW,
    ).open()
    gate.drive(10, 0.5)
    assert gate.wait(650) == [(300, "limited", 0.2), (600, "zero", 0.0), (650, "zero", 0.0)]


# The clock ----------------------------------------------------------------------------------------


def test_clock_step_makes_everything_unknown() -> None:
    """As at the start: zeros until heartbeat, states and a command have been received again."""
    gate = Driver(STOP, HEARTBEAT, INPUT).open()
    gate.drive(100, 0.5)
    assert gate.beat(40) == [(40, "zero", 0.0)]
    assert gate.beat(40) == []
    gate.state(41, "stop", False)
    assert gate.drive(42, 0.5) == [(42, "pass", 0.5)]


def test_clock_step_does_not_stop_the_zeros() -> None:
    """They continue from the new time, however far back it is."""
    gate = Driver(STOP)
    gate.wait(1000)
    assert gate.wait(-5000) == [(-5000, "zero", 0.0)]
    assert gate.wait(-4950) == [(-4950, "zero", 0.0)]
