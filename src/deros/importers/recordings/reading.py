"""Recordings as a system: an external topic for each that was recorded."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from deros.generators.text.prose import printable_line
from deros.importers.node_text import qos_clause
from deros.importers.readers import Request, UnreadableError
from deros.importers.recordings.definitions import (
    Needed,
    Texts,
    definitions_in,
    differs,
    message_type,
)
from deros.importers.recordings.opened import Recording, opened
from deros.importers.results import INTERFACES, Imported, Missing, Parts
from deros.interfaces.types import InterfaceType
from deros.models.common import QosProfile
from deros.names.names import check_topic_name

_EVERYWHERE = {
    "/rosout": "rcl_interfaces/msg/Log",
    "/parameter_events": "rcl_interfaces/msg/ParameterEvent",
    "/events/write_split": "rosbag2_interfaces/msg/WriteSplitEvent",
}
"""Topics of ROS 2 and of the recorder itself."""

_OF_MANAGED_NODES = ("/transition_event", "lifecycle_msgs/msg/TransitionEvent")
_SERVED = re.compile(r"(?P<owner>.+)/(?:_service_event|(?P<action>_action)/\w+)")
_SERVED_TYPE = re.compile(
    r"(?P<package>\w+)/(?:srv/(?P<service>\w+)_Event|action/(?P<action>\w+)_FeedbackMessage)"
)
"""The hidden topics of services and actions, and the types that show whose they are.

