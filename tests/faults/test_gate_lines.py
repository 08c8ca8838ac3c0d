"""Faults around gates with several sources, ramps, and lines that hold, send, wait or are silent.

What reaches drive and fork is judged by its stamps; for the time of the machine, which may be busy,
there is the same allowance as for every reaction.
"""

from __future__ import annotations

import re
import time
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from pathlib import Path

import pytest

from deros.interfaces.store import InterfaceStore
from deros.metamodels.load import Repository
from deros.validators.check import check
from tests.faults.conftest import LOADER_RULES
from tests.support.gate_nodes import Stranger
from tests.support.loader import (
    DRIVE_GATE,
    FORK_GATE,
    FORK_WISH,
    HELD_BACK,
    JOYSTICK,
    LADEN,
    LIGHT,
    LOWERING,
    PLANNER,
    TOO_HEAVY,
    Loader,
    Sent,
    lift,
)
from tests.support.played import command
from tests.support.profiles import slow
from tests.support.rig import PROMPT
from tests.support.ros import short_lease
from tests.support.victims import Process, Sensors

pytestmark = [pytest.mark.ros, pytest.mark.slow]

LOST_HEARTBEAT, SILENT = 0.3, 0.5
"""Times after which the heartbeat, or a source, counts as lost, in s; see the rules."""

GENTLE, QUICK = 1.0, 2.0
"""Rates of the ramps, in m/s2: those of a stop and of the lost heartbeat, that of a lost input."""

TOP, WISHED, STEERED = 1.0, 2.0, 0.5
"""The drive's greatest speed in m/s, what the planner commands, and what the joystick does."""

LIFTING = 0.25
"""What the fork is commanded, in m/s."""


@pytest.fixture(scope="session")
def standstill() -> dict[float, float]:
    """Return the seconds that the check states for a ramp, by its rate."""
    repository = Repository()
    findings = check([repository.load(LOADER_RULES)], repository, InterfaceStore())
    found = (re.search(r"at zero (\S+) s after", each.message) for each in findings)
    longest = [float(each[1]) for each in found if each is not None]
    return {GENTLE: longest[0], QUICK: longest[2]}


def assert_ramp(drive: Sequence[Sent], rate: float) -> Sent:
    """Assert that speeds only fall, by no more than the rate; return the first zero.

    A command is stamped after the gate has read its clock, and before it reads it again. So from
    the stamp before one command to that of another no less than the ramp's own time passes.
    """
    zero = next(n for n, each in enumerate(drive) if each.value == 0.0)
    for later in range(zero + 1):
        for earlier in range(later):
            begun = drive[max(earlier - 1, 0)].time
            fall = drive[earlier].value - drive[later].value
            assert 0.0 <= fall <= rate * (drive[later].time - begun) + 1e-6 or earlier == 0
    assert not any(each.value for each in drive[zero:])
    return drive[zero]


class Fault:
    """An instant at which something is broken, and what is to follow it in time."""

    def __init__(self, loader: Loader) -> None:
        """Note the instant, and what reaches the drive from then on."""
        self._loader = loader
        self.time = time.time()
        self._held_up = loader.held_up()
        self._first = max(len(loader.drive) - 5, 0)

    def allowed(self, seconds: float) -> float:
        """Return until when something must be over that may take so many seconds."""
        return self.time + seconds + PROMPT + self._loader.held_up() - self._held_up

    def assert_ramps_to_zero(self, rate: float, seconds: float) -> None:
        """Assert that the drive ramps to zero for good, within so many seconds."""
        drive = self._loader.drive
        self._loader.until(lambda: [each.value for each in drive[-5:]] == [0.0] * 5)
        self.assert_stands()
        zero = assert_ramp(drive[self._first :], rate)
        assert zero.time < self.allowed(seconds)

    def assert_stands(self) -> None:
        """Assert that zeros keep coming to the drive, and nothing else."""
        heard = len(self._loader.drive)
        self._loader.spin(0.5)
        assert len(self._loader.drive) > heard + 4, "the gate fell silent"
        assert not any(each.value for each in self._loader.drive[heard:])


def lease(fault: Callable[..., None], folder: Path) -> dict[str, str]:
    """Return the environment of what is to be broken: what is killed is forgotten soon.

    What hangs for longer than its lease, though, is not found again by the middleware.
    """
    return short_lease(folder) if fault in (Sensors.kill, Process.kill) else {}


