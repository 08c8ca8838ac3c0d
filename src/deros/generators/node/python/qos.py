"""QoS profiles of the models as rclpy expressions."""

from __future__ import annotations

from dataclasses import dataclass

from deros.generators.text.python import Call
from deros.models.common import QosProfile
from deros.models.qos import DEFAULT, SYSTEM_DEFAULT, policies

_PRESETS = {
    "sensor_data": "qos_profile_sensor_data",
    "services": "qos_profile_services_default",
    "parameters": "qos_profile_parameters",
    "system_default": "qos_profile_system_default",
}


@dataclass(frozen=True, slots=True)
class QosView:
    """A profile as an expression, and the modules with the names that it needs."""

    expression: str | Call
    imports: tuple[tuple[str, str], ...]


def qos_view(profile: QosProfile | None) -> QosView | None:
    """Return the view of ``profile``; ``None`` where the model states nothing."""
    if profile is None:
        return None
    stated = _stated(profile)
    if profile.preset is not None and not stated:
        name = _PRESETS[profile.preset]
        return QosView(name, (("rclpy.qos", name),))
    arguments = {} if profile.preset is None else _of_preset(profile.preset)
    if "depth" in stated or "history" in stated:
        arguments.pop("history", None)
        arguments.pop("depth", None)
    arguments.update(stated)
    if not arguments.keys() & {"depth", "history"}:
        arguments["depth"] = str(DEFAULT.depth)
    needed = [("rclpy.qos", "QoSProfile")]
    for value in arguments.values():
        if value.startswith("Duration("):
            needed.append(("rclpy.duration", "Duration"))
        elif "Policy." in value:
            needed.append(("rclpy.qos", value.partition(".")[0]))
    profile_call = Call("QoSProfile", tuple(f"{name}={text}" for name, text in arguments.items()))
    return QosView(profile_call, tuple(needed))


def _of_preset(name: str) -> dict[str, str]:
    """Return the policies of a preset, for profiles that start from one and change some."""
    preset = policies(QosProfile(preset=name))
    if preset.depth is None:
        arguments = {"history": f"HistoryPolicy.{SYSTEM_DEFAULT.upper()}"}
    else:
        arguments = {"depth": str(preset.depth)}
    arguments["reliability"] = f"ReliabilityPolicy.{preset.reliability.upper()}"
    if preset.durability != DEFAULT.durability:
        arguments["durability"] = f"DurabilityPolicy.{preset.durability.upper()}"
    return arguments


def _stated(profile: QosProfile) -> dict[str, str]:
    """Return what the model states beside the preset, as arguments of ``QoSProfile``."""
    arguments: dict[str, str] = {}
    if profile.reliability is not None:
        arguments["reliability"] = f"ReliabilityPolicy.{profile.reliability.upper()}"
    if profile.durability is not None:
        arguments["durability"] = f"DurabilityPolicy.{profile.durability.upper()}"
    if profile.keep_all:
        arguments["history"] = "HistoryPolicy.KEEP_ALL"
    elif profile.depth is not None:
        arguments["depth"] = str(profile.depth)
    if profile.deadline_ns is not None:
        arguments["deadline"] = _duration(profile.deadline_ns)
    if profile.lifespan_ns is not None:
        arguments["lifespan"] = _duration(profile.lifespan_ns)
    if profile.liveliness is not None:
        arguments["liveliness"] = f"LivelinessPolicy.{profile.liveliness.upper()}"
    if profile.lease_ns is not None:
        arguments["liveliness_lease_duration"] = _duration(profile.lease_ns)
    return arguments


def _duration(nanoseconds: int) -> str:
    return f"Duration(nanoseconds={nanoseconds})"
