"""The core of a safety node with a monitor controlled by the test, without a graph."""

from __future__ import annotations

import gc
import tempfile
from collections.abc import Callable, Collection
from pathlib import Path
from types import SimpleNamespace
from typing import Any, NamedTuple

import pytest

pytest.importorskip("rclpy")
pytest.importorskip("diagnostic_msgs.msg")

from deros.generators.runtime.python.deros_runtime import realtime
from deros.generators.runtime.python.deros_runtime.instance import Refusal
from deros.generators.runtime.python.deros_runtime.monitor_runner import ActionError
from deros.generators.runtime.python.deros_runtime.report_types import (
    Action,
    Behaviour,
    EventKind,
    RuleMetadata,
)
from deros.generators.runtime.python.deros_runtime.safety_node_core import (
    SafetyNodeCore,
    SafetyNodePorts,
)
from tests.support.clockwork import Clockwork

METADATA = RuleMetadata(
    rules="robot.deros",
    rule_count=2,
    actions_file="robot_actions.py",
    behaviours={"halt": Behaviour("robot.deros:7", "drive.fast", ("drive.fast",))},
    actions={
        "stop": Action(lasts=True, is_latched=True, triggered_by=("halt",)),
        "beep": Action(lasts=False),
        "horn": Action(lasts=True, is_latched=True, triggered_by=("halt",), arguments=(2,)),
    },
)
SECOND = 10**9


class Event(NamedTuple):
    """An event of the monitor."""

    t: int
    kind: EventKind
    action: str
    behaviour: str = "halt"
    arguments: tuple[Any, ...] = ()
    line: int = 7
    holding: tuple[str, ...] = ()
    unknown: tuple[str, ...] = ()
    coming: tuple[str, ...] = ()


class Explanation(NamedTuple):
    """The explanation of a monitor."""

    rules: tuple[Any, ...] = ()
    causes: dict[str, tuple[str, ...]] = {}  # noqa: RUF012 - never changed


class Monitor:
    """A monitor that emits events on request of the test."""

    def __init__(self, emit: Callable[[Event], None], grace: int, latched: Collection[str]) -> None:
        """Start without a deadline."""
        self.emit = emit
        self.grace = grace
        self.latched = set(latched)
        self.waiting = False
        self.holding: tuple[str, ...] = ()
        self.unknown: tuple[str, ...] = ()
        self.coming: tuple[str, ...] = ()
        self.next_deadline: int | None = None
        self.enabled: dict[str, bool] = {}

    def advance(self, _now: int) -> None:
        """Do nothing; time has no effect on these rules."""

    def enable(self, _now: int, behaviour: str, enabled: bool) -> None:
        """Record the behaviour and its state."""
        self.enabled[behaviour] = enabled

    def explain(self) -> Explanation:
        """Return an empty explanation."""
        return Explanation()

    def reset(self, now: int) -> bool:
        """Reset all latched actions unless a behaviour holds."""
        if self.holding or self.unknown:
            return False
        for action in sorted(self.latched):
            self.emit(Event(now, EventKind.RESET, action, ""))
        return True


class Topic:
    """A topic with the states of some actions, and its published messages."""

    def __init__(self, *actions: str) -> None:
        """Start with no action active."""
        self.actions = frozenset(actions)
        self.published: list[list[str]] = []
        self.active: set[str] = set()

    def begin(self, active: Collection[str]) -> None:
        """Start anew."""
        self.active = set(active) & self.actions

    def show(self, action: str, active: bool) -> None:
        """Publish the state of an action."""
        (self.active.add if active else self.active.discard)(action)
        self.publish()

    def publish(self) -> None:
        """Publish the current state."""
        self.published.append(sorted(self.active))

    def prepare(self) -> None:
        """Do nothing."""


class Service:
    """The service of an action, whose calls are recorded among those of a robot."""

    def __init__(self, robot: Robot, action: str) -> None:
        """Belong to an action."""
        self.action = action
        self._robot = robot

    def attach(self, _report_fault: Any, _report_success: Any, _now: Any) -> None:
        """Report nothing."""

    def set_active(self, active: bool) -> None:
        """Record the call, and the states that have been published."""
        if self._robot.stop.published:
            self._robot.calls.append((self.action, active, list(self._robot.stop.published[-1])))

    def check(self) -> None:
        """Do nothing."""


