"""QoS compatibility, compared with the deciding ROS 2 function for every pair of profiles."""

from __future__ import annotations

import dataclasses
import itertools

import pytest

from deros.models.common import QosProfile
from deros.models.qos import (
    DEFAULT,
    SYSTEM_DEFAULT,
    Policies,
    excess,
    is_met_by_default,
    overridden,
    overridden_policy,
    policies,
    publisher_violations,
    shortfalls,
    subscription_violations,
)
from tests.support.qos import profile

MS = 10**6
KINDS = {
    "reliability": ("best_effort", "reliable", SYSTEM_DEFAULT),
    "durability": ("volatile", "transient_local", SYSTEM_DEFAULT),
    "liveliness": ("automatic", "manual_by_topic", SYSTEM_DEFAULT),
}
TIMES = (None, 100 * MS, 200 * MS)


def _all_policies() -> list[Policies]:
    return [
        Policies(reliability, durability, deadline, liveliness, lease)
        for reliability, durability, liveliness in itertools.product(*KINDS.values())
        for deadline, lease in itertools.product(TIMES, TIMES)
    ]


def test_compatibility_of_every_pair_agrees_with_rclpy() -> None:
    """Errors and warnings of qos_check_compatible match certain and possible shortfalls."""
    qos = pytest.importorskip("rclpy.qos")
    every = [(policy, profile(policy)) for policy in _all_policies()]
    compared = 0
    for (offered, publisher), (requested, subscription) in itertools.product(every, every):
        verdict, reason = qos.qos_check_compatible(publisher, subscription)
        missing = shortfalls(offered, requested)
        expected = qos.QoSCompatibility.OK
        if any(each.certain for each in missing):
            expected = qos.QoSCompatibility.ERROR
        elif missing:
            expected = qos.QoSCompatibility.WARNING
        assert verdict == expected, (offered, requested, reason)
        compared += 1
    print(f"{compared} pairs of profiles compared with qos_check_compatible")


@pytest.mark.parametrize(
    ("profile", "name"),
    [
        (None, "default"),
        (QosProfile(preset="sensor_data"), "sensor_data"),
        (QosProfile(preset="services"), "services_default"),
        (QosProfile(preset="parameters"), "parameters"),
        (QosProfile(preset="system_default"), "system_default"),
    ],
)
def test_presets_match_ros(profile: QosProfile | None, name: str) -> None:
    """All policies are the same; an open liveliness is the DDS default."""
    qos = pytest.importorskip("rclpy.qos")
    preset = getattr(qos, f"qos_profile_{name}")
    own = policies(profile)
    liveliness = "automatic" if preset.liveliness.name == "SYSTEM_DEFAULT" else "?"
    assert (own.reliability, own.durability) == (
        preset.reliability.name.lower(),
        preset.durability.name.lower(),
    )
    assert own.liveliness in (liveliness, SYSTEM_DEFAULT)
    assert (own.deadline or 0, own.lease or 0, own.lifespan or 0) == (
        preset.deadline.nanoseconds,
        preset.liveliness_lease_duration.nanoseconds,
        preset.lifespan.nanoseconds,
    )
    if preset.history.name == "KEEP_LAST":
        assert own.depth == preset.depth


def test_stated_policies_override_the_preset() -> None:
    """The other policies stay those of the preset."""
    own = policies(QosProfile(preset="sensor_data", reliability="reliable", deadline_ns=5))
    assert own == Policies(depth=5, deadline=5)


PINS = [
    # declared QoS, profile of the ends: violations of publisher and subscription
    (QosProfile(reliability="reliable"), None, ("", "")),
    (QosProfile(reliability="best_effort"), None, ("", "more")),
    (QosProfile(reliability="reliable"), QosProfile(reliability="best_effort"), ("less", "less")),
    (QosProfile(durability="transient_local"), None, ("less", "less")),
    (QosProfile(durability="volatile"), QosProfile(durability="transient_local"), ("", "more")),
    (QosProfile(deadline_ns=100), None, ("less", "less")),
    (QosProfile(deadline_ns=100), QosProfile(deadline_ns=50), ("", "more")),
    (QosProfile(deadline_ns=100), QosProfile(deadline_ns=100), ("", "")),
    (QosProfile(deadline_ns=100), QosProfile(deadline_ns=200), ("less", "less")),
    (QosProfile(lease_ns=100), QosProfile(lease_ns=200), ("less", "less")),
    (QosProfile(lease_ns=100), QosProfile(lease_ns=50), ("", "more")),
    (QosProfile(liveliness="manual_by_topic"), None, ("less", "less")),
    (QosProfile(liveliness="automatic"), QosProfile(liveliness="manual_by_topic"), ("", "more")),
    (QosProfile(depth=10), None, ("", "")),
    (QosProfile(depth=11), None, ("less", "less")),
    (QosProfile(depth=11), QosProfile(keep_all=True), ("", "")),
    (QosProfile(keep_all=True), QosProfile(depth=1000), ("less", "less")),
    (QosProfile(lifespan_ns=100), None, ("less", "")),
    (QosProfile(lifespan_ns=100), QosProfile(lifespan_ns=101), ("less", "")),
    (QosProfile(lifespan_ns=100), QosProfile(lifespan_ns=99), ("", "")),
    (QosProfile(preset="sensor_data"), QosProfile(preset="sensor_data"), ("", "")),
    (QosProfile(preset="sensor_data"), None, ("", "more")),
    (QosProfile(preset="system_default", depth=3), None, ("", "")),
]


