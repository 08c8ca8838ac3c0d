"""QoS policies of a profile, and the compatibility of publishers and subscriptions.

Each policy follows the request-offered rule of DDS (OMG DDS 1.4, section 2.2.3): a publisher
*offers*, a subscription *requests*, and the two are connected only if no policy offers less than is
requested. Sources: ``rmw/qos_profiles.h`` for the profiles, ``rmw_dds_common/src/qos.cpp`` for the
rules, and for values that are known only at run time.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Literal

from deros.interfaces.durations import duration_text
from deros.models.common import QosProfile, Value

Policy = Literal[
    "reliability", "durability", "deadline", "liveliness", "lease", "depth", "lifespan"
]
PolicyValue = str | float | None
"""A kind, nanoseconds or a number of samples; ``None`` is no offer, or no request."""

SYSTEM_DEFAULT = "system_default"
"""The kind of a policy that the middleware chooses by its own settings."""

_KINDS = {
    "reliability": ("best_effort", "reliable"),
    "durability": ("volatile", "transient_local"),
    "liveliness": ("automatic", "manual_by_topic"),
}
"""The kinds of each policy, the weakest first."""


@dataclass(frozen=True, slots=True)
class Policies:
    """The policies of an end; deadline and lease are nanoseconds.

    Where a profile of ROS 2 leaves the kind of liveliness open, it is what DDS starts from.
    """

    reliability: str = "reliable"
    durability: str = "volatile"
    deadline: int | None = None
    liveliness: str = "automatic"
    lease: int | None = None
    depth: float | None = 10  # inf for keep_all, None for what the middleware chooses
    lifespan: int | None = None


DEFAULT = Policies()
"""The default profile of ROS 2, for topics and, as far as connections go, for services."""

ACTION_STATUS = Policies(durability="transient_local", depth=1)
"""The profile of an action's status topic (``rcl_action_qos_profile_status_default``)."""

_PRESETS = {
    "sensor_data": Policies(reliability="best_effort", depth=5),
    "services": DEFAULT,
    "parameters": Policies(depth=1000),
    "system_default": Policies(
        SYSTEM_DEFAULT, SYSTEM_DEFAULT, liveliness=SYSTEM_DEFAULT, depth=None
    ),
}
_FIELDS: dict[Policy, str] = {
    "reliability": "reliability",
    "durability": "durability",
    "deadline": "deadline_ns",
    "liveliness": "liveliness",
    "lease": "lease_ns",
    "depth": "depth",
    "lifespan": "lifespan_ns",
}
"""The field of a profile that states each policy."""

REQUEST_OFFERED: tuple[Policy, ...] = (
    "reliability",
    "durability",
    "deadline",
    "liveliness",
    "lease",
)
"""The policies on which a connection depends."""


@dataclass(frozen=True, slots=True)
class Shortfall:
    """A policy of which less is offered than requested.

    ``certain`` is false where the middleware's own settings decide whether it is less.
    """

    policy: Policy
    offered: PolicyValue
    requested: PolicyValue
    certain: bool = True


@dataclass(frozen=True, slots=True)
class PinViolation:
    """A policy in which an end does not meet the pin of its topic.

    ``excess`` means that a subscription requests more than is pinned; otherwise it is less.
    """

    policy: Policy
    actual: PolicyValue
    pinned: PolicyValue
    excess: bool = False
    certain: bool = True


def stated(profile: QosProfile | None, policy: Policy) -> PolicyValue:
    """Return the value that a profile itself states for a policy, or ``None``."""
    if profile is None:
        return None
    if policy == "depth" and profile.keep_all:
        return math.inf
    value: PolicyValue = getattr(profile, _FIELDS[policy])
    return value


@lru_cache(maxsize=4096)
def policies(profile: QosProfile | None, default: Policies = DEFAULT) -> Policies:
    """Return all policies of an end: those stated, else the preset's, else those of ``default``."""
    if profile is None:
        return default
    start = default if profile.preset is None else _PRESETS[profile.preset]
    own: dict[str, Any] = {
        policy: value for policy in _FIELDS if (value := stated(profile, policy)) is not None
    }
    return dataclasses.replace(start, **own)


@lru_cache(maxsize=4096)
def shortfalls(offered: Policies, requested: Policies) -> tuple[Shortfall, ...]:
    """Return the policies that disconnect a publisher and a subscription, or may do so."""
    return tuple(
        Shortfall(policy, offer, request, verdict is True)
        for policy in REQUEST_OFFERED
        if (
            verdict := _is_less(
                policy, offer := getattr(offered, policy), request := getattr(requested, policy)
            )
        )
        is not False
    )


def _is_less(policy: Policy, offer: Any, request: Any) -> bool | None:
    """Return whether less is offered than requested; ``None`` if the middleware decides that."""
    if policy in _KINDS:
        least, most = _KINDS[policy]
        if offer == most or request == least:
            return False
        return None if SYSTEM_DEFAULT in (offer, request) else True
    if request is None:
        return False
    if policy == "depth":
        return None if offer is None else bool(offer < request)
    return offer is None or bool(offer > request)


def is_met_by_default(shortfall: Shortfall) -> bool:
    """Return whether ``system_default`` satisfies the request in every middleware of ROS 2.

    Only a profile file of the user's could make it less. A publisher is reliable, a subscription is
    volatile and asks for automatic liveliness; whether a subscription is best effort, and whether a
    publisher is transient local, differs. Sources: ``rmw_node.cpp`` of rmw_cyclonedds, ``qos.cpp``
    of rmw_fastrtps with ``DataWriterQos.cpp`` of Fast DDS, OMG DDS 1.4, section 2.2.3.
    """
    if shortfall.policy == "reliability":
        return shortfall.offered == SYSTEM_DEFAULT
    if shortfall.policy in ("durability", "liveliness"):
        return shortfall.requested == SYSTEM_DEFAULT
    return False


