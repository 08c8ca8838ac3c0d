"""Values of parameters in YAML."""

from __future__ import annotations

from deros.interfaces.types import INT64
from deros.metamodels.yaml_trees.tree import Mapping, Scalar, Tree
from deros.models import common


class UnusableError(Exception):
    """A value cannot be used; the text completes "it …"."""


def plain_value(tree: Tree) -> common.Value | None:
    """Return a value, or a list of values; ``None`` for null.

    Raises:
        UnusableError: if it is nested, too large, or has null in a list.
    """
    if isinstance(tree, Scalar):
        return _whole(tree.value)
    if isinstance(tree, Mapping):
        raise UnusableError("has keys, and is no value")
    items: list[common.Scalar] = []
    for each in tree.items:
        if not isinstance(each, Scalar):
            raise UnusableError("is a list with more than values in it")
        if each.value is None:
            raise UnusableError("is a list with a missing value")
        items.append(each.value)
        _whole(each.value)
    return tuple(items)


def _whole(value: common.Scalar | None) -> common.Scalar | None:
    """Return a value that any parameter can have: Python's integers have no end, others do."""
    if isinstance(value, int) and value not in INT64:
        raise UnusableError("is an integer of more than 64 bits")
    return value
