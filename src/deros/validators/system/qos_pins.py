"""Checks of ends against the QoS that a declared topic pins."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from deros import codes
from deros.diagnostics import Diagnostic, Related, report
from deros.models.common import QosProfile
from deros.models.qos import (
    PinViolation,
    Policy,
    PolicyValue,
    excess,
    policies,
    publisher_violations,
    subscription_violations,
    words,
)
from deros.systems.flat import FlatTopic
from deros.validators.system.qos_messages import AnyEnd, qos_words
from deros.validators.wiring.rules_ends import RulesEnd
from deros.validators.wiring.system_safety import is_of_safety


def check_pin(
    pin: FlatTopic, sources: Iterable[AnyEnd], sinks: Iterable[AnyEnd]
) -> Iterator[Diagnostic]:
    """Yield each end that does not meet the QoS that its topic is declared with.

    A safety node and a gate may request less than is pinned, so that every publisher matches.
    """
    qos = pin.declaration.qos
    assert qos is not None
    for end in sources:
        yield from _violation(pin, qos, end, publisher_violations(qos, end.qos))
    for end in sinks:
        is_safe = isinstance(end, RulesEnd) or is_of_safety(end.node)
        compare = excess if is_safe else subscription_violations
        yield from _violation(pin, qos, end, compare(qos, end.qos))


def _violation(
    pin: FlatTopic, qos: QosProfile, end: AnyEnd, found: tuple[PinViolation, ...]
) -> Iterator[Diagnostic]:
    if not found:
        return
    is_sure = not end.is_assumed and any(each.certain for each in found)
    code = codes.PINNED_QOS_VIOLATED if is_sure else codes.UNCERTAIN_QOS
    pinned = " ".join(words(each.policy, each.pinned) for each in found)
    actual = " and ".join(_actual(each.policy, each.actual) for each in found)
    target = {each.policy: each.pinned for each in found}
    change = f"give the port {qos_words(target, policies(end.qos))}, or change the pin"
    if isinstance(end, RulesEnd) or is_of_safety(end.node):
        change = "its QoS is generated: change the pin"
    elif end.is_assumed:
        change = "its node description states no QoS: state it, or change the pin"
    yield report(
        code,
        f"'{pin.name}' is pinned to '{pinned}', but {end.name} has {actual}",
        end.span,
        change,
        (
            Related(qos.span or pin.declaration.name_span, "pinned here"),
            *((Related(end.qos_span, "its QoS"),) if end.qos_span != end.span else ()),
        ),
    )


def _actual(policy: Policy, value: PolicyValue) -> str:
    if value is None and policy == "depth":
        return "a depth that depends on the middleware's settings"
    if value == "system_default":
        return f"a {policy} that depends on the middleware's settings"
    return words(policy, value)
