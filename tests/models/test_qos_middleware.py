"""QoS compatibility: compared with the middleware itself, for every pair of profiles.

All policies on which a connection depends are combined: both kinds of reliability, durability and
liveliness; deadline and lease as none, one second and two, so that the offer is none, shorter,
equal and longer than the request. That gives 72 profiles for each end, and all their pairs.
``system_default`` is not among them, because each middleware chooses its value. A separate test
checks that pairs for which its defaults suffice are connected.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from typing import Any

import pytest

from deros.models.qos import SYSTEM_DEFAULT, Policies, is_met_by_default, shortfalls
from tests.support.qos import profile
from tests.support.ros import LIMIT, Peer

pytestmark = pytest.mark.ros

SECOND = 10**9
TIMES = (None, SECOND, 2 * SECOND)
PROFILES = [
    Policies(reliability, durability, deadline, liveliness, lease)
    for reliability, durability, deadline, liveliness, lease in itertools.product(
        ("best_effort", "reliable"),
        ("volatile", "transient_local"),
        TIMES,
        ("automatic", "manual_by_topic"),
        TIMES,
    )
]


@pytest.fixture
def other_peer(ros_peer: Peer, ros_env: dict[str, str]) -> Iterator[Peer]:
    """Return a second participant, which the first one has to discover."""
    del ros_peer  # this process is already confined to the loopback interface
    peer = Peer(int(ros_env["ROS_DOMAIN_ID"]), "other_peer")
    yield peer
    peer.close()


class Asking:
    """The subscriptions of one topic, each with its own profile, and their events."""

    def __init__(self, peer: Peer, topic: str, profiles: Sequence[Policies] = PROFILES) -> None:
        from rclpy.event_handler import SubscriptionEventCallbacks
        from std_msgs.msg import Empty

        self._peer = peer
        self.matched = [0] * len(profiles)
        self.refused = [0] * len(profiles)

        def note(index: int) -> Any:
            def matched(event: Any) -> None:
                self.matched[index] = event.total_count

            def refused(event: Any) -> None:
                self.refused[index] = event.total_count

            return SubscriptionEventCallbacks(
                matched=matched, incompatible_qos=refused, use_default_callbacks=False
            )

        self._subscriptions = [
            peer.node.create_subscription(
                Empty, topic, lambda _: None, profile(each), event_callbacks=note(index)
            )
            for index, each in enumerate(profiles)
        ]

    def verdicts(self) -> list[bool]:
        """Return whether the publisher of the topic is connected to each subscription."""
        self._peer.until(lambda: all(map(int.__add__, self.matched, self.refused)), limit=2 * LIMIT)
        assert {*map(int.__add__, self.matched, self.refused)} == {1}
        return [bool(matched) for matched in self.matched]

    def close(self) -> None:
        """Destroy the subscriptions."""
        for subscription in self._subscriptions:
            self._peer.node.destroy_subscription(subscription)


@pytest.mark.slow
def test_compatibility_of_every_pair_agrees_with_the_middleware(
    ros_peer: Peer, other_peer: Peer
) -> None:
    """Each subscription gets either a matched or an incompatible QoS event."""
    from std_msgs.msg import Empty

    compared = 0
    for number, offered in enumerate(PROFILES):
        topic = f"pair_{number}"
        publisher = other_peer.node.create_publisher(Empty, topic, profile(offered))
        asking = Asking(ros_peer, topic)
        expected = [not shortfalls(offered, requested) for requested in PROFILES]
        assert asking.verdicts() == expected, offered
        compared += len(expected)
        asking.close()
        other_peer.node.destroy_publisher(publisher)
    print(f"{compared} pairs of profiles compared with the middleware")
    assert compared == len(PROFILES) ** 2 == 5184


OPEN_PROFILES = [
    Policies(reliability, durability, None, liveliness, None)
    for reliability, durability, liveliness in itertools.product(
        ("best_effort", "reliable", SYSTEM_DEFAULT),
        ("volatile", "transient_local", SYSTEM_DEFAULT),
        ("automatic", "manual_by_topic", SYSTEM_DEFAULT),
    )
]


def test_pairs_met_by_default_are_connected(ros_peer: Peer, other_peer: Peer) -> None:
    """A pair that is not reported is connected, whatever ``system_default`` has become."""
    from std_msgs.msg import Empty

    compared = 0
    for number, offered in enumerate(OPEN_PROFILES):
        topic = f"open_{number}"
        publisher = other_peer.node.create_publisher(Empty, topic, profile(offered))
        asking = Asking(ros_peer, topic, OPEN_PROFILES)
        for requested, is_connected in zip(OPEN_PROFILES, asking.verdicts(), strict=True):
            if all(map(is_met_by_default, shortfalls(offered, requested))):
                assert is_connected, (offered, requested)
                compared += 1
        asking.close()
        other_peer.node.destroy_publisher(publisher)
    print(f"{compared} pairs with open kinds are connected")


SERVICES = [
    Policies(reliability, durability, deadline, "automatic", lease)
    for reliability, durability, deadline, lease in itertools.product(
        ("best_effort", "reliable"), ("volatile", "transient_local"), TIMES[:2], TIMES[:2]
    )
]


def test_clients_and_servers_must_match_in_both_directions(
    ros_peer: Peer, other_peer: Peer
) -> None:
    """A client finds its server if the offers of each meet the requests of the other."""
    compared = 0
    for number, served in enumerate(SERVICES):
        expected = [
            not shortfalls(served, service) and not shortfalls(service, served)
            for service in SERVICES
        ]
        connected = clients_of(ros_peer, other_peer, f"pair_{number}", served, sum(expected))
        assert connected == expected, served
        compared += len(connected)
    print(f"{compared} pairs of services compared with the middleware")


def clients_of(peer: Peer, other_peer: Peer, name: str, served: Policies, ready: int) -> list[bool]:
    """Return whether clients of every profile find a server; some are expected to be ready."""
    from std_srvs.srv import Trigger

    def answer(_: Any, response: Any) -> Any:
        return response

    def create_client(each: Policies) -> Any:
        return peer.node.create_client(Trigger, name, qos_profile=profile(each))

    clients = [create_client(service) for service in SERVICES]
    server = other_peer.node.create_service(Trigger, name, answer, qos_profile=profile(served))
    # A last client with the profile of the server shows when the server has been discovered: the
    # older clients have been matched by then, or never will be.
    clients.append(create_client(served))
    peer.until(clients[-1].service_is_ready)
    other_peer.until(lambda: other_peer.node.count_clients(name) == len(clients))
    peer.until(lambda: sum(each.service_is_ready() for each in clients[:-1]) >= ready)
    found = [each.service_is_ready() for each in clients[:-1]]
    for client in clients:
        peer.node.destroy_client(client)
    other_peer.node.destroy_service(server)
    return found
