"""Messages of findings about QoS: the difference, its policy, and the smallest change."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from deros.diagnostics import Related
from deros.interfaces.durations import duration_text
from deros.models.common import QosProfile
from deros.models.qos import (
    DEFAULT,
    SYSTEM_DEFAULT,
    Policies,
    Policy,
    PolicyValue,
    Shortfall,
    policies,
    stated,
    words,
)
from deros.validators.wiring.graph import End
from deros.validators.wiring.rules_ends import RulesEnd
from deros.validators.wiring.system_safety import is_of_safety

_NAMED = 3
"""The number of ends of a side that are named; the others are counted."""

AnyEnd = End | RulesEnd


@dataclass(frozen=True, slots=True)
class Side:
    """Ends of one topic or service that have one profile.

    Attributes:
        noun: "publisher", "subscription", "client" or "server".
        profile: what their descriptions state.
        assumed: whether the profile is unknown, as a description of a program may state none.
    """

    noun: str
    profile: QosProfile | None
    assumed: bool
    ends: Sequence[AnyEnd]
    default: Policies = DEFAULT

    @property
    def policies(self) -> Policies:
        """All policies, by default those of ROS 2."""
        return policies(self.profile, self.default)

    @property
    def names(self) -> str:
        """Up to three ends by name, the number of the rest."""
        shown = [end.name for end in self.ends[:_NAMED]]
        more = len(self.ends) - len(shown)
        if more:
            shown.append(f"{more} more")
        return f"{', '.join(shown[:-1])} and {shown[-1]}" if len(shown) > 1 else shown[0]

    @property
    def is_fixed(self) -> bool:
        """Whether the generators give these ends their QoS."""
        return all(isinstance(end, RulesEnd) or is_of_safety(end.node) for end in self.ends)

    @property
    def is_program(self) -> bool:
        """Whether these are ends of programs that exist: only their authors change them."""
        return all(_is_program(end) for end in self.ends)

    @property
    def places(self) -> int:
        """The number of descriptions to be changed."""
        return len({(end.qos_span.file, end.qos_span.start) for end in self.ends})


def _is_program(end: AnyEnd) -> bool:
    node_type = end.node.type if isinstance(end, End) else None
    return node_type is not None and node_type.executable is not None


def difference(shortfall: Shortfall, offering: Side, requesting: Side) -> str:
    """Return the offer and the request in words: "the publisher offers a sample every 2 sec, …"."""
    policy, offer, request = shortfall.policy, shortfall.offered, shortfall.requested
    if policy in ("deadline", "lease"):
        noun = "sample" if policy == "deadline" else "liveliness assertion"
        asked = f"asks for {'one' if offer is not None else f'a {noun}'} every {_time(request)}"
        offered = (
            f"offers a {noun} every {_time(offer)}" if offer is not None else f"offers no {policy}"
        )
    else:
        offered = f"offers {_kind(policy, offer)}{_origin(offering, policy)}"
        asked = f"asks for {_kind(policy, request)}{_origin(requesting, policy)}"
    return f"the {offering.noun} {offered}, the {requesting.noun} {asked}"


def _time(value: PolicyValue) -> str:
    assert isinstance(value, int)
    return duration_text(value)


def _kind(policy: Policy, value: PolicyValue) -> str:
    if value == SYSTEM_DEFAULT:
        return f"a {policy} that depends on the middleware's settings"
    return words(policy, value)


def _origin(side: Side, policy: Policy) -> str:
    """Return the origin of a policy that the description does not state itself."""
    if stated(side.profile, policy) is not None:
        return ""
    preset = side.profile.preset if side.profile is not None else None
    return f" ({preset or 'the default'})"


def cure(found: Iterable[Shortfall], offering: Side, requesting: Side) -> str:
    """Return the smallest change that connects the two sides.

    Ends that are generated stay as they are, but what a safety node or a gate asks for may follow
    from what was offered when it was generated. Otherwise it is the side with fewer descriptions,
    preferably not of an existing program; if two are equal, both are named.
    """
    found = tuple(found)
    weaker = {each.policy: _least(each) for each in found}
    stronger = {each.policy: _most(each) for each in found}
    ways = [
        (side, f"let {_the(side)} {verb} {qos_words(target, side.policies)}")
        for side, verb, target in (
            (offering, "offer", stronger),
            (requesting, "ask for", weaker),
        )
        if not side.is_fixed
    ]
    again = ""
    if requesting.is_fixed and any(isinstance(end, End) for end in requesting.ends):
        again = "generate the safety node again if this is what its publisher offers"
    if not ways:
        return again or "generate both again"
    effort = {id(side): (side.is_program, side.places) for side, _ in ways}
    best = min(effort.values())
    chosen = [text for side, text in ways if effort[id(side)] == best]
    return ", or ".join([*chosen, *([again] if again else [])])


def _the(side: Side) -> str:
    return f"the {side.noun}" if len(side.ends) == 1 else f"the {len(side.ends)} {side.noun}s"


def _least(shortfall: Shortfall) -> PolicyValue:
    """Return the policies to request so that the offer is sufficient."""
    if shortfall.offered != SYSTEM_DEFAULT:
        return shortfall.offered
    return {"reliability": "best_effort", "durability": "volatile"}.get(
        shortfall.policy, "automatic"
    )


def _most(shortfall: Shortfall) -> PolicyValue:
    """Return the policies to offer so that they satisfy the request."""
    if shortfall.requested != SYSTEM_DEFAULT:
        return shortfall.requested
    return {"reliability": "reliable", "durability": "transient_local"}.get(
        shortfall.policy, "manual_by_topic"
    )


def qos_words(target: dict[Policy, PolicyValue], present: Policies) -> str:
    """Return in words how to change a profile: what to write, and what to remove."""
    written = []
    for policy, value in target.items():
        if policy == "lease" and value is not None:
            if "liveliness" not in target:  # a lease is written behind its kind
                written.append(words("liveliness", present.liveliness))
            written.append(words(policy, value))
        elif value is not None:
            written.append(words(policy, value))
    taken = [words(policy, value) for policy, value in target.items() if value is None]
    return " and ".join([*([f"'{' '.join(written)}'"] if written else []), *taken])


def places(side: Side, does: str) -> list[Related]:
    """Return where up to three ends of a side are connected, and where their QoS is given."""
    found: list[Related] = []
    for end in side.ends[:_NAMED]:
        found.append(Related(end.span, f"{end.name} is connected here"))
        if end.qos_span != end.span:
            found.append(Related(end.qos_span, does))
    return found