def last_of(sent: Sequence[Sent], value: float) -> float:
    """Return when a value was sent last."""
    return max(each.time for each in sent if each.value == value)


def plan(loader: Loader, planner: Sensors) -> None:
    """Begin to drive as a planner does: with zero, and then as fast as it goes."""
    loader.until_zero_passes(planner, "/plan")
    planner.play("/plan", command(WISHED), rate=20.0)
    loader.until_driving(TOP)


FAULTS = pytest.mark.parametrize("fault", [Sensors.kill, Sensors.freeze])
NODE_FAULTS = pytest.mark.parametrize("fault", [Process.kill, Process.freeze])


# The drive: several sources, and ramps ------------------------------------------------------------


@FAULTS
def test_joystick_that_fails_hands_over_in_its_time(
    loader: Loader, tmp_path: Path, fault: Callable[[Sensors], None]
) -> None:
    """Its last command is not executed for longer; the planner has to begin with zero."""
    with (
        loader.at_work(DRIVE_GATE),
        loader.sensors(PLANNER) as planner,
        loader.sensors(JOYSTICK, **lease(fault, tmp_path)) as joystick,
        ExitStack() as stack,
    ):
        plan(loader, planner)
        joystick.play("/joy", command(STEERED), rate=20.0)
        loader.until_driving(STEERED)
        broken = Fault(loader)
        fault(joystick)
        broken.assert_ramps_to_zero(QUICK, SILENT + STEERED / GENTLE)
        assert last_of(loader.drive, STEERED) < broken.allowed(SILENT)
        plan(loader, planner)
        if fault is Sensors.freeze:
            joystick.thaw()
        else:
            joystick = stack.enter_context(loader.sensors(JOYSTICK))
            joystick.play("/joy", command(STEERED), rate=20.0)
        loader.until_driving(STEERED)


@FAULTS
def test_planner_that_fails_is_followed_by_a_ramp(
    loader: Loader,
    tmp_path: Path,
    standstill: dict[float, float],
    fault: Callable[[Sensors], None],
) -> None:
    """When it is back, and still commands its speed, the drive gets zero until it commands zero."""
    with (
        loader.at_work(DRIVE_GATE),
        loader.sensors(PLANNER, **lease(fault, tmp_path)) as planner,
        ExitStack() as stack,
    ):
        plan(loader, planner)
        broken = Fault(loader)
        fault(planner)
        broken.assert_ramps_to_zero(QUICK, SILENT + standstill[QUICK])
        if fault is Sensors.freeze:
            planner.thaw()
        else:
            planner = stack.enter_context(loader.sensors(PLANNER))
            planner.play("/plan", command(WISHED), rate=20.0)
        loader.until(lambda: "waits for a zero command" in loader.reports[DRIVE_GATE])
        broken.assert_stands()
        plan(loader, planner)


@NODE_FAULTS
def test_safety_node_that_fails_is_followed_by_a_ramp(
    loader: Loader,
    tmp_path: Path,
    standstill: dict[float, float],
    fault: Callable[[Process], None],
) -> None:
    """Whichever line decides then; commands pass again when the node is back."""
    with (
        loader.at_work(DRIVE_GATE, **lease(fault, tmp_path)),
        loader.sensors(PLANNER) as planner,
    ):
        plan(loader, planner)
        broken = Fault(loader)
        fault(loader.node)
        broken.assert_ramps_to_zero(GENTLE, LOST_HEARTBEAT + standstill[GENTLE])
        if fault is Process.freeze:
            loader.node.thaw()
        else:
            loader.restart()
        loader.until_driving(TOP)


@pytest.mark.parametrize("victim", ["planner", "safety node", "gate"])
def test_ramp_goes_on_whatever_fails_meanwhile(
    loader: Loader, tmp_path: Path, standstill: dict[float, float], victim: str
) -> None:
    """It gets neither longer nor steeper, and a gate that has hung does not return to a speed."""
    with (
        loader.at_work(DRIVE_GATE, **short_lease(tmp_path)),
        loader.sensors(PLANNER) as planner,
    ):
        plan(loader, planner)
        broken = Fault(loader)
        loader.weigh(TOO_HEAVY)
        loader.until(lambda: 0.0 < loader.drive[-1].value < 0.8 * TOP)
        if victim == "planner":
            planner.kill()
        elif victim == "safety node":
            loader.node.kill()
        else:
            loader.gate.freeze()
            loader.spin(0.4)
            loader.gate.thaw()
        broken.assert_ramps_to_zero(GENTLE, standstill[GENTLE])


