"""QoS profiles of the models as rclcpp expressions."""

from __future__ import annotations

from deros.generators.text.cpp import Chain
from deros.models.common import QosProfile
from deros.models.qos import policies

_PRESETS = {
    "sensor_data": "rclcpp::SensorDataQoS()",
    "services": "rclcpp::ServicesQoS()",
    "parameters": "rclcpp::ParametersQoS()",
    "system_default": "rclcpp::SystemDefaultsQoS()",
}
_LIVELINESS = {"automatic": "Automatic", "manual_by_topic": "ManualByTopic"}


def qos_expression(profile: QosProfile | None) -> Chain | None:
    """Return the expression of ``profile``; ``None`` where the model states nothing."""
    if profile is None:
        return None
    stated = _stated(profile)
    if profile.preset is not None:
        return Chain(_PRESETS[profile.preset], (*_history(profile), *stated))
    if profile.keep_all:
        return Chain("rclcpp::QoS(rclcpp::KeepAll())", tuple(stated))
    depth = policies(profile).depth
    return Chain(f"rclcpp::QoS({depth})", tuple(stated))


def _history(profile: QosProfile) -> list[str]:
    if profile.keep_all:
        return [".keep_all()"]
    return [] if profile.depth is None else [f".keep_last({profile.depth})"]


def _stated(profile: QosProfile) -> list[str]:
    """Return what the model states beside preset and history, as calls in a chain."""
    calls: list[str] = []
    if profile.reliability is not None:
        calls.append(f".{profile.reliability}()")
    if profile.durability is not None:
        name = {"volatile": "durability_volatile"}.get(profile.durability, profile.durability)
        calls.append(f".{name}()")
    if profile.deadline_ns is not None:
        calls.append(f".deadline({_duration(profile.deadline_ns)})")
    if profile.lifespan_ns is not None:
        calls.append(f".lifespan({_duration(profile.lifespan_ns)})")
    if profile.liveliness is not None:
        kind = _LIVELINESS[profile.liveliness]
        calls.append(f".liveliness(rclcpp::LivelinessPolicy::{kind})")
    if profile.lease_ns is not None:
        calls.append(f".liveliness_lease_duration({_duration(profile.lease_ns)})")
    return calls


def _duration(nanoseconds: int) -> str:
    return f"rclcpp::Duration::from_nanoseconds({nanoseconds})"
