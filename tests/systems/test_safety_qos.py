"""The QoS that safety nodes and gates request: nothing that a publisher might not offer."""

from __future__ import annotations

import pytest

from deros.models.common import QosProfile
from deros.models.qos import excess, policies, shortfalls
from deros.systems.safety_qos import (
    GATE_HEARTBEAT,
    HEARTBEAT,
    STATE,
    Offers,
    gate_source_qos,
    input_qos,
)

RELIABLE = QosProfile(reliability="reliable")
LATCHED = QosProfile(reliability="reliable", durability="transient_local", depth=30)
SENSOR = QosProfile(preset="sensor_data")
DEADLINE = QosProfile(reliability="reliable", deadline_ns=10**8)

OFFERS = [
    (Offers([RELIABLE, LATCHED]), "reliable", "volatile"),
    (Offers([LATCHED]), "reliable", "transient_local"),
    (Offers([RELIABLE, SENSOR]), "best_effort", "volatile"),
    (Offers([RELIABLE, None]), "best_effort", "volatile"),
    (Offers([]), "best_effort", "volatile"),
    # An unknown publisher may exist as well.
    (Offers([LATCHED], is_open=True), "best_effort", "volatile"),
    # Declared QoS applies to every publisher.
    (Offers([LATCHED], pin=RELIABLE, is_open=True), "reliable", "volatile"),
    (Offers([], pin=LATCHED, is_open=True), "reliable", "transient_local"),
    (Offers([RELIABLE], pin=SENSOR), "best_effort", "volatile"),
    (Offers([LATCHED], pin=QosProfile(depth=5)), "reliable", "transient_local"),
    (Offers([DEADLINE], pin=DEADLINE), "reliable", "volatile"),
]


@pytest.mark.parametrize(("offers", "reliability", "durability"), OFFERS)
def test_input_qos_matches_all_known_publishers(
    offers: Offers, reliability: str, durability: str
) -> None:
    """As reliable and durable as every known publisher, without other requirements."""
    asked = policies(input_qos(offers))
    assert (asked.reliability, asked.durability) == (reliability, durability)
    assert (asked.deadline, asked.lease, asked.liveliness) == (None, None, "automatic")
    assert asked.depth == max([10, *(each.depth or 0 for each in offers.stated if each)])
    for profile in offers.stated if not offers.pin else ():
        assert shortfalls(policies(profile), asked) == ()
    assert offers.pin is None or excess(offers.pin, input_qos(offers)) == ()


@pytest.mark.parametrize(("offers", "reliability", "_"), OFFERS)
def test_gate_source_is_volatile(offers: Offers, reliability: str, _: str) -> None:
    """No old command is replayed to a gate that starts."""
    asked = policies(gate_source_qos(offers))
    assert (asked.reliability, asked.durability) == (reliability, "volatile")


def test_safety_node_and_gate_qos_match() -> None:
    """The offered QoS meets the requested QoS."""
    assert shortfalls(policies(STATE), policies(STATE)) == ()
    assert shortfalls(policies(HEARTBEAT), policies(GATE_HEARTBEAT)) == ()
