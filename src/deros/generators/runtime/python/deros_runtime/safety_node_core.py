"""The part of a safety node that is the same for all rules."""

from __future__ import annotations

from collections.abc import Callable, Collection, Container, Mapping, Sequence, Set
from dataclasses import dataclass
import math
from pathlib import Path
from typing import NamedTuple, Protocol

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from rclpy.node import Node

from .diagnostics import Diagnostics
from .duplicate_instance import DuplicateInstanceDetector
from .event_reporter import ERROR, EventReporter, OK, WARN
from .instance import claim, file_stem
from .latches import default_path, Latches, LatchFile
from .look_ahead import LookAhead
from .monitor_runner import MonitorRunner
from .one_shot_timer import NodeClock, OneShotTimer, steady_clock
from .publishers import PublisherCheck
from .realtime import configure_process
from .report_queue import ReportQueue
from .report_types import ActionCall, Event, EventKind, Explanation, Monitor, RuleMetadata, Value
from .states import StateTopic

HOUSEKEEPING_PERIOD = 100_000_000  # ns


class Settings(Protocol):
    """The parameters that every safety node has."""

    publish_freq: float
    startup_grace: float
    diagnostics_freq: float
    realtime_priority: int
    lock_memory: bool
    garbage_collection: bool


class SafetyNodeHooks(Protocol):
    """What the rules of one robot add to a safety node."""

    def create_monitor(
        self, start: int, emit: Callable[[Event], None], grace: int, latched: Collection[str]
    ) -> Monitor:
        """
        Return a monitor that starts at a time.

        emit is to be called with each of its events. Timeouts begin to count grace nanoseconds
        later. The latched actions in latched are active from the start.
        """

    def enabled_behaviours(self) -> Mapping[str, bool]:
        """Return of each optional behaviour whether its parameter enables it."""

    def beat(self, count: int) -> None:
        """Publish a heartbeat."""

    def publish_events(self, msg: DiagnosticStatus) -> None:
        """Publish a report."""

    def publish_diagnostics(self, msg: DiagnosticArray) -> None:
        """Publish the present state."""


class BoundService(Protocol):
    """A service that an action calls."""

    @property
    def action(self) -> str:
        """Return the name of the action."""

    def attach(
        self,
        report_fault: Callable[[str, str], None],
        report_success: Callable[[str, str], None],
        now: Callable[[], int],
    ) -> None:
        """Set whom to report to; now returns steady time in nanoseconds."""

    def set_active(self, active: bool) -> None:
        """Call the service for a trigger of the action, or do not call it any more."""

    def check(self) -> None:
        """Call again if need be, and report what is wrong."""


@dataclass(frozen=True)
class SafetyNodePorts:
    """The ports and the robot code of a safety node; topics have their full names."""

    heartbeat: str
    states: Sequence[tuple[str, StateTopic]]
    shared: Container[str] = ()  # watched topics that may have any number of publishers
    alone: Sequence[tuple[str, str]] = ()  # those that must not, by their names in the rules
    code: Mapping[str, Callable[..., None]] | None = None  # by the action
    unfilled: Sequence[str] = ()  # the actions whose robot code has yet to be written
    services: Sequence[BoundService] = ()


class Call(NamedTuple):
    """A call of robot code that no event asks for."""

    action: str
    arguments: tuple[Value, ...]


