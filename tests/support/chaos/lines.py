"""The feeding robot with a gate that uses every line, and the referee's own reading of that gate.

Two sources, of which the mission has to begin with zero; a limit that stands; a ramp; lines that
hold, send and fall silent; and a wait before moving. The limits and times are written down here
once more; nothing is taken from the gate's table or its logic.
"""

from __future__ import annotations

import shutil
from collections.abc import Iterator, Sequence
from functools import cached_property
from pathlib import Path
from typing import Any

from tests.support.chaos.links import COMMAND, CONTROLLER_OK, GATE, JOYSTICK, LET_THROUGH
from tests.support.chaos.record import Message, of_topic
from tests.support.chaos.referee import (
    LOST_HEARTBEAT,
    LOST_INPUT,
    MARGIN_GATE,
    Referee,
    Violation,
    last_until,
    true_since,
)

GATE_LINES = """\
gate /panel/joystick for 0.3 sec over /controller/command for 0.3 sec from zero
  -> /actuators/command : geometry_msgs.Twist rate 20 Hz
  "Lets the mission drive as far as the safety node allows" {
  always: limit linear.x to [-0.35, 0.35] m/s;
  lost heartbeat for 0.3 sec: silence until reset;
  stop: zero ramp linear.x 1 m/s2;
  lost input: send { linear.z = -0.125 m/s };
  low_speed: hold;
  wait 0.3 sec before moving: controllerOk;
  resume on zero command;
}
"""

TOP, RATE, WAIT = 0.35, 1.0, 0.3
"""The standing limit in m/s, the ramp in m/s2, and the wait in s."""

NOISE = 1e-6


def change_models(example: Path, folder: Path) -> Path:
    """Copy the feeding robot's models, give them this gate, and return the folder."""
    models = shutil.copytree(example, folder, dirs_exist_ok=True)
    rules = models / "feeding_robot.deros"
    text = rules.read_text(encoding="utf-8")
    rules.write_text(text[: text.index("\ngate ")] + "\n" + GATE_LINES, encoding="utf-8")
    system = models / "feeding_robot.system"
    text = system.read_text(encoding="utf-8")
    first = "  external topic /panel/mode"
    assert text.count(first) == 1
    joystick = f"  external topic {JOYSTICK.name} : geometry_msgs.Twist\n"
    system.write_text(text.replace(first, joystick + first), encoding="utf-8")
    return models


class LinesReferee(Referee):
    """Judges a round of the robot with this gate; all duties of the others are the same."""

    ramp = TOP / RATE

    def _gate(self) -> Iterator[Violation]:
        """Give what the gate must not publish, the first of each kind."""
        seen: set[str] = set()
        before: Any = None
        for message in of_topic(self._messages, "sent", GATE, LET_THROUGH.name):
            command = _read(message)
            reason = self._wrong(message.time, command, before)
            before = command
            kind = reason.partition(",")[0]
            if reason and message.time >= self._begin and kind not in seen:
                seen.add(kind)
                yield self._violation("gate", message.time, reason)

    def _wrong(self, now: float, command: Any, before: Any) -> str:
        """Return why the gate must not publish this after what it has published, or nothing."""
        speed, turn = command.linear.x, command.angular.z
        if abs(speed) > TOP + NOISE:
            return f"it passes {speed:.2f} m/s, above the limit that stands"
        lost = next((time for time in self._losses if self._begin <= time < now), None)
        if lost is not None:
            return f"it is not silent, though nobody has reset it: lost at {lost - self._begin:.2f}"
        if not speed and not turn:
            return ""
        if command.linear.z:
            return f"it sends what stops, and passes {speed:.2f} m/s with it"
        return (
            self._unfounded_lines(now, speed, turn, before)
            or self._unmeant_source(now, speed)
            or self._unwarned(now, speed, before)
        )

    def _unfounded_lines(self, now: float, speed: float, turn: float, before: Any) -> str:
        margin = MARGIN_GATE + self._held_up(now - LOST_HEARTBEAT - MARGIN_GATE, now)
        beat = last_until(self._fresh_beats, now)
        if now - beat > LOST_HEARTBEAT + margin:
            return f"it passes {speed:.2f} m/s, {now - beat:.2f} s after the last fresh heartbeat"
        commanded = max(last_until(self._times_of(topic), now) for topic in (COMMAND, JOYSTICK))
        stop = true_since(self._known_stops, now)
        if stop is not None and now - stop > margin:
            late = now - stop - margin
            if turn or abs(speed) > max(TOP - RATE * late, 0.0) + NOISE:
                return f"it passes {speed:.2f} m/s, {now - stop:.2f} s after the stop has arrived"
        elif now - commanded > LOST_INPUT + self.ramp + margin:
            return f"it passes {speed:.2f} m/s, {now - commanded:.2f} s after a command"
        slow = true_since(self._known_slow, now)
        if slow is not None and now - slow > margin and before is not None:
            held = before.linear.x
            if abs(speed) > abs(held) + NOISE:
                return f"it passes {speed:.2f} m/s, and is to hold {held:.2f} m/s"
        return ""

    def _unmeant_source(self, now: float, speed: float) -> str:
        """Return why the mission must not drive on where the joystick has commanded."""
        steered = last_until(self._times_of(JOYSTICK), now)
        late = now - steered - LOST_INPUT - self.ramp - MARGIN_GATE
        if steered < self._begin or late <= self._held_up(steered, now):
            return ""
        if last_until(self._zeros, now) > steered:
            return ""
        return f"the mission has not commanded zero, and it passes {speed:.2f} m/s"

    def _unwarned(self, now: float, speed: float, before: Any) -> str:
        """Return why what stands must not move off yet, or nothing."""
        if before is None or before.linear.x or before.angular.z or before.linear.z:
            return ""
        allowed = true_since(self._known_ok, now)
        if allowed is None or now - allowed < WAIT - NOISE:
            return f"it moves off at {speed:.2f} m/s, and nobody has warned for {WAIT} s"
        return ""

    # What has arrived at the gate

    def _times_of(self, topic: Any) -> Sequence[float]:
        return self._joystick if topic is JOYSTICK else self._mission

    @cached_property
    def _joystick(self) -> Sequence[float]:
        return [m.time for m in of_topic(self._messages, "arrived", GATE, JOYSTICK.name)]

    @cached_property
    def _mission(self) -> Sequence[float]:
        return [m.time for m in of_topic(self._messages, "arrived", GATE, COMMAND.name)]

    @cached_property
    def _zeros(self) -> Sequence[float]:
        arrived = of_topic(self._messages, "arrived", GATE, COMMAND.name)
        read = ((message.time, _read(message)) for message in arrived)
        return [time for time, each in read if not (each.linear.x or each.angular.z)]

    @cached_property
    def _known_ok(self) -> Sequence[tuple[float, bool]]:
        return self._truths("arrived", GATE, CONTROLLER_OK)


def _read(message: Message) -> Any:
    from rclpy.serialization import deserialize_message

    return deserialize_message(message.data, COMMAND.message_type())
