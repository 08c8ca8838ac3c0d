"""The session of the reaction benchmark on rclcpp.

Two processes of the same program may differ by some percent, by where the kernel puts their
threads; so there are several of each, and their times are put together.
"""

from __future__ import annotations

import contextlib
import os
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from support.experiment import Immediate, Timed
from support.native_driver import NativeDriver
from support.processes import Processes, own_domain
from support.progress import Line
from support.rclcpp_programs import build, rclcpp_environment, workshop
from support.reaction_results import FASTEST, RCLCPP, SAFETY, USUAL, Run
from support.reaction_rules import Lane, generate, timed_lanes
from support.reaction_session import Wanted, carry_out, events_of, lost, receive_events, start_load
from support.samples import Fired, Trigger

INSTANCES = 4
"""How many processes of each program react at once."""

_SOURCES = Path(__file__).resolve().parents[1] / "reaction_cpp"
_RULE = Lane(SAFETY, "immediate", 0.0)
_TIMED_NODE = "timed_safety_node"


def measure(wanted: Wanted, folder: Path) -> Run:
    """Generate, build, start and measure everything; there must be an rclcpp."""
    base = rclcpp_environment()
    assert base is not None
    lanes = _Lanes.make()
    with contextlib.ExitStack() as stack:
        shop = stack.enter_context(workshop(base))
        programs = _build(shop, lanes.timed, base)
        stack.enter_context(own_domain(folder))
        processes = stack.enter_context(Processes(folder))
        # The domain is one of this process's variables by now.
        env = {**os.environ, "LD_LIBRARY_PATH": base["LD_LIBRARY_PATH"]}
        env.pop("_ROS_WHEELS_BOOTSTRAP_COMPLETE", None)
        _start_nodes(processes, programs, lanes, env, wanted.priority)
        if wanted.load:
            start_load(processes)
        records = [*map(events_of, lanes.nodes), events_of(_TIMED_NODE)]
        driver = NativeDriver(programs["driver"], env, lanes.ends(), records)
        stack.callback(driver.close)
        channels = {each.lane: each for each in driver.channels}
        each_wanted = -(-wanted.immediate // INSTANCES)
        at_once = {
            name: [Immediate(channels[lane], each_wanted) for lane in lanes.immediate[name]]
            for name in lanes.immediate
        }
        later = [
            Timed([channels[lane] for lane in timed], wanted.repeat)
            for timed in (lanes.timed, lanes.floor)
        ]
        immediate = [each for group in at_once.values() for each in group]
        stolen = carry_out("rclcpp", driver, processes, immediate, later)
        samples = {
            name: [sample for each in group for sample in each.samples]
            for name, group in at_once.items()
        }
        reported = receive_events(
            driver, lambda: _triggers(driver, lanes), [*samples[SAFETY], *later[0].samples]
        )
        return Run(
            client=RCLCPP,
            loaded=wanted.load,
            immediate=samples,
            timed=later[0].samples,
            floor=later[1].samples,
            triggers=reported,
            firings=[Fired(*each) for each in processes.end("timed_relay")],
            sleeps=[],
            lost=lost((*at_once[SAFETY], later[0])),
            traffic=processes.end("listener") if wanted.load else 0.0,
            stolen=stolen,
            priority=wanted.priority,
        )


@dataclass(frozen=True, slots=True)
class _Lanes:
    """All lanes, and the names of the nodes that react at once by rules."""

    immediate: dict[str, list[Lane]]
    timed: Sequence[Lane]
    floor: Sequence[Lane]
    nodes: list[str]

    @classmethod
    def make(cls) -> _Lanes:
        immediate = {
            name: [Lane(f"{name}_{number}", "immediate", 0.0) for number in range(INSTANCES)]
            for name in (SAFETY, FASTEST, USUAL)
        }
        nodes = [f"immediate_safety_node_{number}" for number in range(INSTANCES)]
        return cls(immediate, timed_lanes("timed"), timed_lanes("floor"), nodes)

    def ends(self) -> list[tuple[Lane, bool]]:
        """Return all lanes, and whether their states turn false again."""
        found = [(lane, name == SAFETY) for name, group in self.immediate.items() for lane in group]
        found += [(lane, True) for lane in self.timed]
        return [*found, *((lane, False) for lane in self.floor)]


def _build(shop: Path, timed: Sequence[Lane], env: Mapping[str, str]) -> dict[str, Path]:
    """Return the programs."""
    found = {}
    with Line(sys.stderr) as line:
        line.show("rclcpp: building the relays")
        build(_SOURCES, shop / "reaction_cpp_build", env)
        for program in ("driver", "fastest_relay", "usual_relay"):
            found[program] = shop / "reaction_cpp_build" / program
        for name, lanes in (("immediate", [_RULE]), ("timed", timed)):
            line.show(f"rclcpp: building the safety node with {len(lanes)} rules")
            package = generate(name, lanes, shop, target="cpp")
            output = shop / f"{package.name}_build"
            build(package, output, env)
            found[name] = output / f"{name}_safety_node_cpp"
    return found


def _start_nodes(
    processes: Processes,
    programs: Mapping[str, Path],
    lanes: _Lanes,
    env: Mapping[str, str],
    priority: int,
) -> None:
    for node, lane in zip(lanes.nodes, lanes.immediate[SAFETY], strict=True):
        remaps = {"__node": node, _RULE.imu: lane.imu, _RULE.state: lane.state}
        processes.start_program([str(programs["immediate"]), *_ros(remaps)], env, node)
    # The many states of the timed rules, repeated as often as usual, would be a load.
    parameters = ["--ros-args", "-p", "publish_freq:=2.0"]
    parameters += ["-p", f"realtime_priority:={priority}"]
    processes.start_program([str(programs["timed"]), *parameters], env, _TIMED_NODE)
    for lane in lanes.immediate[FASTEST]:
        command = [str(programs["fastest_relay"]), _relayed(lane)]
        processes.start_program([*command, *_ros({"__node": lane.name})], env, lane.name)
    for lane in lanes.immediate[USUAL]:
        remaps = {"__node": lane.name, "imu": lane.imu, "state": lane.state}
        processes.start_program([str(programs["usual_relay"]), *_ros(remaps)], env, lane.name)
    first = ["chrt", "--fifo", str(priority)] if priority else []
    command = [*first, str(programs["fastest_relay"]), *map(_relayed, lanes.floor)]
    processes.start_program([*command, *_ros({"__node": "timed_relay"})], env, "timed_relay")


def _ros(remaps: Mapping[str, str]) -> list[str]:
    rules = [part for old, new in remaps.items() for part in ("-r", f"{old}:={new}")]
    return ["--ros-args", *rules]


def _relayed(lane: Lane) -> str:
    return f"{lane.seconds}:{lane.imu}:{lane.state}"


def _triggers(driver: NativeDriver, lanes: _Lanes) -> list[Trigger]:
    """Return what the safety nodes tell of their stops."""
    from support.reaction_records import triggers

    records = driver.records()
    found = triggers(records[events_of(_TIMED_NODE)])
    for node, lane in zip(lanes.nodes, lanes.immediate[SAFETY], strict=True):
        # All of them name the lane of the rule that they share.
        reported = triggers(records[events_of(node)])
        found += [replace(each, lane=lane.name) for each in reported]
    return found
