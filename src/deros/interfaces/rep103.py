"""Units of the fields of common messages.

ROS prescribes SI units and radians (REP 103), and the message definitions say the rest in comments;
``rep103.json`` holds both as data. A unit given to a field of message type holds for all that is
nested in it: ``geometry_msgs/Twist.linear`` applies to ``x``, ``y`` and ``z`` of every Twist.
A unit with ``wrapping`` behind it is that of an angle that jumps by a full turn, and
``1 in [0, 1]`` is that of a ratio that its message keeps within these bounds.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from functools import cache
from pathlib import Path

from deros.interfaces.fields import FieldPath
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import InterfaceType
from deros.interfaces.units import Unit, UnitRegistry

_WRAPPING = " wrapping"
_SHARE = " in [0, 1]"


def unit_of(store: InterfaceStore, kind: InterfaceType, path: FieldPath) -> str | None:
    """Return the unit of the field at ``path`` of the message ``kind``.

    ``"1"`` says that it is a ratio, ``None`` that nothing is known of its unit.
    """
    text = _text_of(store, kind, path)
    return text.removesuffix(_WRAPPING).removesuffix(_SHARE) if text is not None else None


def usual_unit(
    store: InterfaceStore, units: UnitRegistry, kind: InterfaceType, path: FieldPath
) -> Unit | None:
    """Return the unit of a field as :func:`unit_of` does, read."""
    text = unit_of(store, kind, path)
    return units.parse(text) if text is not None else None


def is_wrapping(store: InterfaceStore, kind: InterfaceType, path: FieldPath) -> bool:
    """Return whether the field is an angle that wraps around after a full turn."""
    return (_text_of(store, kind, path) or "").endswith(_WRAPPING)


def is_share(store: InterfaceStore, kind: InterfaceType, path: FieldPath) -> bool:
    """Return whether the field is a ratio from 0 to 1, as its message says."""
    return (_text_of(store, kind, path) or "").endswith(_SHARE)


def _text_of(store: InterfaceStore, kind: InterfaceType, path: FieldPath) -> str | None:
    here: InterfaceType | None = kind
    for part in path:
        if not isinstance(part, str):
            continue
        if here is None:
            return None
        unit = _table().get(f"{here.package}/{here.name}", {}).get(part)
        if unit is not None:
            return unit
        definition = store.message(here)
        field = definition.field(part) if definition else None
        here = field.base if field and isinstance(field.base, InterfaceType) else None
    return None


@cache
def _table() -> Mapping[str, Mapping[str, str]]:
    text = Path(__file__).with_name("rep103.json").read_text(encoding="utf-8")
    table: dict[str, dict[str, str]] = json.loads(text)
    return table
