"""Values of parameters in YAML."""

from __future__ import annotations

from deros.metamodels.yaml_trees.tree import Mapping, Scalar, Tree
from deros.models import common


class UnusableError(Exception):
    """A value cannot be used; the text completes "it …"."""


def plain_value(tree: Tree) -> common.Value | None:
    """Return a value, or a list of values; ``None`` for null.

    Raises:
        UnusableError: if it is nested, or has null in a list.
    """
    if isinstance(tree, Scalar):
        return tree.value
    if isinstance(tree, Mapping):
        raise UnusableError("has keys, and is no value")
    items: list[common.Scalar] = []
    for each in tree.items:
        if not isinstance(each, Scalar):
            raise UnusableError("is a list with more than values in it")
        if each.value is None:
            raise UnusableError("is a list with a missing value")
        items.append(each.value)
    return tuple(items)
