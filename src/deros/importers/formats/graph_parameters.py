"""Parameters of a node in a message: descriptors, and values beside them."""

from __future__ import annotations

import math
from collections.abc import Iterator

from deros.importers.formats.graph_fields import Fields
from deros.importers.formats.names import has_long_word
from deros.importers.formats.values import UnusableError, plain_value
from deros.live.snapshots import VALUE_FIELDS, SeenParameter
from deros.metamodels.yaml_trees.tree import Scalar
from deros.models.common import Interval, Value
from deros.models.node import BUILT_IN_PARAMETERS, ParameterType, as_double
from deros.validators.node.values import type_fault

_TYPES = list(ParameterType)
"""In the order of their numbers in ``ParameterType.msg``, from 1."""


def parameters_of(node: str, fields: Fields) -> tuple[SeenParameter, ...] | None:
    """Return the parameters of a node; ``None`` where it is not known which it has.

    Every node has one, so that a message without any does not know them. Of one without values, the
    types are known, but not what a system sets.
    """
    described = list(fields.items("parameters"))
    values = list(fields.items("parameter_values"))
    if not described or len(values) != len(described):
        if described:
            what = f"parameters of '{node}'"
            fields.lack(what, f"are left out: {len(described)} have {len(values)} values")
        return None
    found: dict[str, SeenParameter] = {}
    for descriptor, value in zip(described, values, strict=True):
        for each in _parameter(node, descriptor, value):
            found.setdefault(each.name, each)
    return tuple(found[name] for name in sorted(found))


def _parameter(node: str, descriptor: Fields, value: Fields) -> Iterator[SeenParameter]:
    """Yield a parameter, unless it has no value."""
    name, number = descriptor.text("name"), value.integer("type") - 1
    what = f"parameter '{name}' of '{node}'"
    if number not in range(len(_TYPES)):
        descriptor.lack(what, "is left out: it has no value")
        return
    of_type = _TYPES[number]
    if BUILT_IN_PARAMETERS.get(name, of_type) is not of_type:
        descriptor.lack(what, f"is left out: it is not of type {of_type.value} in any node")
        return
    if has_long_word(name):
        descriptor.lack(what, "is left out: its name is too long")
        return
    try:
        plain = _value(value, VALUE_FIELDS[number], of_type)
    except UnusableError as error:
        descriptor.lack(what, f"is left out: its value {error}")
        return
    ranges = [*descriptor.items("integer_range"), *descriptor.items("floating_point_range")]
    interval, step = None, 0.0
    if ranges:
        interval = _interval(ranges[0], plain)
        step = ranges[0].number("step") if interval is not None else 0
        if interval is None:
            descriptor.lack(what, "has a range that its value is not in, or that is none")
    yield SeenParameter(
        name,
        of_type,
        plain,
        descriptor.text("description"),
        descriptor.text("additional_constraints"),
        descriptor.is_true("read_only"),
        interval,
        step,
    )


def _interval(fields: Fields, value: Value) -> Interval | None:
    """Return a range; ``None`` where it is none, or the value is not in it."""
    lower, upper = fields.number("from_value"), fields.number("to_value")
    if isinstance(value, str | bool | tuple) or not math.isfinite(lower + upper) or lower > upper:
        return None
    return made if value in (made := Interval(lower, upper)) else None


def _value(fields: Fields, key: str, of_type: ParameterType) -> Value:
    tree = fields.tree.get(key)
    found = plain_value(tree) if tree is not None else None
    if of_type is ParameterType.STRING and isinstance(tree, Scalar):
        found = tree.text
    if found is None:
        raise UnusableError("is not in the message")
    if fault := type_fault(of_type, found):
        raise UnusableError(f"is of another type: {fault}")
    return as_double(found, of_type)