@lru_cache(maxsize=4096)
def pinned_policies(pin: QosProfile) -> Mapping[Policy, PolicyValue]:
    """Return the policies that a topic's QoS pins: those stated, and the kinds of its preset.

    A value that the middleware chooses is not pinned, and the depth of a preset is only usual.
    """
    found = {policy: value for policy in _FIELDS if (value := stated(pin, policy)) is not None}
    if pin.preset is not None:
        preset = _PRESETS[pin.preset]
        for policy in ("reliability", "durability"):
            if getattr(preset, policy) != SYSTEM_DEFAULT:
                found.setdefault(policy, getattr(preset, policy))
    return found


@lru_cache(maxsize=4096)
def publisher_violations(pin: QosProfile, profile: QosProfile | None) -> tuple[PinViolation, ...]:
    """Return the policies in which a publisher offers less than the pin; more is allowed."""
    actual = policies(profile)
    return tuple(_below(pin, actual, tuple(_FIELDS)))


@lru_cache(maxsize=4096)
def subscription_violations(
    pin: QosProfile, profile: QosProfile | None
) -> tuple[PinViolation, ...]:
    """Return the policies in which a subscription requests anything but the pin.

    With more, it would not be connected with a publisher that offers just what is pinned; with
    less, it would miss what the pin promises. A lifespan counts where a sample is published.
    """
    actual = policies(profile)
    own = tuple(policy for policy in _FIELDS if policy != "lifespan")
    return (*excess(pin, profile), *_below(pin, actual, own))


@lru_cache(maxsize=4096)
def excess(pin: QosProfile, profile: QosProfile | None) -> tuple[PinViolation, ...]:
    """Return the policies in which a subscription requests more than the pin."""
    actual = policies(profile)
    found = []
    for policy, value in pinned_policies(pin).items():
        if policy in REQUEST_OFFERED:
            asked = getattr(actual, policy)
            verdict = _is_less(policy, value, asked)
            if verdict is not False:
                found.append(PinViolation(policy, asked, value, True, verdict is True))
    return tuple(found)


def _below(pin: QosProfile, actual: Policies, among: tuple[Policy, ...]) -> Iterator[PinViolation]:
    for policy, value in pinned_policies(pin).items():
        if policy in among:
            offer = getattr(actual, policy)
            verdict = _is_less(policy, offer, value)
            if verdict is not False:
                yield PinViolation(policy, offer, value, False, verdict is True)


# Overrides --------------------------------------------------------------------------------------

OVERRIDES = "qos_overrides."
"""The prefix of the parameters by which ROS 2 overrides the QoS of a program's ends at startup.

They read ``qos_overrides./scan.subscription.reliability``, or ``subscription_NAME`` of several.
"""

USUAL_OVERRIDES: Mapping[str, Value] = {
    f"{OVERRIDES}{end}.{policy}": value
    for end, depth, reliability in (
        ("/parameter_events.publisher", 1000, "reliable"),
        ("/clock.subscription", 1, "best_effort"),
    )
    for policy, value in (
        ("depth", depth),
        ("durability", "volatile"),
        ("history", "keep_last"),
        ("reliability", reliability),
    )
}
"""Those that every node of rclcpp has, of its parameter events and of simulated time, by name.

The values are those that it has where nothing is overridden.
"""

_OVERRIDE_FIELDS = {
    "reliability": "reliability",
    "durability": "durability",
    "liveliness": "liveliness",
    "depth": "depth",
    "deadline": "deadline_ns",
    "lifespan": "lifespan_ns",
    "liveliness_lease_duration": "lease_ns",
}


def overridden_policy(parameter: str, topic: str, entity: str) -> str | None:
    """Return the ROS 2 name of the policy that a parameter overrides, or ``None``.

    Args:
        parameter: the parameter's name.
        topic: the graph name of the end's topic.
        entity: ``publisher`` or ``subscription``.
    """
    head, _, policy = parameter.rpartition(".")
    start = f"{OVERRIDES}{topic}.{entity}"
    return policy if head == start or head.startswith(f"{start}_") else None


def overridden(profile: QosProfile | None, overrides: Mapping[str, Value]) -> QosProfile:
    """Return a profile with other values for some policies, given by their names in ROS 2.

    A kind that no profile can state, such as ``best_available``, is known at run time only.
    """
    changes: dict[str, Any] = {}
    for policy, value in overrides.items():
        if policy in _KINDS:
            known = value in _KINDS[policy]
            changes[policy] = value if known else SYSTEM_DEFAULT
        elif policy == "history":
            changes["keep_all"] = value == "keep_all"
        elif policy in _OVERRIDE_FIELDS and type(value) is int:
            changes[_OVERRIDE_FIELDS[policy]] = value or None
    return dataclasses.replace(profile or QosProfile(), **changes)


# Words ------------------------------------------------------------------------------------------


def words(policy: Policy, value: PolicyValue) -> str:
    """Return the QoS words that state the value of a policy, as ``deadline 100 ms``."""
    if policy == "depth":
        return "keep_all" if value == math.inf else f"depth {value}"
    if policy in _KINDS:
        return f"liveliness {value}" if policy == "liveliness" else str(value)
    if value is None:
        return f"no {policy}"
    assert isinstance(value, int)
    return f"{policy} {duration_text(value)}"
