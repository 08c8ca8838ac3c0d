"""What a safety node and a gate ask for: nothing that some publisher might not offer."""

from __future__ import annotations

import pytest

from deros.metamodels.common import QosProfile
from deros.metamodels.qos import excess, policies, shortfalls
from deros.metamodels.safety_qos import (
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
    # Somebody whom the model does not show may publish, too.
    (Offers([LATCHED], is_open=True), "best_effort", "volatile"),
    # A pin holds for everybody.
    (Offers([LATCHED], pin=RELIABLE, is_open=True), "reliable", "volatile"),
    (Offers([], pin=LATCHED, is_open=True), "reliable", "transient_local"),
    (Offers([RELIABLE], pin=SENSOR), "best_effort", "volatile"),
    (Offers([LATCHED], pin=QosProfile(depth=5)), "reliable", "transient_local"),
    (Offers([DEADLINE], pin=DEADLINE), "reliable", "volatile"),
]


@pytest.mark.parametrize(("offers", "reliability", "durability"), OFFERS)
def test_inputs(offers: Offers, reliability: str, durability: str) -> None:
    """As reliable and as durable as every publisher is known to be, and nothing else."""
    asked = policies(input_qos(offers))
    assert (asked.reliability, asked.durability) == (reliability, durability)
    assert (asked.deadline, asked.lease, asked.liveliness) == (None, None, "automatic")
    assert asked.depth == max([10, *(each.depth or 0 for each in offers.stated if each)])
    for profile in offers.stated if not offers.pin else ():
        assert shortfalls(policies(profile), asked) == ()
    assert offers.pin is None or excess(offers.pin, input_qos(offers)) == ()


@pytest.mark.parametrize(("offers", "reliability", "_"), OFFERS)
def test_commands(offers: Offers, reliability: str, _: str) -> None:
    """No old command is replayed to a gate that starts."""
    asked = policies(gate_source_qos(offers))
    assert (asked.reliability, asked.durability) == (reliability, "volatile")


def test_safety_nodes_and_gates_match() -> None:
    """What the one offers is what the other asks for."""
    assert shortfalls(policies(STATE), policies(STATE)) == ()
    assert shortfalls(policies(HEARTBEAT), policies(GATE_HEARTBEAT)) == ()