def test_restarted_gate_moves_nothing_that_does_not_begin_with_zero(loader: Loader) -> None:
    """The planner has commanded its speed throughout; from the dead gate nothing comes."""
    with loader.at_work(DRIVE_GATE), loader.sensors(PLANNER) as planner:
        plan(loader, planner)
        loader.gate.kill()
        loader.spin(0.5)
        killed = len(loader.drive)
        loader.spin(0.5)
        assert len(loader.drive) == killed
        loader.reports.clear()
        loader.restart_gate()
        loader.until(
            lambda: loader.reports.get(DRIVE_GATE, "").endswith("waits for a zero command")
        )
        loader.until(lambda: len(loader.drive) > killed + 10)
        assert not any(each.value for each in loader.drive[killed:])
        plan(loader, planner)


def test_second_planner_is_a_fault_and_cannot_prevent_a_ramp(
    loader: Loader, standstill: dict[float, float]
) -> None:
    """Commands of both pass, and neither does once the loader is to stop."""
    with (
        loader.at_work(DRIVE_GATE),
        loader.sensors(PLANNER) as planner,
        ExitStack() as stack,
    ):
        plan(loader, planner)
        second = stack.enter_context(loader.sensors(PLANNER))
        second.play("/plan", command(STEERED), rate=20.0)
        loader.until(lambda: "2 publishers where one is expected" in loader.reports[DRIVE_GATE])
        loader.until(lambda: {each.value for each in loader.drive[-10:]} == {TOP, STEERED})
        broken = Fault(loader)
        loader.weigh(TOO_HEAVY)
        loader.until(lambda: [each.value for each in loader.drive[-5:]] == [0.0] * 5)
        broken.assert_stands()
        told = [each for each in loader.states["/stop"] if each.time > broken.time]
        stopped = next(each.time for each in told if each.value)
        late = [each for each in loader.drive if each.time > stopped + PROMPT / 2]
        assert assert_ramp(late, GENTLE).time < broken.allowed(standstill[GENTLE])


def test_second_publisher_of_a_state_releases_no_ramp(
    loader: Loader, ros_env: dict[str, str], standstill: dict[float, float]
) -> None:
    """It says, again and again, that nothing stops the loader."""
    with (
        loader.at_work(DRIVE_GATE),
        loader.sensors(PLANNER) as planner,
        Stranger(ros_env) as stranger,
    ):
        plan(loader, planner)
        broken = Fault(loader)
        loader.weigh(TOO_HEAVY)
        loader.until(lambda: loader.drive[-1].value < TOP)
        timer = loader.peer.node.create_timer(0.02, lambda: stranger.stop(False))
        broken.assert_ramps_to_zero(GENTLE, standstill[GENTLE])
        loader.until(lambda: "/stranger" in loader.reports[DRIVE_GATE])
        broken.assert_stands()
        loader.peer.node.destroy_timer(timer)


# The fork: hold, send, silence, and waiting -------------------------------------------------------


def begin_to_lift(loader: Loader, wisher: Sensors) -> float:
    """Wish the fork at rest, and then to lift; return when the first command was that lifts."""
    loader.until_zero_passes(wisher, "/fork_wish")
    loader.until(lambda: loader.is_off("/horn"))
    wished = time.time()
    wisher.play("/fork_wish", lift(LIFTING), rate=20.0)
    loader.until_lifting(LIFTING)
    moved = min(each.time for each in loader.fork if each.value and each.time > wished)
    silent = [each.time for each in loader.states["/horn"] if not each.value and each.time < moved]
    assert moved >= max(wished, *silent) + HELD_BACK
    return moved


def assert_lowers(loader: Loader, broken: Fault, seconds: float) -> None:
    """Assert that the fork is lowered within so many seconds, and nothing else from then on."""
    loader.until(lambda: [each.value for each in loader.fork[-5:]] == [LOWERING] * 5)
    loader.spin(0.5)
    assert last_of(loader.fork, LIFTING) < broken.allowed(seconds)
    first = max(n for n, each in enumerate(loader.fork) if each.value != LOWERING) + 1
    assert len(loader.fork) > first + 8