Source: ROS 2 design, "Actions"; REP 2012, "Service Introspection".
"""


def read_recordings(request: Request) -> Imported:
    """Return a system with the topics of recordings, and the message definitions it needs.

    Raises:
        UnreadableError: if a recording cannot be read, or none has a topic.
    """
    recordings: list[Recording] = []
    missing: list[Missing] = []
    for path in request.files:
        read, more = opened(path)
        recordings += read
        missing += more
    merged = _Merged()
    for recording in recordings:
        merged.add(recording)
    if not merged.topics and not merged.served:
        where = ", ".join(map(str, request.files))
        raise UnreadableError(f"{where}: no topic but those of ROS 2 itself is recorded")
    types = [each for topic in merged.topics.values() for each in topic.types]
    needed = Needed(list(dict.fromkeys(types)), merged.definitions, request.is_known)
    left_out = [*merged.left_out, *_unusable(merged, needed)]
    missing += [*merged.conflicts, *_skewed(merged, needed, request), *left_out]
    name = request.name or "robot"
    lines = [*_lines(merged, needed), *(f"// {_plain(each)}" for each in left_out)]
    body = "\n".join(["topics", *(f"  {line}" for line in lines)]) + "\n"
    interfaces = {
        f"{INTERFACES}/{each.package}/msg/{each.name}.msg": text
        for each, text in sorted(needed.texts.items())
    }
    texts = {f"{name}.system": Parts(f"system {name}\n", body)}
    return Imported(texts, tuple(map(str, missing)), interfaces)


def _plain(missing: Missing) -> str:
    return f"{missing.what} {missing.why}"


@dataclass
class _Topic:
    """A topic of one recording or several.

    Attributes:
        types: each with the recording that has it first.
        offered: each profile once.
        messages: how many.
        periods: between two messages, how many.
        duration_ns: of the recordings that have it.
    """

    types: dict[InterfaceType, Path] = field(default_factory=dict)
    offered: dict[QosProfile, None] = field(default_factory=dict)
    messages: int = 0
    periods: int = 0
    duration_ns: int = 0


@dataclass
class _Merged:
    """What several recordings have.

    Attributes:
        topics: by name.
        served: actions and services, of which hidden topics were recorded, by name; what each is.
        definitions: the first one of each type.
        left_out: what cannot be a topic of a model.
        conflicts: where recordings do not agree.
    """

    topics: dict[str, _Topic] = field(default_factory=dict)
    served: dict[str, str] = field(default_factory=dict)
    definitions: Texts = field(default_factory=dict)
    left_out: list[Missing] = field(default_factory=list)
    conflicts: list[Missing] = field(default_factory=list)
    _origins: dict[InterfaceType, Path] = field(default_factory=dict)

    def add(self, recording: Recording) -> None:
        """Add the topics of a recording."""
        messages: dict[str, int] = {}
        for each in recording.channels:
            if _is_internal(each.topic, each.type) or self._is_served(each.topic, each.type):
                continue
            what = printable_line(f"topic {each.topic} : {each.type}")[:300]
            of = message_type(each.type)
            if why := _name_fault(each.topic):
                why = f"is left out: its name {printable_line(why)}"
                self._leave_out(what, why, recording.path)
            elif of is None:
                why = "is left out: that is not the type of a message of ROS 2"
                self._leave_out(what, why, recording.path)
            else:
                topic = self.topics.setdefault(each.topic, _Topic())
                topic.types.setdefault(of, recording.path)
                topic.offered.update(dict.fromkeys(each.offered))
                messages[each.topic] = messages.get(each.topic, 0) + each.messages
                self._define(of, each.language, each.definition, recording.path)
        for name, count in messages.items():
            topic = self.topics[name]
            topic.messages += count
            topic.periods += max(count - 1, 0)
            topic.duration_ns += recording.duration_ns

    def _leave_out(self, what: str, why: str, path: Path) -> None:
        missing = Missing(what, why, str(path))
        if missing not in self.left_out:
            self.left_out.append(missing)

    def _is_served(self, name: str, of_type: str) -> bool:
        """Note the action or the service that a hidden topic belongs to."""
        found = _SERVED.fullmatch(name)
        if found is None:
            return False
        owner = found["owner"]
        kind = "a service" if found["action"] is None else "an action"
        if _name_fault(owner) is None:
            self.served.setdefault(owner, kind)
            named = _SERVED_TYPE.fullmatch(of_type)
            of = named and message_type("/".join(filter(None, named.groups())))
            if of:
                self.served[owner] = f"{kind}: {of.short}"
        return True

    def _define(self, of: InterfaceType, language: str, text: str, path: Path) -> None:
        if not language:
            return
        for each, definition in definitions_in(of, language, text).items():
            known = self.definitions.setdefault(each, definition)
            origin = self._origins.setdefault(each, path)
            if origin != path and known != definition:
                what = f"the definition of {each.short}"
                why = f"is not that of {origin}, which is taken"
                conflict = Missing(what, why, str(path))
                if conflict not in self.conflicts:
                    self.conflicts.append(conflict)


def _is_internal(name: str, of_type: str) -> bool:
    ending, kind = _OF_MANAGED_NODES
    return _EVERYWHERE.get(name) == of_type or (name.endswith(ending) and of_type == kind)


def _name_fault(name: str) -> str | None:
    if not name.startswith("/"):
        return "does not begin with '/'"
    return check_topic_name(name)


def _unusable(merged: _Merged, needed: Needed) -> Iterator[Missing]:
    """Yield the topics whose types cannot be used, or that have several."""
    for name, topic in sorted(merged.topics.items()):
        faults = [each for each in topic.types if each in needed.faults]
        for each in faults:
            why = f"is left out: {needed.faults[each]}, see --interfaces"
            yield Missing(f"topic {name} : {each.short}", why, str(topic.types[each]))
        if len(topic.types) > 1 and not faults:
            kinds = ", ".join(f"{each.short} in {path}" for each, path in topic.types.items())
            yield Missing(f"the type of topic {name}", f"is left out: it is {kinds}")


def _skewed(merged: _Merged, needed: Needed, request: Request) -> Iterator[Missing]:
    """Yield the types that have one definition here and another one in a recording."""
    for each, text in sorted(merged.definitions.items()):
        known = None if each in needed.texts else request.store.message(each)
        if known is not None and differs(each, text, known):
            why = "has other fields in the recordings than here, where checks look"
            yield Missing(f"message {each.short}", why)


# Lines ------------------------------------------------------------------------------------------


def _lines(merged: _Merged, needed: Needed) -> Iterator[str]:
    """Yield the declarations, sorted by name."""
    names = {
        name
        for name, topic in merged.topics.items()
        if not any(each in needed.faults for each in topic.types)
    }
    for name in sorted(names | merged.served.keys()):
        if name not in names:
            yield f"external topic {name}  // {merged.served[name]}"
            continue
        topic = merged.topics[name]
        pin = f" : {next(iter(topic.types)).short}" if len(topic.types) == 1 else ""
        offered = [qos_clause(each) for each in topic.offered]
        qos = offered[0] if len(offered) == 1 else ""
        rate, seen = _rate(topic)
        if len(offered) > 1:
            several = ";".join(each.removeprefix(" qos") or " default" for each in offered)
            seen.append(f"publishers with different QoS:{several}")
        yield f"external topic {name}{pin}{qos}{rate}  // {', '.join(seen)}"


_FEWEST_PERIODS = 10
"""Times between two messages from which on their average is a rate."""


def _rate(topic: _Topic) -> tuple[str, list[str]]:
    """Return how often messages come on average, if they do, and how many there are."""
    seen = [f"{topic.messages} message{'s' * (topic.messages != 1)}"]
    if not topic.periods or not topic.duration_ns:
        return "", seen
    rate = topic.periods * 1e9 / topic.duration_ns
    if topic.periods >= _FEWEST_PERIODS:
        return f" rate {_number(rate)} Hz", seen
    often = f"{_number(rate)} Hz" if rate >= 1 else f"one in {_number(1 / rate)} s"
    return "", [*seen, often]


def _number(value: float) -> str:
    """Return a number with three digits, or all of those before its point."""
    return f"{value:.0f}" if value >= 100 else f"{value:.3g}"
