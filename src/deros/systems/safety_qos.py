"""The QoS of every port of a safety node and of a gate.

This is its only definition: the generators give it to the nodes, and the checks compare it with the
rest of a system.

A subscription of the safety node or of a gate requests nothing that some publisher of its topic
might not offer, so that it matches every publisher: it is as reliable, and as durable, as the topic
is pinned to be, or as all of its publishers are stated to be. Silence is noticed by the timeouts of
the rules and the ``lost`` lines of the gates, not by deadlines of the middleware.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from deros.models.common import QosProfile
from deros.models.qos import Policy, pinned_policies, policies

STATE = QosProfile(reliability="reliable", durability="transient_local", depth=1)
"""States of actions: published by the safety node, subscribed by gates and drives."""

HEARTBEAT = QosProfile(reliability="reliable", depth=1)
EVENTS = QosProfile(reliability="reliable", durability="transient_local", depth=1000)
DIAGNOSTICS = QosProfile(reliability="reliable", depth=10)

GATE_HEARTBEAT = QosProfile(reliability="reliable", depth=10)
"""The QoS of a gate's subscription to the heartbeat."""

GATE_TARGET = QosProfile(reliability="reliable", depth=10)
"""The QoS of the commands that a gate publishes."""

_INPUT_DEPTH = 10


@dataclass(frozen=True, slots=True)
class Offers:
    """The known QoS of the publishers of a topic.

    Attributes:
        stated: the QoS that the description of each of them states.
        pin: the QoS that the topic is declared with.
        is_open: whether others may publish whom the model does not show.
    """

    stated: Sequence[QosProfile | None] = ()
    pin: QosProfile | None = None
    is_open: bool = False

    @property
    def are_reliable(self) -> bool:
        """Whether every publisher is reliable; an unstated default does not count."""
        kinds = [
            None if _says_nothing(each) else policies(each).reliability for each in self.stated
        ]
        return self._all("reliability", "reliable", kinds)

    @property
    def are_durable(self) -> bool:
        """Whether every publisher keeps samples for late subscriptions."""
        kinds = [policies(each).durability for each in self.stated]
        return self._all("durability", "transient_local", kinds)

    def _all(self, policy: Policy, kind: str, offered: Sequence[str | None]) -> bool:
        pinned = pinned_policies(self.pin).get(policy) if self.pin is not None else None
        if isinstance(pinned, str):
            return pinned == kind
        return not self.is_open and bool(offered) and all(each == kind for each in offered)


def _says_nothing(profile: QosProfile | None) -> bool:
    return profile is None or (profile.reliability is None and profile.preset is None)


def input_qos(offers: Offers) -> QosProfile:
    """Return the QoS of the safety node's subscription of a topic that the rules read."""
    depths = [each.depth or 0 for each in offers.stated if each is not None]
    return QosProfile(
        reliability="reliable" if offers.are_reliable else "best_effort",
        durability="transient_local" if offers.are_durable else None,
        depth=max([_INPUT_DEPTH, *depths]),
    )


def gate_source_qos(offers: Offers) -> QosProfile:
    """Return the QoS of a gate's subscription of commands: an old command is never replayed."""
    return QosProfile(reliability="reliable" if offers.are_reliable else "best_effort", depth=10)
