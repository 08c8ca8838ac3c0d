"""Aspects of the QoS of ends: what a publisher offers, and a subscription requests."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import Any, TypeVar

from deros.diff.changes import Aspect, Verdict
from deros.models.qos import REQUEST_OFFERED, Policies, Policy, shortfalls, words

End = TypeVar("End")

ALL_POLICIES: tuple[Policy, ...] = (*REQUEST_OFFERED, "depth", "lifespan")
"""The policies on which a connection depends, and the others."""


def offers_less(policy: Policy) -> Verdict:
    """Return the verdict for the policy of a publisher: one that offers less breaks subscribers."""
    return _verdict(policy, "subscribers that request {old} are not connected any more", True)


def asks_for_more(policy: Policy) -> Verdict:
    """Return the verdict for the policy of a subscription: more breaks those who publish for it."""
    return _verdict(policy, "publishers that offer only {old} are not connected any more", False)


def either_way(policy: Policy) -> Verdict:
    """Return the verdict for an end that both publishes and subscribes, such as a service."""
    less = _verdict(policy, "clients and servers with {old} may not be connected any more", True)
    more = _verdict(policy, "clients and servers with {old} may not be connected any more", False)
    return lambda old, new: less(old, new) or more(old, new)


def _verdict(policy: Policy, why: str, publishes: bool) -> Verdict:
    def breaks(old: Any, new: Any) -> str:
        if policy not in REQUEST_OFFERED:
            return ""
        before = dataclasses.replace(Policies(), **{policy: old})
        after = dataclasses.replace(Policies(), **{policy: new})
        found = shortfalls(after, before) if publishes else shortfalls(before, after)
        lost = any(each.policy == policy for each in found)
        return why.format(old=words(policy, old)) if lost else ""

    return breaks


def qos_aspects(
    read: Callable[[End], Policies | None],
    verdict: Callable[[Policy], Verdict],
    prefix: str = "QoS",
) -> tuple[Aspect[End], ...]:
    """Return one aspect for each policy of an end; without policies, the end has none."""

    def aspect(policy: Policy) -> Aspect[End]:
        def value(end: End) -> Any:
            found = read(end)
            return None if found is None else (getattr(found, policy),)

        decide = verdict(policy)
        return Aspect(
            f"{prefix} {policy}",
            value,
            lambda old, new: "" if None in (old, new) else decide(old[0], new[0]),
            lambda value: words(policy, value[0]),
        )

    return tuple(map(aspect, ALL_POLICIES))
