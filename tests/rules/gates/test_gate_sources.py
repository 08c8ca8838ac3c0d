"""Gates with several sources: whose commands pass, and from when on."""

from __future__ import annotations

import pytest

from deros.rules.gates.gate_engine import GateEngine, Output
from tests.support.gates import STORE
from tests.support.rules import build_rules, program

MS = 1_000_000
JOY, NAV = 0, 1
BOTH = "/joy for 0.5 sec over /nav for 0.3 sec"
TWIST = "geometry_msgs.Twist"

Shown = tuple[int, str, float]


class Played:
    """A gate with a joystick before a planner, and what it publishes; times in milliseconds."""

    def __init__(self, sources: str = BOTH, lines: str = "lost input: zero;") -> None:
        """Build the gate, with a rate of 1 Hz, so that periodic zeros are rare."""
        built = program(
            "action stop publishes true on /stop : std_msgs.Bool latched;"
            f" gate {sources} -> /cmd : {TWIST} rate 1 Hz {{ {lines} }}"
        )
        self.gate = GateEngine(built.gates[0], built.actions, STORE)
        self.until(0)
        self.stop(0, active=False)

    def command(self, source: int, t_ms: int, speed: float | None) -> list[Shown]:
        """Pass a command of a source; None cannot be decoded."""
        linear, still = {"x": speed, "y": 0.0, "z": 0.0}, {"x": 0.0, "y": 0.0, "z": 0.0}
        message = None if speed is None else {"linear": linear, "angular": still}
        return [_shown(each) for each in self.gate.command(t_ms * MS, message, source)]

    def stop(self, t_ms: int, *, active: bool) -> list[Shown]:
        """Pass the state of the action."""
        return [_shown(each) for each in self.gate.state(t_ms * MS, "/stop", {"data": active})]

    def until(self, t_ms: int) -> list[Shown]:
        """Let time pass."""
        return [_shown(each) for each in self.gate.advance(t_ms * MS)]


def _shown(output: Output) -> Shown:
    return output.t_ns // MS, output.kind, output.message["linear"]["x"]


def test_first_source_passes_while_it_commands() -> None:
    """The planner is ignored until the joystick has been silent for its time."""
    gate = Played()
    assert gate.command(NAV, 100, 0.4) == [(100, "pass", 0.4)]
    assert gate.gate.source == "/nav"
    assert gate.command(JOY, 150, 0.1) == [(150, "pass", 0.1)]
    assert gate.gate.source == "/joy"
    assert gate.command(NAV, 200, 0.5) == []
    assert gate.command(NAV, 400, 0.6) == []
    assert gate.until(649) == []
    assert gate.until(650) == [(650, "pass", 0.6)]
    assert gate.gate.source == "/nav"


def test_source_that_is_too_old_does_not_take_over() -> None:
    """At the instant at which the joystick falls silent, the planner has been so for its time."""
    gate = Played()
    gate.command(NAV, 100, 0.4)
    gate.command(JOY, 150, 0.1)
    gate.command(NAV, 350, 0.6)
    assert gate.until(650) == [(650, "zero", 0.0)]
    assert gate.gate.source == ""
    assert gate.command(NAV, 700, 0.7) == [(700, "pass", 0.7)]


def test_input_is_lost_when_all_sources_are() -> None:
    """Each has its own time, from its own last command."""
    gate = Played()
    gate.command(NAV, 100, 0.4)
    assert gate.until(399) == []
    assert gate.until(400) == [(400, "zero", 0.0)]


def test_refused_command_does_not_hand_over() -> None:
    """Somebody is at the joystick, and nobody knows what is wanted: nothing passes."""
    gate = Played()
    gate.command(JOY, 90, 0.1)
    gate.command(NAV, 95, 0.4)
    assert gate.command(JOY, 100, None) == [(100, "zero", 0.0)]
    assert gate.command(NAV, 550, 0.5) == []
    assert gate.until(600) == [(600, "pass", 0.5)]
    assert gate.command(JOY, 610, 0.2) == [(610, "pass", 0.2)]


def test_refused_command_of_a_source_that_is_not_chosen_changes_nothing() -> None:
    """The planner may command what it likes while the joystick does."""
    gate = Played()
    gate.command(JOY, 100, 0.1)
    assert gate.command(NAV, 200, None) == []
    assert gate.until(600) == [(600, "zero", 0.0)]


