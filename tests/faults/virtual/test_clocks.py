"""A simulated clock that starts late, pauses, races or restarts, in virtual time."""

from __future__ import annotations

import math

import pytest

from tests.support.played import TOPICS, imu, load, speed
from tests.support.virtual_graph import SECOND, VirtualNode
from tests.support.virtual_robot import Sensors, VirtualRobot, ns

TILTED = math.radians(20.0)
WITH_CLOCK = {**TOPICS, "/clock": "rosgraph_msgs/msg/Clock"}
TICK = 0.02


class Simulation(Sensors):
    """Sensors in simulated time, which passes at a chosen speed.

    Attributes:
        seconds: the simulated time.
    """

    def __init__(self, robot: VirtualRobot) -> None:
        """Begin at 1000 s, with the clock paused."""
        super().__init__("simulation", robot.graph, WITH_CLOCK)
        self.seconds = 1000.0
        self._step = 0.0
        self.create_timer(TICK, self._pass)

    def go(self, rate: float = 1.0) -> None:
        """Let time pass at a multiple of the steady time."""
        self._step = TICK * rate

    def _pass(self) -> None:
        if self._step:
            self.tick(self._step)

    def tick(self, step: float = 0.0) -> None:
        """Publish a time that is later, or earlier."""
        from rosgraph_msgs.msg import Clock  # type: ignore[import-untyped]

        self.seconds += step
        message = Clock()
        message.clock.sec, message.clock.nanosec = divmod(round(self.seconds * SECOND), SECOND)
        self.send("/clock", message)


@pytest.fixture
def simulation(robot: VirtualRobot) -> Simulation:
    """Return the simulation; nothing is played yet."""
    return Simulation(robot)


@pytest.fixture
def node(robot: VirtualRobot, simulation: Simulation) -> VirtualNode:
    """Return a safety node in the running simulation, whose robot drives."""
    node = robot.start(use_sim_time=True)
    simulation.go()
    simulation.drive()
    robot.until(lambda: robot.beats)
    robot.until_free()
    return node


def test_node_waits_for_simulated_time(robot: VirtualRobot, simulation: Simulation) -> None:
    """It starts when time begins, and its timeouts count from then."""
    robot.start(use_sim_time=True)
    robot.run(5.0)
    assert not robot.is_active("/halt")
    assert not robot.beats
    told = "starting: waits for /clock, no heartbeat until then"
    assert robot.statuses["faulty_safety_node"].message == told
    simulation.tick()
    robot.run(5.0)
    assert not robot.is_active("/halt")
    simulation.tick(0.49)
    robot.run(0.1)
    assert not robot.is_active("/halt")
    simulation.tick(0.01)
    assert robot.until_active("/halt") == simulation.last["/clock"]


def test_what_came_before_simulated_time_counts(
    robot: VirtualRobot, simulation: Simulation
) -> None:
    """It stays known, what it stopped stays stopped, and intervals pass from the beginning on."""
    robot.start(use_sim_time=True)
    robot.run(0.1)
    simulation.send("/load", load(60.0))
    simulation.send("/imu", imu(TILTED))
    robot.until_active("/slow")
    robot.run(5.0)
    assert not robot.is_active("/halt")
    began = simulation.seconds
    simulation.tick()
    simulation.go()
    robot.until_active("/halt")
    assert simulation.seconds == pytest.approx(began + 0.4, abs=TICK + 1e-6)
    robot.run(2.0)
    states = [seen.value for seen in robot.states["/slow"]]
    assert all(states[states.index(True) :])
    assert robot.told("action slow", "since_ns") == str(ns(began))
    assert robot.told("arm.overloaded", "since_ns") == str(ns(began))
    told = [(each["action"], each["time_ns"]) for each in robot.events if "action" in each]
    assert told[:2] == [("slow", "0"), ("halt", str(ns(began + 0.4)))]


@pytest.mark.usefixtures("node")
def test_paused_simulation_misses_timeouts_but_not_immediate_stops(
    robot: VirtualRobot, simulation: Simulation
) -> None:
    """Paused time pauses timeouts and the heartbeat, but immediate rules still act."""
    simulation.go(0.0)
    simulation.quiet("/speed")
    robot.run(0.1)
    beats = len(robot.beats)
    robot.run(10.0)
    assert len(robot.beats) == beats
    assert not robot.is_active("/halt")
    simulation.send("/speed", speed(2.0))
    assert robot.until_active("/stop") == robot.now
    simulation.send("/speed", speed(0.3))
    silent = simulation.seconds
    simulation.go()
    robot.until_active("/halt")
    assert simulation.seconds == pytest.approx(silent + 0.5, abs=TICK)


def test_restarted_simulation_is_reported_and_monitored(
    robot: VirtualRobot, simulation: Simulation, node: VirtualNode
) -> None:
    """After the step back everything is unknown, and every rule works as from the start."""
    beats = len(robot.beats)
    simulation.tick(-990.0)
    robot.run(0.001)  # no time of the simulation
    assert len(robot.beats) == beats, "all inputs are awaited, as at the start"
    robot.until(lambda: any("the clock stepped back" in line for line in node.log), 1.0)
    robot.until(lambda: len(robot.beats) > beats + 5, 1.0)  # without waiting for the old time
    began = simulation.seconds
    simulation.play("/imu", imu(TILTED))
    robot.until_active("/halt")
    assert simulation.seconds == pytest.approx(began + 0.4, abs=TICK + 1e-6)
    simulation.play("/imu", imu())
    robot.until_free()
    simulation.quiet("/speed")
    silent = simulation.seconds
    robot.until_active("/halt")
    assert simulation.seconds == pytest.approx(silent + 0.5, abs=TICK + 1e-6)
    robot.assert_protects()


@pytest.mark.parametrize("rate", [0.5, 20.0])
def test_simulation_counts_simulated_time(
    robot: VirtualRobot, simulation: Simulation, rate: float
) -> None:
    """At any speed of the simulation, 20 s are neither earlier nor later than 20 s of it."""
    robot.start(use_sim_time=True)
    simulation.go(rate)
    simulation.play("/load", load(0.0), rate=10.0)
    robot.until(lambda: robot.beats)
    simulation.play("/load", load(45.0), rate=10.0)
    began = simulation.seconds
    robot.until(lambda: robot.is_active("/slow"), 20.0 / rate + 1.0)
    assert simulation.seconds == pytest.approx(began + 20.0, abs=rate * TICK + 1e-6)


@pytest.mark.parametrize("chosen", [True, False])
def test_clock_source_cannot_be_changed(
    robot: VirtualRobot, simulation: Simulation, chosen: bool
) -> None:
    """A change of use_sim_time is rejected with a reason, and the node keeps monitoring."""
    node = robot.start(use_sim_time=chosen)
    simulation.go()
    simulation.drive()
    robot.until_free()
    assert "cannot change while the node runs" in node.set_parameter("use_sim_time", not chosen)
    assert node.set_parameter("use_sim_time", chosen) == ""
    assert node.get_parameter("use_sim_time").value == chosen
    robot.assert_protects()


def test_steps_of_simulated_time_do_not_concern_a_node_on_steady_time(
    robot: VirtualRobot, simulation: Simulation
) -> None:
    """Without use_sim_time, whatever /clock says has no effect."""
    robot.start()
    simulation.go(100.0)
    simulation.drive()
    robot.until_free()
    simulation.tick(-500.0)
    simulation.quiet("/imu")
    assert robot.until_active("/halt") == simulation.last["/imu"] + ns(0.5)
