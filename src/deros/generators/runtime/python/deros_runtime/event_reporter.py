"""Reports the events of a safety node, on a topic and in its log."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from diagnostic_msgs.msg import DiagnosticStatus, KeyValue
from rclpy.node import Node

from .one_shot_timer import NodeClock
from .report_types import Event, EventKind, Explanation, RuleMetadata

OK, WARN, ERROR = DiagnosticStatus.OK, DiagnosticStatus.WARN, DiagnosticStatus.ERROR
HARDWARE_ID = 'deros safety node'  # by which its reports are told from those of other nodes


class EventReporter:
    """Publishes and logs events, always after they have been acted upon."""

    def __init__(
        self,
        node: Node,
        clock: NodeClock,
        metadata: RuleMetadata,
        publish: Callable[[DiagnosticStatus], None],
    ) -> None:
        """Set up; clock is that of the monitor."""
        self._node = node
        self._clock = clock
        self._metadata = metadata
        self._behaviours = metadata.behaviours
        self._publish = publish
        self._told = ('', -1)  # the behaviour whose cause was told last, and of which time

    def report_monitor_event(self, event: Event, done: int, after: Explanation) -> None:
        """
        Report an event of the monitor.

        done is when it was acted upon, in the monitor's time; after is the monitor's explanation
        after it.
        """
        message, level = self._described(event, after)
        told = {
            'action': event.action,
            'origin': f'{self._metadata.rules}:{event.line}' if event.line else '',
            'time_ns': event.t + self._clock.origin,
            'published_ns': done + self._clock.origin,
        }
        if event.arguments:
            told['arguments'] = ', '.join(map(repr, event.arguments))
        behaviour = self._behaviours.get(event.behaviour)
        if behaviour is not None:
            told |= {
                'behaviour': event.behaviour,
                'origin': behaviour.origin,
                'condition': behaviour.condition,
                'cause': cause(event.behaviour, after),
            }
            told |= self._values(event.behaviour, after)
        if event.kind == EventKind.REFUSED:
            told |= {'holding': ', '.join(event.holding), 'unknown': ', '.join(event.unknown)}
            told |= {'coming': ', '.join(event.coming)}
            for name in (*event.holding, *event.unknown, *event.coming):
                told[f'cause {name}'] = cause(name, after)
            for name in (*event.holding, *event.unknown, *event.coming):
                told |= self._values(name, after)
        self.report(event.kind.value, level, message, **told)

    def report(self, kind: str, level: bytes, message: str, **values: object) -> None:
        """Report any other event."""
        self._log(level, message)
        told = {'kind': kind, **values, 'ros_time_ns': self._node.get_clock().now().nanoseconds}
        self._publish(
            DiagnosticStatus(
                level=level,
                name=self._node.get_fully_qualified_name(),
                message=message,
                hardware_id=HARDWARE_ID,
                values=[KeyValue(key=key, value=str(value)) for key, value in told.items()],
            )
        )

    def origin(self, behaviour: str) -> str:
        """Return a behaviour with its place in the rules and its condition."""
        found = self._behaviours[behaviour]
        return f'{behaviour} ({found.origin}: if {found.condition})'

    def refusal(
        self,
        holding: Sequence[str],
        unknown: Sequence[str],
        coming: Sequence[str],
        present: Explanation,
    ) -> str:
        """
        Return why a reset is refused; empty if it is not.

        holding, unknown and coming are the behaviours that trigger the action and whose conditions
        hold, are unknown or are on their way; present is the monitor's explanation.
        """
        reasons = []
        if holding:
            told = (self._origin_holding(name, present) for name in holding)
            reasons.append(f'called for by {", ".join(told)}')
        if coming:
            told = (self._origin_holding(name, present) for name in coming)
            reasons.append(f'on its way: {", ".join(told)}')
        if unknown:
            told = (self._origin_unknown(name, present) for name in unknown)
            reasons.append(f'not known to be false: {", ".join(told)}')
        return '; '.join(reasons)

    def _origin_holding(self, behaviour: str, present: Explanation) -> str:
        """Return a behaviour with its place in the rules, and why it holds or is on its way."""
        found = cause(behaviour, present)
        if not found:
            return self.origin(behaviour)
        return f'{behaviour} ({self._behaviours[behaviour].origin}): {found}'

    def _origin_unknown(self, behaviour: str, present: Explanation) -> str:
        """Return a behaviour with its place in the rules, and what is unknown."""
        found = cause(behaviour, present)
        if not found:
            return self.origin(behaviour)
        return f'{behaviour} ({self._behaviours[behaviour].origin}: {found})'

    def _values(self, behaviour: str, after: Explanation) -> dict[str, str]:
        """Return the verdicts of the rules that a behaviour depends on, and the values behind."""
        told = {}
        for state in after.rules:
            if state.name in self._behaviours[behaviour].rules:
                told[f'rule {state.name}'] = shown(state.value)
                told |= {f'value {term}': shown(value) for term, value in state.reads}
        return told

    def _log(self, level: bytes, message: str) -> None:
        log = self._node.get_logger()
        if level == OK:  # a line of its own for each severity, as rclpy demands
            log.info(message)
        elif level == WARN:
            log.warning(message)
        else:
            log.error(message)

    def _described(self, event: Event, after: Explanation) -> tuple[str, bytes]:
        if event.kind == EventKind.CLOCK_STEP:
            return 'the clock stepped back: all inputs are unknown until their next message', ERROR
        if event.kind == EventKind.RESET:
            return f'{event.action} is reset', OK
        if event.kind == EventKind.REFUSED:
            why = self.refusal(event.holding, event.unknown, event.coming, after)
            return f'{event.action} stays active, {why}', WARN
        return self._described_trigger(event, after)

    def _described_trigger(self, event: Event, after: Explanation) -> tuple[str, bytes]:
        action = self._metadata.actions.get(event.action)  # log_state is not among them
        what = event.action if action is not None else str(event.arguments[0])
        told = event.behaviour, event.t
        if told == self._told:  # with the cause, by another action
            by, level = event.behaviour, WARN if action is not None else OK
        else:
            by, level = self._origin_holding(event.behaviour, after), WARN
        self._told = told
        is_release = action is not None and action.is_release
        return f'{what}, by {by}', OK if is_release else level


def cause(behaviour: str, explained: Explanation) -> str:
    """
    Return why a behaviour holds, is on its way, or is unknown.

    Empty if it no longer does: a message may show that the clock has stepped back, and at once
    change what the step caused.
    """
    return '; '.join(explained.causes.get(behaviour, ()))


def shown(value: object) -> str:
    """Return a value as text."""
    if value is None:
        return 'unknown'
    if isinstance(value, float):
        return str(value + 0.0)  # which makes 0.0 of -0.0
    return str(value).lower() if isinstance(value, bool) else str(value)