class SafetyNodeCore:
    """
    Runs the monitor of a safety node, carries out what it orders, and reports that.

    All of it runs in the thread of the node's executor. Each subscription takes the time from
    runner.now(), calls runner.catch_up() with it, hands its message to runner.monitor, and calls
    runner.settle() then.
    """

    runner: MonitorRunner  # from start() on

    def __init__(
        self,
        node: Node,
        metadata: RuleMetadata,
        settings: Settings,
        steady: NodeClock | None = None,
    ) -> None:
        """
        Acquire the lock of the node's name, and configure the process.

        Time is that of steady; by default, of the steady clock. Raises Refusal if another process
        of this machine holds the lock.
        """
        self._node = node
        self._steady = steady
        self._metadata = metadata
        self._name = node.get_fully_qualified_name()
        self._domain: int = node.context.get_domain_id()
        self._grace = round(settings.startup_grace * 1e9)
        self._period = round(1e9 / settings.publish_freq)
        self._diagnostics_frequency = settings.diagnostics_freq
        self._not_permitted = configure_process(
            settings.realtime_priority, settings.lock_memory, settings.garbage_collection
        )
        try:
            self._lock = claim(self._name, self._domain)
        except OSError as error:
            self._not_permitted.append(
                f'a second instance on this machine would not be seen: {error}'
            )
        self.received: dict[str, int] = {}  # the time of the last message, by its topic
        self._latches: Latches | None = None
        self._enabled: dict[str, bool] = {}
        self._beats = 0
        self._is_starting = True

    # Start

    def start(self, hooks: SafetyNodeHooks, ports: SafetyNodePorts, state_file: str = '') -> None:
        """
        Start watching.

        state_file is where the latched actions are kept, if not in the usual place.
        """
        node, metadata = self._node, self._metadata
        self._hooks = hooks
        self._code = ports.code or {}
        self._topics = [topic for _, topic in ports.states]
        self._states = {
            action: topic for topic in self._topics for action in sorted(topic.actions)
        }
        steady = self._steady or steady_clock(node)
        self.runner = MonitorRunner(node, steady, self)
        self._events = EventReporter(node, self.runner.clock, metadata, hooks.publish_events)
        lasting = {name: action.lasts for name, action in metadata.actions.items()}
        self._diagnostics = Diagnostics(
            node,
            steady,
            metadata.behaviours,
            lasting,
            hooks.publish_diagnostics,
            self._diagnostics_frequency,
            self.runner.defer,
        )
        self._duplicates = DuplicateInstanceDetector(
            node,
            ports.heartbeat,
            [name for name, _ in ports.states],
            self._report_fault,
            steady.now,
        )
        self._alone = dict(ports.alone)
        self._publisher_check = PublisherCheck(
            node, self._report_fault, ports.shared, frozenset(self._alone.values())
        )
        self._services = {service.action: service for service in ports.services}
        self._due_calls: list[BoundService] = []  # of services, when all states are published
        for service in ports.services:
            service.attach(self._report_fault, self._report_success, steady.now)
        self._report_start(ports.unfilled)
        self._open_latches(state_file)
        self._reports = ReportQueue(
            steady, self._events, self._diagnostics, self._prepare_states, self.runner.defer
        )
        self._publishing = OneShotTimer(self.runner.clock, self._publish)
        self._housekeeping = OneShotTimer(steady, self._do_housekeeping)
        self.runner.start()
        self._run_latched()
        self._housekeeping.schedule(0)
        self._diagnostics.begin(
            self._explain,
            self._holding,
            self.runner.clock,
            self._not_ready_reason,
            self._look_ahead,
            self._last_received,
        )

    def _report_start(self, unfilled: Sequence[str]) -> None:
        metadata = self._metadata
        text = f'watching {metadata.rule_count} rules of {metadata.rules}'
        self._events.report('start', OK, text)
        for text in self._not_permitted:
            self._events.report('not_permitted', WARN, text)
        for action in unfilled:
            text = f'action {action} does nothing: write its code in {metadata.actions_file}'
            self._events.report('unfilled', ERROR, text, action=action)

    def _open_latches(self, state_file: str) -> None:
        known = [name for name, action in self._metadata.actions.items() if action.is_latched]
        if not known:
            return
        path = Path(state_file or default_path(file_stem(self._name, self._domain)))
        self._latches = Latches(LatchFile(path, self._name), known, self._report_fault)
        for action in sorted(self._latches.active):
            text = f'{action} is active, as it was before the start'
            self._events.report('latched', WARN, text, action=action)
            self._diagnostics.latched(action)

    def _run_latched(self) -> None:
        """Run the code of the actions that are active from the start; the states are out."""
        actions = self._metadata.actions
        self.runner.run_again(
            Call(action, actions[action].arguments)
            for action in sorted(self._latched & self._code.keys())
        )

    # What the runner calls

    def begin(self, start: int, emit: Callable[[Event], None]) -> Monitor:
        """Return a monitor that starts now, and show the states that it starts with."""
        hooks = self._hooks
        monitor = hooks.create_monitor(start, emit, self._grace, self._latched)
        self._enabled = dict(hooks.enabled_behaviours())
        for name, enabled in self._enabled.items():
            if not enabled:
                monitor.enable(start, name, enabled)
        for topic in self._topics:
            topic.begin(self._latched)
        self._publish_states()
        for action, service in self._services.items():
            service.set_active(action in self._latched)
        self._publishing.schedule(start + self._period)
        return monitor

    def show(self, event: Event) -> bool:
        """Publish the new state of a bound action; return whether no code is to be run."""
        is_trigger = event.kind == EventKind.TRIGGER
        if is_trigger and self._latches is not None:
            self._latches.mark_pending(event.action)
        topic = self._states.get(event.action)
        service = self._services.get(event.action)
        if topic is None and service is None:
            return not is_trigger or event.action not in self._code
        if event.kind != EventKind.REFUSED:
            if topic is not None:
                topic.show(event.action, is_trigger)
            if service is not None:
                self._show_to(service, is_trigger)
        return True

    def _show_to(self, service: BoundService, is_trigger: bool) -> None:
        """Call a service when all states are published, or do not call it any more."""
        if is_trigger:
            self._due_calls.append(service)
        else:
            self._due_calls = [each for each in self._due_calls if each is not service]
            service.set_active(False)

    def _call_services(self) -> None:
        while self._due_calls:
            self._due_calls.pop(0).set_active(True)

    def run(self, call: ActionCall) -> None:
        """Run an action that is robot code, after the calls of services: these do not wait."""
        self._call_services()
        self._code[call.action](*call.arguments)

    def after(
        self, events: Sequence[Event], done: Sequence[int], states: Sequence[Explanation]
    ) -> None:
        """Call services, save the latches, and report soon what was done."""
        self._call_services()
        if self._latches is not None:
            for event in events:
                self._latches.record(event.action, event.kind != EventKind.RESET)
            self._latches.persist()
        self._reports.add(events, done, states)

    def flush_reports(self) -> None:
        """Publish all reports that wait, before the end."""
        self._reports.flush()

    def stepped(self) -> None:
        """Publish at once when simulated time has begun or stepped back."""
        self._publish()

    # What the node calls

    def report_undecodable(self, topic: str, error: Exception) -> None:
        """Report, once per topic, a message that cannot be read; it counts for nothing."""
        text = f'{topic} has carried data that cannot be read'
        if self._diagnostics.fault(f'data of {topic}', text):
            self._events.report('undecodable', ERROR, f'{text}: {error}', topic=topic)

    def switch_behaviours(self) -> None:
        """Enable or disable the behaviours whose parameter has changed."""
        for name, enabled in self._hooks.enabled_behaviours().items():
            if enabled == self._enabled[name]:
                continue
            self._enabled[name] = enabled
            now = self.runner.now()
            try:
                self.runner.catch_up(now)
                self.runner.monitor.enable(now, name, enabled)
            finally:
                self.runner.settle()
            kind, level = ('enabled', OK) if enabled else ('disabled', WARN)
            self._events.report(kind, level, f'{name} is {kind}', behaviour=name)
            self._diagnostics.changed()

    def reset(self) -> tuple[bool, str]:
        """Reset the latched actions whose causes are all known to be over; return the answer."""
        assert self._latches is not None
        now = self.runner.advance()
        active = sorted(self._latches.active)
        why = {action: self._refusal(action) for action in active}
        refusal = self._latches.allow_reset({action for action in active if why[action]})
        if refusal:
            return False, refusal
        success = self.runner.monitor.reset(now)
        self.runner.settle()
        answers = [f'{a} stays active, {why[a]}' if why[a] else f'{a} is reset' for a in active]
        return success, '; '.join(answers) or 'no latched action was active'

    def _refusal(self, action: str) -> str:
        """Return why a reset of an action is refused now; empty if it is not."""
        monitor = self.runner.monitor
        behaviours = self._metadata.actions[action].triggered_by
        holding, unknown, coming = (
            [name for name in behaviours if name in refusing]
            for refusing in (monitor.holding, monitor.unknown, monitor.coming)
        )
        return self._events.refusal(holding, unknown, coming, monitor.explain())

    # States and heartbeat

    @property
    def _latched(self) -> Set[str]:
        return frozenset() if self._latches is None else self._latches.active

    def _publish_states(self) -> None:
        for topic in self._topics:
            topic.publish()

    def _prepare_states(self) -> None:
        """Prepare the states that can come next, which takes its time."""
        for topic in self._topics:
            topic.prepare()

    def _publish(self) -> None:
        """Repeat the states, and beat."""
        self._publishing.repeat(self._period)
        self._publish_states()
        if self._is_ready():
            self._beats += 1
            self._hooks.beat(self._beats)

    def _is_ready(self) -> bool:
        """Return whether the start is over, or a step of the clock: nothing is awaited."""
        waiting = not self.runner.clock.has_begun or self.runner.monitor.waiting
        if waiting != self._is_starting:
            self._is_starting = waiting
            self._diagnostics.changed()
        return not waiting

    def _not_ready_reason(self) -> str:
        """Return what the node does not do; empty if it watches all rules."""
        if not self.runner.clock.has_begun:
            return 'starting: waits for /clock, no heartbeat until then'
        if self._is_starting:
            return 'starting: no heartbeat until all inputs have come, or are missing'
        disabled = [name for name, enabled in self._enabled.items() if not enabled]
        return f'disabled: {", ".join(disabled)}' if disabled else ''

    # Housekeeping

    def publisher(self, topic: str) -> bool | float:
        """Return True if a topic of the rules has one publisher; NaN if it has several."""
        return math.nan if self._alone[topic] in self._publisher_check.crowded else True

    def _do_housekeeping(self) -> None:
        self._housekeeping.repeat(HOUSEKEEPING_PERIOD)
        self._duplicates.check()
        self._publisher_check.check()
        for service in self._services.values():
            service.check()
        if self._latches is not None:
            self._latches.persist()

    def _explain(self) -> Explanation:
        explanation: Explanation = self.runner.monitor.explain()
        return explanation

    def _holding(self) -> Sequence[str]:
        holding: Sequence[str] = self.runner.monitor.holding
        return holding

    def _look_ahead(self) -> LookAhead | None:
        """Return what looks ahead; None where simulated time stands still before its start."""
        return LookAhead(self.runner.monitor) if self.runner.clock.has_begun else None

    def _last_received(self) -> dict[str, int | None]:
        """Return when the last message of each input came."""
        return {name: self.received.get(topic) for name, topic in self._metadata.inputs.items()}

    def _report_fault(self, subject: str, text: str) -> None:
        """Report, if it is news, what is wrong with something; an empty text takes it back."""
        if self._diagnostics.fault(subject, text) and text:
            self._events.report('fault', ERROR, f'{subject}: {text}', subject=subject)

    def _report_success(self, action: str, service: str) -> None:
        """Report that the service of an action has answered success."""
        text = f'{action}: {service} has answered success'
        self._events.report('answered', OK, text, action=action, service=service)
