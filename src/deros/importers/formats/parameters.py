"""Parameters as ``generate_parameter_library`` declares them; NoDL does so in the same words.

Source: the README of generate_parameter_library, and what its ``parse_yaml.py`` reads.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

from deros.diagnostics import Span
from deros.importers.formats import draft
from deros.importers.formats.values import UnusableError, plain_value
from deros.interfaces.types import INT64
from deros.metamodels.yaml_trees import tree as yaml
from deros.models.common import Interval, Scalar, Value
from deros.models.node import ParameterType, as_double

_TYPES = {
    "bool": ParameterType.BOOL,
    "int": ParameterType.INTEGER,
    "double": ParameterType.DOUBLE,
    "string": ParameterType.STRING,
    "bool_array": ParameterType.BOOL_ARRAY,
    "byte_array": ParameterType.BYTE_ARRAY,
    "int_array": ParameterType.INTEGER_ARRAY,
    "double_array": ParameterType.DOUBLE_ARRAY,
    "string_array": ParameterType.STRING_ARRAY,
}
_FIXED = re.compile(r"(\w+)_fixed_([0-9]{1,9})", re.ASCII)
_KEYS = (
    "type",
    "default_value",
    "description",
    "read_only",
    "additional_constraints",
    "validation",
)
_SIZES = range(2**31)


class _Type(NamedTuple):
    of: ParameterType
    most: int | None


def is_declaration(tree: yaml.Tree | None) -> bool:
    """Return whether keys declare a parameter: they have a type, which is a word."""
    return isinstance(tree, yaml.Mapping) and isinstance(tree.get("type"), yaml.Scalar)


def is_type(word: str) -> bool:
    """Return whether a word is a type of a parameter, or says that there is none."""
    return word == "none" or _type(word) is not None


def _type(word: str) -> _Type | None:
    fixed = _FIXED.fullmatch(word)
    of = _TYPES.get(fixed[1] if fixed else word)
    return _Type(of, int(fixed[2]) if fixed else None) if of is not None else None


def declare(to: draft.Draft, name: str, tree: yaml.Mapping, place: Span) -> None:
    """Declare a parameter.

    Args:
        to: the node that has it.
        name: its full name; ``<x>`` in it stands for the entries of list ``x``.
        tree: what is said of it.
        place: of its name.
    """
    what = f"parameter '{name}'"
    stated = tree.get("type")
    word = stated.text if isinstance(stated, yaml.Scalar) else ""
    found = _type(word)
    for key, value in tree.entries.items():
        if key not in _KEYS:
            to.lack(what, f"has '{key}', which says nothing of a parameter", value.span)
    if found is None:
        why = "is left out: "
        why += "type 'none' is for documents only" if word == "none" else f"no type '{word}'"
        to.lack(what, why, stated.span if stated is not None else place)
        return
    limits = _Limits()
    if found.most is not None:
        limits.at_most(found.most)
    _validations(to, what, tree.get("validation"), limits)
    extra = tree.get("additional_constraints")
    if isinstance(extra, yaml.Scalar) and extra.text:
        to.lack(what, f"has constraints in words: {extra.text}", extra.span)
    to.add_parameter(
        name,
        found.of,
        place,
        default=_default(to, what, tree.get("default_value"), found.of),
        description=_text(tree.get("description")),
        read_only=_is_true(tree.get("read_only")),
        **limits.fields(),
    )


def _text(tree: yaml.Tree | None) -> str:
    return " ".join(tree.text.split()) if isinstance(tree, yaml.Scalar) else ""


def _is_true(tree: yaml.Tree | None) -> bool:
    return isinstance(tree, yaml.Scalar) and bool(tree.value)


def _default(to: draft.Draft, what: str, tree: yaml.Tree | None, of: ParameterType) -> Value | None:
    if tree is None:
        return None
    try:
        value = plain_value(tree)
    except UnusableError as error:
        to.lack(what, f"has no default here: it {error}", tree.span)
        return None
    return as_double(value, of) if value is not None else None


# Validations ------------------------------------------------------------------------------------


class _Limits:
    """The constraints of a parameter, of which the narrowest count."""

    def __init__(self) -> None:
        self.lower, self.upper = -math.inf, math.inf
        self.lower_closed = self.upper_closed = True
        self.words: dict[str, Any] = {}
        self.custom: list[str] = []

    def above(self, bound: Scalar, *, closed: bool) -> None:
        """Take in a lower bound."""
        number = _number(bound)
        if (number, not closed) > (self.lower, not self.lower_closed):
            self.lower, self.lower_closed = number, closed

    def below(self, bound: Scalar, *, closed: bool) -> None:
        """Take in an upper bound."""
        number = _number(bound)
        if (-number, not closed) > (-self.upper, not self.upper_closed):
            self.upper, self.upper_closed = number, closed

    def at_least(self, size: Scalar, more: int = 0) -> None:
        """Take in a least size."""
        self.words["min_size"] = max(_size(size) + more, self.words.get("min_size", 0))

    def at_most(self, size: Scalar, more: int = 0) -> None:
        """Take in a greatest size."""
        most = _size(size) + more
        if most < 0:
            raise UnusableError("allows no size")
        self.words["max_size"] = min(most, self.words.get("max_size", most))

    def exactly(self, size: Scalar) -> None:
        """Take in a size."""
        if self.words.setdefault("size", _size(size)) != size:
            raise UnusableError("is another size than the one before")

    def one_of(self, choices: Any) -> None:
        """Take in the values that are allowed."""
        if not isinstance(choices, tuple):
            raise UnusableError("is not a list in a list")
        if "choices" in self.words:
            raise UnusableError("is a second list of values")
        self.words["choices"] = choices

    def fields(self) -> dict[str, Any]:
        """Return the constraints as a parameter has them."""
        ends = self.lower, self.upper
        if ends != (-math.inf, math.inf):
            interval = Interval(*ends, self.lower_closed, self.upper_closed)
            self.words["interval"] = interval
        return {**self.words, "custom": tuple(self.custom)}


def _number(value: Scalar) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or value != value:
        raise UnusableError("is not a number")
    if isinstance(value, int) and value not in INT64:
        raise UnusableError("is a number without end")
    return value


def _size(value: Scalar) -> int:
    if isinstance(value, bool) or not isinstance(value, int) or value not in _SIZES:
        raise UnusableError("is not a size")
    return value


def _between(limits: _Limits, lower: Scalar, upper: Scalar) -> None:
    limits.above(lower, closed=True)
    limits.below(upper, closed=True)


def _not_empty(limits: _Limits) -> None:
    limits.words["not_empty"] = True


def _unique(limits: _Limits) -> None:
    limits.words["unique"] = True


class _Row(NamedTuple):
    arguments: int
    take: Callable[..., None]


_BETWEEN = _Row(2, _between)
_FROM = _Row(1, lambda limits, bound: limits.above(bound, closed=True))
_UP_TO = _Row(1, lambda limits, bound: limits.below(bound, closed=True))
_ONE_OF = _Row(1, lambda limits, choices: limits.one_of(choices))
_ROWS: Mapping[str, _Row] = {
    "bounds": _BETWEEN,
    "element_bounds": _BETWEEN,
    "gt_eq": _FROM,
    "lower_element_bounds": _FROM,
    "lt_eq": _UP_TO,
    "upper_element_bounds": _UP_TO,
    "gt": _Row(1, lambda limits, bound: limits.above(bound, closed=False)),
    "lt": _Row(1, lambda limits, bound: limits.below(bound, closed=False)),
    "one_of": _ONE_OF,
    "subset_of": _ONE_OF,
    "fixed_size": _Row(1, lambda limits, size: limits.exactly(size)),
    "size_gt": _Row(1, lambda limits, size: limits.at_least(size, 1)),
    "size_lt": _Row(1, lambda limits, size: limits.at_most(size, -1)),
    "not_empty": _Row(0, _not_empty),
    "unique": _Row(0, _unique),
}
"""The functions of the library, and the number of arguments that each takes."""


def _validations(to: draft.Draft, what: str, tree: yaml.Tree | None, limits: _Limits) -> None:
    if tree is None or (isinstance(tree, yaml.Scalar) and tree.value is None):
        return
    if not isinstance(tree, yaml.Mapping):
        to.lack(what, "has a 'validation' without functions", tree.span)
        return
    for written, arguments in tree.entries.items():
        name = written.removesuffix("<>")
        try:
            _take(limits, name, _arguments(arguments))
        except UnusableError as error:
            to.lack(what, f"is checked by '{written}', which {error}", tree.keys[written])


def _take(limits: _Limits, name: str, arguments: Sequence[Any]) -> None:
    row = _ROWS.get(name)
    if row is not None:
        if len(arguments) != row.arguments:
            raise UnusableError(f"takes {row.arguments} values, and has {len(arguments)} here")
        row.take(limits, *arguments)
    elif "::" not in name:
        raise UnusableError("is not known")
    elif arguments:
        raise UnusableError("is given values; a function here gets that of the parameter alone")
    else:
        limits.custom.append(name)


def _arguments(tree: yaml.Tree) -> list[Any]:
    """Return the arguments of a function: one need not stand in a list, and none may be null."""
    if isinstance(tree, yaml.Scalar):
        return [] if tree.value is None else [tree.value]
    if not isinstance(tree, yaml.Sequence):
        raise UnusableError("has keys in place of values")
    values = [plain_value(each) for each in tree.items]
    if any(each is None for each in values):
        raise UnusableError("has a missing value")
    return values
