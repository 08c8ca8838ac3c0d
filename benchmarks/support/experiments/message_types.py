"""Messages of ROS 2 by the names of their types and fields."""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module
from typing import Any


def message_class(name: str) -> Any:
    """Return the class of a type such as ``std_msgs/msg/Bool``."""
    package, kind, of_type = name.split("/")
    return getattr(import_module(f"{package}.{kind}"), of_type)


def message(name: str, fields: Mapping[str, Any]) -> Any:
    """Return a message of a type; fields have dotted names, others their defaults."""
    made = message_class(name)()
    for path, value in fields.items():
        *parents, last = path.split(".")
        part = made
        for each in parents:
            part = getattr(part, each)
        setattr(part, last, value)
    return made