class Robot:
    """A safety node without a graph: the hooks of the core, and the recorded calls."""

    def __init__(self, folder: Path, **settings: Any) -> None:
        """Create the core, which start() starts."""
        self.kinds: list[str] = []
        self.reports: list[str] = []
        self.calls: list[tuple[Any, ...]] = []
        self.beats: list[int] = []
        self.optional: dict[str, bool] = {}
        self.monitor: Any = None
        self.stop = Topic("stop")
        self.file = folder / "latches"
        self.clockwork = Clockwork(SECOND)
        self.node = self.clockwork.node
        self.node.subscriptions = []
        self.node.get_fully_qualified_name.return_value = "/robot"
        self.node.context.get_domain_id.return_value = 7
        self.node.get_parameter.return_value.value = False
        self.node.get_clock.return_value.now.return_value.nanoseconds = 9
        self.node.count_publishers.return_value = 1
        self.node.count_subscribers.return_value = 0
        self.node.publishers = []
        chosen = {
            "publish_freq": 10.0,
            "startup_grace": 1.0,
            "diagnostics_freq": 1.0,
            "realtime_priority": 0,
            "lock_memory": False,
            "garbage_collection": True,
        }
        self.core = SafetyNodeCore(
            self.node, METADATA, SimpleNamespace(**{**chosen, **settings}), self.clockwork.clock
        )

    def start(self, unfilled: Collection[str] = (), services: Collection[str] = ()) -> None:
        """Start the monitoring."""
        states: Any = [("/stop", self.stop)]
        ports = SafetyNodePorts(
            heartbeat="/robot/heartbeat",
            states=states,
            code={"beep": self.beep, "horn": self.horn},
            unfilled=list(unfilled),
            services=[Service(self, action) for action in services],
        )
        self.core.start(self, ports, str(self.file))

    def emit(self, *events: Event) -> None:
        """Let the monitor emit events, as after a message."""
        runner = self.core.runner
        runner.catch_up(runner.now())
        try:
            for event in events:
                self.monitor.emit(event)
        finally:
            runner.settle()

    def beep(self) -> None:
        """Record a call of user code."""
        self.calls.append(("beep", list(self.stop.published[-1])))

    def horn(self, times: int) -> None:
        """Fail for a large argument, like faulty user code."""
        if times > 9:
            raise OSError("no air")
        self.calls.append(("horn", times))

    # Hooks

    def create_monitor(self, _start: int, emit: Any, grace: int, latched: Collection[str]) -> Any:
        """Return a monitor."""
        self.monitor = Monitor(emit, grace, latched)
        return self.monitor

    def enabled_behaviours(self) -> dict[str, bool]:
        """Return the states chosen by the test."""
        return self.optional

    def beat(self, count: int) -> None:
        """Record a heartbeat."""
        self.beats.append(count)

    def publish_events(self, msg: Any) -> None:
        """Record a report."""
        self.kinds.append(next(pair.value for pair in msg.values if pair.key == "kind"))
        self.reports.append(msg.message)

    def publish_diagnostics(self, msg: Any) -> None:
        """Ignore the state."""


