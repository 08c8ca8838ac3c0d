"""QoS profiles in the words of NoDL 2."""

from __future__ import annotations

from typing import Any

from deros.importers.formats.draft import Draft
from deros.interfaces.durations import NS_PER_S
from deros.metamodels.yaml_trees.tree import Mapping, Scalar, Tree
from deros.models.common import QosProfile

_DEFAULT = "SYSTEM_DEFAULT"
_WORDS = {
    "reliability": {"RELIABLE": "reliable", "BEST_EFFORT": "best_effort"},
    "durability": {"TRANSIENT_LOCAL": "transient_local", "VOLATILE": "volatile"},
    "liveliness": {"AUTOMATIC": "automatic", "MANUAL_BY_TOPIC": "manual_by_topic"},
}
_TIMES = {
    "deadline_ns": "deadline_ns",
    "lifespan_ns": "lifespan_ns",
    "liveliness_lease_duration_ns": "lease_ns",
}
_CHOSEN = ("history", "reliability", "durability")
"""The policies that a profile has to choose, or leaves to the middleware."""

_LONGEST = (2**31 - 1) * NS_PER_S  # of DDS
_DEPTHS = range(1, 2**31)


def read_qos(draft: Draft, what: str, tree: Tree) -> QosProfile | None:
    """Return the profile of a port; what it cannot say is noted.

    Args:
        draft: the node.
        what: the port, for people.
        tree: what the document says.
    """
    if not isinstance(tree, Mapping):
        draft.lack(what, "has a 'qos' without policies", tree.span)
        return None
    values = {
        key: value.value if isinstance(value, Scalar) else None
        for key, value in tree.entries.items()
    }
    fields: dict[str, Any] = {}
    chosen = {values[key] for key in _CHOSEN if key in values}
    if chosen == {_DEFAULT}:
        fields["preset"] = "system_default"
        values = {key: value for key, value in values.items() if key not in _CHOSEN}
    for key, value in values.items():
        if why := _take(fields, key, value, values):
            draft.lack(what, f"has the QoS '{key}: {value}', {why}", tree.entries[key].span)
    if "lease_ns" in fields and "liveliness" not in fields:
        fields["liveliness"] = "automatic"
    profile = QosProfile(**fields)
    return profile if profile != QosProfile() else None


def _take(fields: dict[str, Any], key: str, value: object, values: dict[str, Any]) -> str:
    """Put a policy into the fields of a profile; return why that cannot be."""
    if key in _WORDS and value in _WORDS[key]:
        fields[key] = _WORDS[key][str(value)]
    elif key == "history" and value in ("KEEP_LAST", "KEEP_ALL"):
        fields["keep_all"] = value == "KEEP_ALL"
    elif key == "depth" and type(value) is int and value in _DEPTHS:
        if values.get("history") == "KEEP_ALL":
            return "which means nothing beside KEEP_ALL"
        fields["depth"] = value
    elif key in _TIMES and type(value) is int and 0 <= value <= _LONGEST:
        fields |= {_TIMES[key]: value} if value else {}
    elif key in (*_WORDS, "history") and value in (_DEFAULT, "BEST_AVAILABLE"):
        return "which is the default of ROS 2 here"
    else:
        return "which is not known"
    return ""
