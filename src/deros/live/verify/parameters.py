"""The parameters of nodes: missing ones, wrong values, and values that change."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator

from deros.live.observer import printable
from deros.live.snapshots import SeenNode, SeenParameter
from deros.live.verify.differences import Difference, Kind
from deros.live.verify.expectation import ExpectedNode, ExpectedParameter
from deros.models.common import Value
from deros.models.node import ParameterType, as_double

FirstValues = dict[tuple[str, str], SeenParameter]
"""By the name of the node and that of the parameter."""


def parameter_differences(
    node: ExpectedNode, seen: SeenNode, first: FirstValues | None, *, is_whole: bool
) -> Iterator[Difference]:
    """Yield what differs in the parameters of a node, which are known.

    Args:
        node: what it has to be.
        seen: what it is.
        first: see :func:`~deros.live.verify.compare.compare`.
        is_whole: whether it has all of its parameters in its present state.
    """
    there = {each.name: each for each in seen.parameters or ()}
    for meant in node.parameters:
        found = there.pop(meant.name, None)
        if found is not None:
            yield from _wrong_values(node, meant, found)
        elif is_whole and not meant.may_be_missing:
            expected = value_text(_meant(meant, meant.type))
            yield _difference(Kind.MISSING_PARAMETER, node, meant, expected, "nothing")
    if first is None:
        return
    for name, found in there.items():
        before = first.setdefault((node.full_name, name), found)
        if before.type is not found.type or not is_same(before.value, found.value):
            old, new = value_text(before.value), value_text(found.value)
            yield Difference(Kind.CHANGED_VALUE, node.full_name, printable(name), old, new)


def _wrong_values(
    node: ExpectedNode, meant: ExpectedParameter, found: SeenParameter
) -> Iterator[Difference]:
    """Yield that a parameter has another type or value."""
    value, kind = _meant(meant, meant.type or found.type), Kind.WRONG_VALUE
    expected, seen = value_text(value), value_text(found.value)
    if meant.type not in (None, found.type) and found.value != ():  # an empty array has any type
        assert meant.type is not None
        expected, seen = f"{expected} ({meant.type.value})", f"{seen} ({found.type.value})"
        yield _difference(kind, node, meant, expected, seen)
    elif not is_same(value, found.value):
        yield _difference(kind, node, meant, expected, seen)


def _difference(
    kind: Kind, node: ExpectedNode, meant: ExpectedParameter, expected: str, seen: str
) -> Difference:
    return Difference(kind, node.full_name, printable(meant.name), expected, seen, span=meant.span)


def _meant(meant: ExpectedParameter, kind: ParameterType | None) -> Value:
    return meant.value if kind is None else as_double(meant.value, kind)


def is_same(one: Value, other: Value) -> bool:
    """Return whether two values are equal, and of one type; a number that is none equals itself."""
    if isinstance(one, tuple) and isinstance(other, tuple):
        return len(one) == len(other) and all(map(is_same, one, other))
    if type(one) is not type(other):
        return False
    if isinstance(one, float) and isinstance(other, float) and math.isnan(one):
        return math.isnan(other)
    return one == other


def value_text(value: Value) -> str:
    """Return a value as the languages write it."""
    if isinstance(value, tuple):
        return f"[{', '.join(map(value_text, value))}]"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return printable(json.dumps(value, ensure_ascii=False))
    return repr(value)