def test_violations_of_pinned_qos_are_found() -> None:
    """A publisher must offer at least the pinned QoS, a subscription request exactly that."""
    for pin, ends, wrong in PINS:
        case = (pin, ends)
        published = publisher_violations(*case)
        subscribed = subscription_violations(*case)
        assert wrong == tuple(
            "".join("more" if violation.excess else "less" for violation in violations)
            for violations in (published, subscribed)
        ), case
        assert all(each.certain for each in (*published, *subscribed)), case
        assert [each for each in subscribed if each.excess] == list(excess(*case)), case


def test_open_policy_is_not_a_certain_violation() -> None:
    """The middleware chooses its value."""
    open_profile = QosProfile(preset="system_default")
    for pin in (QosProfile(reliability="reliable"), QosProfile(depth=3)):
        assert [violation.certain for violation in publisher_violations(pin, open_profile)] == [
            False
        ]
    (found,) = subscription_violations(QosProfile(reliability="best_effort"), open_profile)
    assert (found.excess, found.certain) == (True, False)


@pytest.mark.parametrize(
    ("parameter", "policy"),
    [
        ("qos_overrides./scan.subscription.reliability", "reliability"),
        ("qos_overrides./scan.subscription_left.depth", "depth"),
        ("qos_overrides./scan.publisher.reliability", None),
        ("qos_overrides./scan_2.subscription.reliability", None),
        ("scan.subscription.reliability", None),
    ],
)
def test_override_parameters_are_recognised_by_name(parameter: str, policy: str | None) -> None:
    """The name has topic, kind of end, an optional identifier and policy."""
    assert overridden_policy(parameter, "/scan", "subscription") == policy


def test_overrides_take_precedence() -> None:
    """A policy that is chosen at run time is unknown; a time of 0 is no time."""
    stated = QosProfile(preset="sensor_data", deadline_ns=5)
    own = policies(
        overridden(
            stated,
            {"reliability": "reliable", "durability": "best_available", "deadline": 0, "depth": 2},
        )
    )
    assert own == Policies("reliable", SYSTEM_DEFAULT, depth=2)
    assert policies(overridden(None, {"history": "keep_all"})).depth == float("inf")


MIDDLEWARES = {
    # policies that system_default becomes for a publisher and for a subscription
    "rmw_fastrtps": {
        "reliability": ("reliable", "best_effort"),
        "durability": ("transient_local", "volatile"),
        "liveliness": ("automatic", "automatic"),
    },
    "rmw_cyclonedds": {
        "reliability": ("reliable", "reliable"),
        "durability": ("volatile", "volatile"),
        "liveliness": ("automatic", "automatic"),
    },
    "OMG DDS": {
        "reliability": ("reliable", "best_effort"),
        "durability": ("volatile", "volatile"),
        "liveliness": ("automatic", "automatic"),
    },
}


def _as_in(middleware: str, each: Policies, end: int) -> Policies:
    """Return a profile with the middleware's choice for its open policies."""
    replacements = {
        policy: kinds[end]
        for policy, kinds in MIDDLEWARES[middleware].items()
        if getattr(each, policy) == SYSTEM_DEFAULT
    }
    return dataclasses.replace(each, **replacements)  # type: ignore[arg-type]


def test_met_by_default_agrees_with_every_middleware() -> None:
    """Pairs left unreported connect in all of them; reported pairs fail in at least one."""
    every = [
        policy for policy in _all_policies() if (policy.deadline, policy.lease) == (None, None)
    ]
    for offered, requested in itertools.product(every, every):
        missing = shortfalls(offered, requested)
        reported = [each for each in missing if not is_met_by_default(each)]
        apart = [
            bool(shortfalls(_as_in(name, offered, 0), _as_in(name, requested, 1)))
            for name in MIDDLEWARES
        ]
        assert bool(reported) == any(apart), (offered, requested)


def test_default_ends_match() -> None:
    """Two ends without stated QoS are compatible."""
    assert shortfalls(DEFAULT, DEFAULT) == ()