@FAULTS
def test_held_command_ends_with_who_commands(
    loader: Loader, tmp_path: Path, fault: Callable[[Sensors], None]
) -> None:
    """While the fork pauses it gets the command from before; without a wish, nothing at all."""
    with (
        loader.at_work(FORK_GATE),
        loader.sensors(FORK_WISH, **lease(fault, tmp_path)) as wisher,
        ExitStack() as stack,
    ):
        begin_to_lift(loader, wisher)
        loader.weigh(LADEN)
        loader.until(lambda: "pause: hold" in loader.reports[FORK_GATE])
        wisher.play("/fork_wish", lift(2 * LIFTING), rate=20.0)
        held = len(loader.fork)
        loader.until(lambda: len(loader.fork) > held + 10)
        assert {each.value for each in loader.fork[held:]} == {LIFTING}
        broken = Fault(loader)
        fault(wisher)
        loader.until(lambda: "silence" in loader.reports[FORK_GATE])
        loader.spin(1.0)
        assert loader.fork[-1].time < broken.allowed(SILENT)
        loader.weigh(LIGHT)
        if fault is Sensors.freeze:
            wisher.thaw()
        else:
            wisher = stack.enter_context(loader.sensors(FORK_WISH))
        begin_to_lift(loader, wisher)


@NODE_FAULTS
@pytest.mark.parametrize("weight", [LIGHT, slow(LADEN)])
def test_safety_node_that_fails_lowers_the_fork(
    loader: Loader, tmp_path: Path, fault: Callable[[Process], None], weight: float
) -> None:
    """Whether commands pass or one is held; when it is back, the next motion is warned of again."""
    with (
        loader.at_work(FORK_GATE, **lease(fault, tmp_path)),
        loader.sensors(FORK_WISH) as wisher,
    ):
        begin_to_lift(loader, wisher)
        loader.weigh(weight)
        if weight == LADEN:
            loader.until(lambda: "pause: hold" in loader.reports[FORK_GATE])
        broken = Fault(loader)
        fault(loader.node)
        assert_lowers(loader, broken, LOST_HEARTBEAT)
        loader.weigh(LIGHT)
        if fault is Process.freeze:
            loader.node.thaw()
        else:
            loader.restart()
        begin_to_lift(loader, wisher)


@NODE_FAULTS
def test_fork_does_not_move_while_nobody_warns(
    loader: Loader, tmp_path: Path, fault: Callable[[Process], None]
) -> None:
    """The safety node fails while the wish waits: horn and wish alone do not move the fork."""
    with (
        loader.at_work(FORK_GATE, **lease(fault, tmp_path)),
        loader.sensors(FORK_WISH) as wisher,
    ):
        loader.until_zero_passes(wisher, "/fork_wish")
        first = len(loader.fork)
        fault(loader.node)
        wisher.play("/fork_wish", lift(LIFTING), rate=20.0)
        loader.until(lambda: loader.fork[-1].value == LOWERING)
        loader.spin(HELD_BACK + PROMPT)
        assert not any(each.value > 0.0 for each in loader.fork[first:])
        if fault is Process.freeze:
            loader.node.thaw()
        else:
            loader.restart()
        begin_to_lift(loader, wisher)


def test_restarted_gate_lowers_the_fork_first(loader: Loader) -> None:
    """It knows nothing then; a wish that has never ended waits for a new warning.

    The safety node is frozen until the fork has heard of the new gate, however long that takes.
    """
    with loader.at_work(FORK_GATE), loader.sensors(FORK_WISH) as wisher:
        begin_to_lift(loader, wisher)
        loader.gate.kill()
        loader.node.freeze()
        killed = time.time()
        loader.restart_gate()
        loader.until(lambda: loader.fork[-1].time > killed)
        thawed = time.time()
        loader.node.thaw()
        loader.until(lambda: loader.fork[-1].time > killed and loader.fork[-1].value == LIFTING)
        new = [each for each in loader.fork if each.time > killed]
        assert {each.value for each in new if each.time < thawed} == {LOWERING}
        moved = next(each.time for each in new if each.value == LIFTING)
        assert moved >= thawed + HELD_BACK
