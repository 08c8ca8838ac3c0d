"""The session of the reaction benchmark on rclpy."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from support.experiment import Immediate, Timed
from support.processes import Processes, own_domain
from support.reaction_results import FASTEST, RCLPY, SAFETY, USUAL, Run
from support.reaction_rules import Lane, generate, timed_lanes
from support.reaction_session import Wanted, carry_out, events_of, lost, receive_events, start_load
from support.samples import Fired

_EVENTS = (events_of("immediate_safety_node"), events_of("timed_safety_node"))


def measure(wanted: Wanted, folder: Path) -> Run:
    """Generate, start and measure everything."""
    immediate = {name: Lane(name, "immediate", 0.0) for name in (SAFETY, FASTEST, USUAL)}
    timed, floor = timed_lanes("timed"), timed_lanes("floor")
    packages = (
        generate("immediate", [immediate[SAFETY]], folder),
        generate("timed", timed, folder),
    )
    with own_domain(folder), Processes(folder) as processes:
        _start_nodes(processes, packages, immediate, floor)
        if wanted.load:
            start_load(processes)
        # Only now: the domain must be chosen before ROS is imported.
        from diagnostic_msgs.msg import DiagnosticStatus

        from support.driver import Driver
        from support.reaction_records import triggers

        driver = Driver([(topic, DiagnosticStatus) for topic in _EVENTS])
        at_once = {
            name: Immediate(driver.channel(lane, name == SAFETY), wanted.immediate)
            for name, lane in immediate.items()
        }
        later = [
            Timed([driver.channel(lane, resets) for lane in lanes], wanted.repeat)
            for lanes, resets in ((timed, True), (floor, False))
        ]
        stolen = carry_out("rclpy", driver, processes, list(at_once.values()), later)
        reported = receive_events(
            driver,
            lambda: [each for topic in _EVENTS for each in triggers(driver.records[topic])],
            [*at_once[SAFETY].samples, *later[0].samples],
        )
        driver.close()
        return Run(
            client=RCLPY,
            loaded=wanted.load,
            immediate={name: each.samples for name, each in at_once.items()},
            timed=later[0].samples,
            floor=later[1].samples,
            triggers=reported,
            firings=[Fired(*each) for each in processes.end("timed_relay")],
            sleeps=processes.end("sleeper"),
            lost=lost((at_once[SAFETY], later[0])),
            traffic=processes.end("listener") if wanted.load else 0.0,
            stolen=stolen,
        )


def _start_nodes(
    processes: Processes,
    packages: tuple[Path, Path],
    immediate: dict[str, Lane],
    floor: Sequence[Lane],
) -> None:
    for name, package in zip(("immediate", "timed"), packages, strict=True):
        module = f"{name}_safety.{name}_safety_node"
        # The many states of the timed rules, repeated as often as usual, would be a load.
        parameters = ["--ros-args", "-p", "publish_freq:=2.0"] if name == "timed" else []
        processes.start(module, *parameters, path=package)
    for name in (FASTEST, USUAL):
        lane = immediate[name]
        remaps = ["--ros-args", "-r", f"imu:={lane.imu}", "-r", f"state:={lane.state}"]
        processes.start(f"reaction_nodes.{name}_relay", *remaps)
    lanes = [f"{lane.seconds}:{lane.imu}:{lane.state}" for lane in floor]
    processes.start("reaction_nodes.timed_relay", *lanes)
    processes.start("reaction_nodes.sleeper")