def test_stop_holds_back_all_sources() -> None:
    """A change of sources while the gate stops is no way around it, and ends nothing."""
    gate = Played(lines="stop: zero; lost input: zero;")
    gate.command(JOY, 100, 0.1)
    gate.command(NAV, 300, 0.4)
    assert gate.stop(350, active=True) == [(350, "zero", 0.0)]
    assert gate.command(NAV, 590, 0.4) == []
    assert gate.until(600) == []
    assert gate.gate.source == "/nav"
    assert gate.stop(700, active=False) == []
    assert gate.command(NAV, 710, 0.4) == [(710, "pass", 0.4)]


def test_source_from_zero_has_to_command_zero_first() -> None:
    """The planner, which still commands a speed when the joystick is let go, has to stop once."""
    gate = Played("/joy for 0.5 sec over /nav for 0.3 sec from zero")
    waits = len(gate.gate.table.reports) - 1
    gate.command(JOY, 100, 0.1)
    gate.command(NAV, 500, 0.4)
    assert gate.until(600) == [(600, "zero", 0.0)]
    assert gate.gate.table.reports[waits] == "waits for a zero command"
    assert gate.gate.applying[waits]
    assert gate.command(NAV, 650, 0.4) == []
    assert gate.command(NAV, 700, 0.0) == [(700, "pass", 0.0)]
    assert not gate.gate.applying[waits]
    assert gate.command(NAV, 750, 0.4) == [(750, "pass", 0.4)]


def test_zero_command_during_a_stop_does_not_count_for_a_source_from_zero() -> None:
    """As with `resume on zero command`: it has to come when nothing calls for a stop."""
    gate = Played(f"{BOTH} from zero", lines="stop: zero; lost input: zero;")
    gate.stop(50, active=True)
    gate.command(NAV, 100, 0.0)
    gate.stop(150, active=False)
    assert gate.command(NAV, 200, 0.4) == []
    gate.command(NAV, 250, 0.0)
    assert gate.command(NAV, 300, 0.4) == [(300, "pass", 0.4)]


def test_another_source_does_not_wait_for_the_one_that_has_to_command_zero() -> None:
    """The joystick takes over at once, and the planner has to begin again after it."""
    gate = Played("/joy for 0.5 sec over /nav for 0.3 sec from zero")
    gate.command(NAV, 100, 0.4)
    assert gate.command(JOY, 150, 0.1) == [(150, "pass", 0.1)]
    gate.command(NAV, 640, 0.4)
    assert gate.until(650) == [(650, "zero", 0.0)]


def test_one_source_may_have_its_time_too() -> None:
    """That is the same as a time of the lost input, also at its start and after a refusal."""
    gate = Played("/joy for 0.5 sec")
    assert gate.command(JOY, 100, 0.1) == [(100, "pass", 0.1)]
    assert gate.command(JOY, 200, None) == [(200, "zero", 0.0)]
    assert gate.command(JOY, 300, 0.2) == [(300, "pass", 0.2)]
    assert gate.until(800) == [(800, "zero", 0.0)]


def test_clock_that_steps_back_forgets_all_sources() -> None:
    """A command of the future is no command."""
    gate = Played()
    gate.command(JOY, 1000, 0.1)
    assert gate.until(900) == [(900, "zero", 0.0)]
    assert gate.gate.source == ""
    assert gate.command(NAV, 950, 0.4) == [(950, "pass", 0.4)]


@pytest.mark.parametrize(
    ("sources", "line", "message"),
    [
        ("/a over /b for 1 sec", "lost input: zero", "how long the last command on '/a' counts"),
        ("/a for 1 sec over /b", "lost input: zero", "how long the last command on '/b' counts"),
        ("/a for 1 sec", "lost input for 1 sec: zero", "and each has its own time"),
        ("/a", "lost input: zero", "after which silence the input is lost"),
        ("/a", "lost heartbeat: zero", "after which silence the heartbeat is lost"),
        ("/a for 0 sec", "lost input: zero", "a time of 0 means always lost"),
        ("/a for 1 sec over /a for 2 sec", "lost input: zero", "'/a' of this gate is declared"),
        ("/a for 1 sec over /cmd for 1 sec", "lost input: zero", "the gate publishes what it"),
    ],
)
def test_times_are_said_once(sources: str, line: str, message: str) -> None:
    """Each loss has one time, and each source another topic."""
    result = build_rules(f"gate {sources} -> /cmd : {TWIST} rate 1 Hz {{ {line}; }}")
    (found,) = result.diagnostics
    assert message in found.message
    assert result.program is None or not result.program.gates
