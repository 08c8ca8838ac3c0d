"""Judges a round by its messages: nothing here knows what was done to the robot, or its code.

The invariant: when a rule is broken, the actuator is at zero within the stated time, and does not
move again without a reset. A message that the proxy lost was never known, so what counts is what
has *arrived*. That makes three duties, one for each part, and each movement of the actuator has to
be vouched for by a chain of fresh messages through all of them:

* the safety node, while it beats, says that it stops the robot, from when a rule is known to be
  broken until the reset; without a heartbeat, its states do not count;
* the gate lets a command through while the heartbeat that has arrived counts on, the last state
  that has arrived is not a stop, and a command has arrived, each within its loss time; after a zero
  it lets nothing through before a zero command has arrived, and after a lost heartbeat nothing at
  all, since it is not reset within a round;
* the arbiter, the actuator's own part, moves the pedal while a command is fresh.

The latched stop of the engine survives any restart, and is not reset within a round.

Over all of it, whatever the parts say, stands the sum: with the links from the safety node to the
actuator in order, a rule that stays broken has the pedal at zero within the loss times.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import pairwise

from tests.support.chaos.links import (
    COMMAND,
    GATE,
    HEARTBEAT,
    LET_THROUGH,
    LOW_SPEED,
    MOTOR_STOP,
    PEDAL,
    PLANT,
    SAFETY,
    STOP,
    Topic,
)
from tests.support.chaos.record import Message, of_topic
from tests.support.chaos.rules import MANUAL, SHUTS_OFF, TIMEOUT, Broken, broken_rules
from tests.support.chaos.timeline import timeline

LOST_HEARTBEAT = 0.3
LOST_INPUT = 0.3
LOST_COMMAND = 0.3
"""Loss times in s, of the gate and of the arbiter, as the models state them."""

CRAWL = 0.2
"""The limit, in m/s, under ``low_speed``."""

MARGIN_SAFETY, MARGIN_GATE, MARGIN_ARBITER = 0.5, 0.25, 0.25
"""Seconds for each part to take a message in and answer: a second in all, as the guarantees say."""

KEPT = 0.2
"""Seconds for which a latched action has been said before a kill may not undo it any more."""

MARGIN = MARGIN_SAFETY + MARGIN_GATE + MARGIN_ARBITER

SAID_AFTER_BEAT = 0.05
"""Within how many s of a heartbeat the states are there that belong to it."""


@dataclass(frozen=True)
class Violation:
    """What must not be, when it was, in s from the beginning of the round, and by how much."""

    duty: str
    time: float
    reason: str

    def __str__(self) -> str:
        """Return it as a line of the report."""
        return f"at {self.time:.2f} s, {self.duty}: {self.reason}"


@dataclass
class Verdict:
    """Of one round.

    Attributes:
        broken: the rules that were broken, and when.
        violations: what must not be.
        slowest: the longest time, in s, from a broken rule until the pedal was at zero.
        moved: whether the robot drove when the round began, or in it; else a round shows nothing.
        timeline: the messages with their times, to find the reason.
    """

    broken: list[Broken]
    violations: list[Violation]
    slowest: float = 0.0
    moved: bool = False
    timeline: str = ""


@dataclass
class _Life:
    """The safety node from one start to the next, by its heartbeats."""

    beats: list[float] = field(default_factory=list)

    def runs(self) -> Iterator[tuple[float, float]]:
        """Give the times in which it attended: no two beats of them are far apart."""
        begin = self.beats[0]
        for before, beat in pairwise(self.beats):
            if beat - before > LOST_HEARTBEAT:
                yield begin, before
                begin = beat
        yield begin, self.beats[-1]


@dataclass(frozen=True)
class _Duty:
    """The safety node has to say from ``due`` on, until ``end``, that it stops the robot."""

    rule: str
    begin: float
    due: float
    end: float


class Referee:
    """Reckons a round from its messages.

    Args:
        messages: in order of time; those before the round give the state at its beginning.
        delays: when this process was delayed, and by how much; others are not blamed for that.
        begin: of the round, in s.
        end: of the round, in s.
        whole: whether no link between the safety node and the actuator was bad.
    """

    ramp = 0.0
    """Seconds that the gate takes to bring the robot to a stand."""

    def __init__(
        self,
        messages: Sequence[Message],
        delays: Sequence[tuple[float, float]],
        begin: float,
        end: float,
        whole: bool = True,
    ) -> None:
        """Sort the messages by what they are to the referee."""
        self._messages = [message for message in messages if message.time <= end]
        self._delays, self._begin, self._end = delays, begin, end
        self._whole = whole
        self._stops = self._truths("sent", SAFETY, STOP)
        self._shut_off = self._truths("sent", SAFETY, MOTOR_STOP)
        self._known_stops = self._truths("arrived", GATE, STOP)
        self._known_slow = self._truths("arrived", GATE, LOW_SPEED)
        self._lives = list(self._find_lives())
        self._fresh_beats = list(self._find_fresh_beats())
        self._losses = list(self._find_losses())
        self._manual = [
            message.time
            for message in of_topic(self._messages, "arrived", SAFETY, "/plc/mode")
            if _number(message, "/plc/mode") == MANUAL
        ]

    def judge(self) -> Verdict:
        """Return what was broken, and what must not be."""
        broken = [
            each for each in broken_rules(self._messages, self._end) if each.end > self._begin
        ]
        violations = [*self._safety(broken), *self._latch(broken), *self._gate()]
        violations += [*self._arbiter(), *self._sum(broken)]
        moving = [time for time, _ in self._pedal() if time >= self._begin]
        verdict = Verdict(broken, violations, moved=self._drove_before() or bool(moving))
        verdict.timeline = timeline(self._messages, self._begin, self._end)
        for each in broken:
            last = min(each.end, each.begin + LOST_HEARTBEAT + LOST_COMMAND + MARGIN)
            after = [time - each.begin for time in moving if each.begin < time < last]
            verdict.slowest = max([verdict.slowest, *after])
        return verdict

    # The safety node ----------------------------------------------------------------------------

    def _safety(self, broken: Sequence[Broken]) -> Iterator[Violation]:
        for life in self._lives:
            for duty in self._duties(life, broken):
                for beat in life.beats:
                    if not max(duty.due, self._begin) < beat < duty.end:
                        continue
                    if beat - duty.due <= self._held_up(duty.begin, beat):
                        continue
                    # The state goes out just after the beat, unless a reset comes in between.
                    if not _truth_at(self._stops, min(beat + SAID_AFTER_BEAT, duty.end)):
                        yield self._violation(
                            "safety node",
                            beat,
                            f"it beats and does not stop, though {duty.rule}"
                            f" since {duty.begin - self._begin:.2f} s",
                        )
                        break

    def _latch(self, broken: Sequence[Broken]) -> Iterator[Violation]:
        """Give what is wrong with the latched action, which no life of the node forgets."""
        duties = [duty for life in self._lives for duty in self._duties(life, broken)]
        due = [duty.due for duty in duties if duty.rule in SHUTS_OFF]
        due += [
            time + KEPT
            for time, truth in self._shut_off
            if truth and _truth_at(self._shut_off, time + KEPT)
        ]
        for time, truth in self._shut_off:
            since = min((each for each in due if self._begin < each), default=self._end)
            if not truth and time > since + self._held_up(since, time):
                yield self._violation(
                    "safety node",
                    time,
                    "it says that the engine may run, though it was to stop it"
                    f" at {since - self._begin:.2f} s",
                )
                return

    def _duties(self, life: _Life, broken: Sequence[Broken]) -> Iterator[_Duty]:
        """Give what it has to have seen: what lasted for long enough while it attended."""
        for first, last in life.runs():
            # Who has just been started knows an input when it is missing, at the latest.
            known = first + TIMEOUT if first == life.beats[0] else first
            for each in broken:
                begin, end = max(each.begin, known), min(each.end, last)
                if end - begin > MARGIN_SAFETY + self._held_up(begin, end):
                    later = (time for time in self._manual if time >= begin)
                    reset = min(later, default=self._end)
                    yield _Duty(each.rule, begin, begin + MARGIN_SAFETY, reset)

    def _find_lives(self) -> Iterator[_Life]:
        life, before = _Life(), -1.0
        for message in of_topic(self._messages, "sent", SAFETY, HEARTBEAT.name):
            count = _number(message, HEARTBEAT.name)
            if count <= before:
                yield life
                life = _Life()
            life.beats.append(message.time)
            before = count
        if life.beats:
            yield life

    # The gate -----------------------------------------------------------------------------------

    def _gate(self) -> Iterator[Violation]:
        commands = [
            message.time for message in of_topic(self._messages, "arrived", GATE, COMMAND.name)
        ]
        zeros = [
            message.time
            for message in of_topic(self._messages, "arrived", GATE, COMMAND.name)
            if not _speed(message)
        ]
        seen: set[str] = set()
        standing: float | None = None  # since when
        for message in of_topic(self._messages, "sent", GATE, LET_THROUGH.name):
            speed = _speed(message)
            stood, standing = standing, None if speed else standing or message.time
            if message.time < self._begin or not speed:
                continue
            reason = self._unfounded(message.time, speed, commands)
            reason = reason or self._unmeant(message.time, speed, stood, zeros)
            kind = reason.partition(",")[0]
            if reason and kind not in seen:
                seen.add(kind)
                yield self._violation("gate", message.time, reason)

    def _unfounded(self, now: float, speed: float, commands: Sequence[float]) -> str:
        """Return why the gate must not let this through, or nothing."""
        margin = MARGIN_GATE + self._held_up(now - LOST_HEARTBEAT - MARGIN_GATE, now)
        since = true_since(self._known_stops, now)
        if since is not None and now - since > margin:
            return f"it passes {speed:.2f} m/s, {now - since:.2f} s after the stop has arrived"
        beat = last_until(self._fresh_beats, now)
        if now - beat > LOST_HEARTBEAT + margin:
            return f"it passes {speed:.2f} m/s, {now - beat:.2f} s after the last fresh heartbeat"
        silent = now - last_until(commands, now)
        if silent > LOST_INPUT + margin:
            return f"it passes {speed:.2f} m/s, {silent:.2f} s after a command"
        slow = true_since(self._known_slow, now)
        if slow is not None and now - slow > margin and abs(speed) > CRAWL + 1e-6:
            return f"it passes {speed:.2f} m/s, {now - slow:.2f} s after the limit has arrived"
        return ""

    def _unmeant(
        self, now: float, speed: float, stood: float | None, zeros: Sequence[float]
    ) -> str:
        """Return why the gate must not let the robot move again, or nothing."""
        lost = next((time for time in self._losses if self._begin <= time < now), None)
        if lost is not None:
            at = lost - self._begin
            return f"nobody has reset it, and it passes {speed:.2f} m/s: lost at {at:.2f} s"
        if stood is not None and last_until(zeros, now) < stood - MARGIN_GATE:
            at = stood - self._begin
            return f"nobody has commanded zero, and it passes {speed:.2f} m/s: stood at {at:.2f} s"
        return ""

    def _find_losses(self) -> Iterator[float]:
        """Give when the gate has certainly been without a heartbeat for too long."""
        for before, beat in pairwise(self._fresh_beats):
            limit = LOST_HEARTBEAT + MARGIN_GATE + self._held_up(before, beat)
            if beat - before > limit:
                yield before + limit

    def _find_fresh_beats(self) -> Iterator[float]:
        """Give when a heartbeat has arrived at the gate that no earlier one of its life equals."""
        most, starts = -1.0, [life.beats[0] for life in self._lives]
        for message in of_topic(self._messages, "arrived", GATE, HEARTBEAT.name):
            count = _number(message, HEARTBEAT.name)
            if starts and message.time >= starts[0]:
                starts.pop(0)
                if count <= most:
                    most = -1.0
            if count > most:
                most = count
                yield message.time

    # The actuator -------------------------------------------------------------------------------

    def _pedal(self) -> Iterator[tuple[float, float]]:
        """Give when the pedal was moved, and where to."""
        for message in of_topic(self._messages, "sent", PLANT, PEDAL.name):
            position = float(_number(message, PEDAL.name))
            if position:
                yield message.time, position

    def _drove_before(self) -> bool:
        """Return whether the robot drove when the round began: a fault may stop it at once."""
        sent = of_topic(self._messages, "sent", PLANT, PEDAL.name)
        before = [message for message in sent if message.time < self._begin]
        return bool(before) and bool(_number(before[-1], PEDAL.name))

    def _arbiter(self) -> Iterator[Violation]:
        arrived = of_topic(self._messages, "arrived", PLANT, LET_THROUGH.name)
        orders = [message.time for message in arrived if _speed(message)]
        for now, position in self._pedal():
            limit = LOST_COMMAND + MARGIN_ARBITER
            if now < self._begin or now - last_until(orders, now) <= limit + self._held_up(
                now - limit, now
            ):
                continue
            yield self._violation(
                "arbiter", now, f"the pedal is at {position:.2f} without a fresh command"
            )
            return

    def _sum(self, broken: Sequence[Broken]) -> Iterator[Violation]:
        if not self._whole:
            return
        allowed = LOST_HEARTBEAT + LOST_COMMAND + self.ramp + MARGIN
        starts = [life.beats[0] for life in self._lives]
        for now, position in self._pedal():
            for each in broken:
                # A node that was started meanwhile may not have known it before.
                known = max([each.begin, *(s + TIMEOUT for s in starts if s <= now)])
                late = now - known - allowed
                if now > self._begin and now < each.end and late > self._held_up(known, now):
                    yield self._violation(
                        "robot",
                        now,
                        f"the pedal is at {position:.2f}, though {each.rule} since"
                        f" {each.begin - self._begin:.2f} s",
                    )
                    return

    # What all need ------------------------------------------------------------------------------

    def _violation(self, duty: str, time: float, reason: str) -> Violation:
        return Violation(duty, time - self._begin, reason)

    def _held_up(self, begin: float, end: float) -> float:
        """Return for how long this side was held up, in a time and a little before it."""
        return sum(delay for time, delay in self._delays if begin <= time <= end + delay)

    def _truths(self, place: str, domain: str, topic: Topic) -> list[tuple[float, bool]]:
        return [
            (message.time, bool(_number(message, topic.name)))
            for message in self._messages
            if (message.place, message.domain, message.topic) == (place, domain, topic.name)
        ]


def _number(message: Message, topic: str) -> float:
    from rclpy.serialization import deserialize_message

    from tests.support.chaos.links import BY_NAME

    return deserialize_message(message.data, BY_NAME[topic].message_type()).data  # type: ignore[no-any-return]


def _speed(message: Message) -> float:
    """Return the commanded speed in m/s; a turn at a stand counts, too."""
    from rclpy.serialization import deserialize_message

    twist = deserialize_message(message.data, COMMAND.message_type())
    return float(twist.linear.x or twist.angular.z)


def last_until(times: Sequence[float], now: float) -> float:
    """Return the last of the times up to ``now``."""
    place = bisect_right(times, now)
    return times[place - 1] if place else float("-inf")


def _truth_at(truths: Sequence[tuple[float, bool]], now: float) -> bool:
    """Return what was last said up to ``now``; nothing said is false."""
    place = bisect_right(truths, now, key=lambda each: each[0])
    return truths[place - 1][1] if place else False


def true_since(truths: Sequence[tuple[float, bool]], now: float) -> float | None:
    """Return since when it has been said without a break, or nothing."""
    since = None
    for time, truth in truths:
        if time > now:
            break
        since = (time if since is None else since) if truth else None
    return since