@pytest.fixture(autouse=True)
def own_locks(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Use a private folder for the locks of these nodes."""
    monkeypatch.setattr(tempfile, "gettempdir", lambda: str(tmp_path))


@pytest.fixture
def robot(tmp_path: Path) -> Robot:
    """Return a running robot."""
    robot = Robot(tmp_path)
    robot.start()
    return robot


def stop_event(kind: str = "trigger", action: str = "stop", *arguments: Any) -> Event:
    """Return an event."""
    return Event(5, EventKind(kind), action, arguments=arguments)


def test_second_instance_is_refused(tmp_path: Path) -> None:
    """The lock is taken before the node has any port."""
    first = Robot(tmp_path)
    with pytest.raises(Refusal, match="runs already"):
        Robot(tmp_path)
    del first


def test_start_is_reported(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The report lists refused settings and actions without code."""
    monkeypatch.setattr(realtime, "can_lock_memory", lambda: False)
    robot = Robot(tmp_path, lock_memory=True)
    robot.start(unfilled=["beep"])
    assert robot.kinds == ["start", "not_permitted", "unfilled"]
    assert robot.reports[0] == "watching 2 rules of robot.deros"
    assert robot.reports[2] == "action beep does nothing: write its code in robot_actions.py"
    assert robot.monitor.grace == SECOND


def test_services_are_called_after_all_states_and_before_user_code(tmp_path: Path) -> None:
    """This holds whatever the order in the rules; a reset takes back nothing but the calls."""
    robot = Robot(tmp_path)
    robot.start(services=["stop", "brake"])
    robot.calls.clear()
    robot.emit(stop_event(action="beep"), stop_event(action="brake"), stop_event())
    assert robot.calls == [
        ("brake", True, ["stop"]),
        ("stop", True, ["stop"]),
        ("beep", ["stop"]),
    ]
    robot.calls.clear()
    robot.emit(stop_event("refused"), stop_event("reset", "brake"), stop_event("reset"))
    assert robot.calls == [("brake", False, ["stop"]), ("stop", False, [])]
    robot.calls.clear()
    robot.emit(stop_event(action="brake"), stop_event("reset", "brake"))
    assert robot.calls == [("brake", False, [])]


def test_service_of_a_latched_action_is_called_after_a_restart(tmp_path: Path) -> None:
    """The new process does not know whether it had succeeded."""
    before = Robot(tmp_path)
    before.start()
    before.emit(stop_event())
    del before
    gc.collect()  # its lock
    robot = Robot(tmp_path)
    robot.start(services=["stop"])
    assert robot.calls == [("stop", True, ["stop"])]


def test_bound_actions_are_published_before_user_code_runs(robot: Robot) -> None:
    """This holds even if the rules call the user code first."""
    robot.emit(stop_event(action="beep"), stop_event())
    assert robot.stop.published[-1] == ["stop"]
    assert robot.calls == [("beep", ["stop"])]


def test_refused_reset_publishes_nothing(robot: Robot) -> None:
    """The state does not change."""
    robot.emit(stop_event())
    before = list(robot.stop.published)
    robot.emit(Event(6, EventKind.REFUSED, "stop", "", holding=("halt",)))
    assert robot.stop.published == before


def test_reports_are_published_later_and_flushed_at_the_end(robot: Robot) -> None:
    """Messages do not wait for reports."""
    robot.emit(stop_event())
    assert robot.kinds == ["start"]
    robot.core.flush_reports()
    assert robot.kinds == ["start", "trigger"]


def test_failing_action_ends_the_node_after_all_others(robot: Robot) -> None:
    """The state is published, other code runs, the latch is stored and the reports are flushed."""
    with pytest.raises(ActionError):
        robot.emit(stop_event("trigger", "horn", 10), stop_event(action="beep"), stop_event())
    assert robot.calls == [("beep", ["stop"])]
    assert robot.stop.published[-1] == ["stop"]
    assert "stop" in robot.file.read_text()
    assert robot.kinds == ["start", "trigger", "trigger", "trigger"]


def test_latched_actions_survive_the_process(tmp_path: Path, robot: Robot) -> None:
    """The next process starts with them active, and runs their code with its first arguments."""
    robot.emit(stop_event(), stop_event("trigger", "horn", 3))
    robot.core._lock.close()
    again = Robot(tmp_path)
    again.start()
    assert again.monitor.latched == {"stop", "horn"}
    assert again.stop.published[0] == ["stop"]
    assert again.calls == [("horn", 2)]
    assert again.kinds == ["start", "latched", "latched"]


def test_reset_is_refused_while_its_cause_holds(robot: Robot) -> None:
    """It is refused while a behaviour that triggers the action holds or is unknown."""
    assert robot.core.reset() == (True, "no latched action was active")
    robot.emit(stop_event())
    robot.monitor.latched = {"stop"}
    robot.monitor.holding = ("halt",)
    success, text = robot.core.reset()
    assert not success
    assert text.startswith("stop stays active, called for by halt (robot.deros:7")
    robot.monitor.holding = ()
    assert robot.core.reset() == (True, "stop is reset")
    assert robot.stop.published[-1] == []
    assert "stop\n" not in robot.file.read_text()


def test_reset_that_cannot_be_stored_is_refused(robot: Robot) -> None:
    """Nothing is reset, so that a restart forgets no active action."""
    robot.emit(stop_event())
    robot.monitor.latched = {"stop"}
    robot.file.unlink()
    robot.file.mkdir()
    success, text = robot.core.reset()
    assert not success
    assert text.startswith("nothing is reset, because")
    assert robot.stop.published[-1] == ["stop"]


def test_heartbeat_waits_for_the_inputs(robot: Robot) -> None:
    """There is none while one is awaited, also after the grace and after a step of the clock."""
    robot.monitor.waiting = True
    robot.core._publish()
    assert robot.beats == []
    assert "starting" in robot.core._not_ready_reason()
    robot.clockwork.now += 2 * SECOND
    robot.core._publish()
    assert robot.beats == []
    robot.monitor.waiting = False
    robot.core._publish()
    robot.core._publish()
    assert robot.beats == [1, 2]
    assert robot.core._not_ready_reason() == ""
    robot.monitor.waiting = True
    robot.core.stepped()
    assert robot.beats == [1, 2]
    assert "starting" in robot.core._not_ready_reason()


def test_optional_behaviours_follow_their_parameters(tmp_path: Path) -> None:
    """Initial values apply from the start; changes are reported."""
    robot = Robot(tmp_path)
    robot.optional = {"halt": False, "slow": True}
    robot.start()
    assert robot.monitor.enabled == {"halt": False}
    robot.optional = {"halt": True, "slow": True}
    robot.core.switch_behaviours()
    assert robot.monitor.enabled == {"halt": True}
    assert robot.reports[-1] == "halt is enabled"
    robot.optional = {"halt": True, "slow": False}
    robot.core.switch_behaviours()
    robot.core._is_starting = False
    assert robot.core._not_ready_reason() == "disabled: slow"


def test_undecodable_message_is_reported_once_per_topic(robot: Robot) -> None:
    """Further messages of the topic are not reported."""
    for topic in ("/speed", "/speed", "/scan"):
        robot.core.report_undecodable(topic, ValueError("too short"))
    assert robot.reports[1:] == [
        "/speed has carried data that cannot be read: too short",
        "/scan has carried data that cannot be read: too short",
    ]


def test_housekeeping_restores_a_removed_state_file(robot: Robot) -> None:
    """A removed file is written again."""
    robot.emit(stop_event())
    robot.file.unlink()
    robot.core._do_housekeeping()
    assert "stop" in robot.file.read_text()
