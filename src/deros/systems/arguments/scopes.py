"""The values of arguments: usual ones, and those that a system passes to one that it uses."""

from __future__ import annotations

import contextlib
import itertools
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from deros.models.arguments import Expression, Lookup, arguments_in
from deros.models.common import Scalar, Value
from deros.models.node import Parameter, ParameterType, as_double
from deros.systems.arguments.evaluate import CannotEvaluate, evaluate


@dataclass(frozen=True, slots=True, eq=False)
class Scope:
    """The arguments of a system at one place where it is used; the outermost is the system itself.

    Attributes:
        arguments: that the system declares.
        bound: what the system that uses it passes, in terms of the arguments of ``outer``.
    """

    arguments: tuple[Parameter, ...]
    bound: Mapping[str, Expression] = field(default_factory=dict)
    outer: Scope | None = None

    def values(self, outermost: Mapping[str, Scalar]) -> dict[str, Scalar]:
        """Return the values of all arguments, given some of those of the outermost system."""
        given: Mapping[str, Scalar] = outermost
        if self.outer is not None:
            given = {key: value for key, value in outermost.items() if " " in key}  # looked up
            if self.bound:
                outer = self.outer.values(outermost)
                given |= {name: evaluate(each, outer) for name, each in self.bound.items()}
        given = typed(given, self.arguments)
        return {**usual_values(self.arguments, given), **given}

    def meaning(self, name: str) -> tuple[Expression, Scope] | None:
        """Return what an argument of a used system stands for, and where that is written."""
        if self.outer is None:
            return None
        if name in self.bound:
            return self.bound[name], self.outer
        found = next((each.default_from for each in self.arguments if each.name == name), None)
        return None if found is None else (found, self)

    def origins(self, names: Iterable[str]) -> Iterator[str]:
        """Yield the arguments of the outermost system that decide the values of arguments."""
        for name in names:
            if self.outer is None:
                yield name
                continue
            meaning = self.meaning(name)
            if meaning is not None:
                found, scope = meaning
                yield from scope.origins(each.name for each in arguments_in(found))


def usual_values(
    arguments: Sequence[Parameter], given: Mapping[str, Scalar] | None = None
) -> dict[str, Scalar]:
    """Return the defaults; for an argument without one, some value that its declaration allows.

    Args:
        arguments: each may have a default that is computed from those before it.
        given: the values of some of them, which such defaults see.
    """
    known: dict[str, Scalar] = dict(given or {})
    found: dict[str, Scalar] = {}
    for each in arguments:
        found[each.name] = _usual_value(each, known)
        known.setdefault(each.name, found[each.name])
    return typed(found, arguments)


def _usual_value(argument: Parameter, known: Mapping[str, Scalar]) -> Scalar:
    """Return the default of an argument, or else some value that its declaration allows."""
    default: Value | None = argument.default
    if argument.choices and is_open(argument, known):
        return argument.choices[0]
    if argument.default_from is not None:
        with contextlib.suppress(CannotEvaluate):  # which is reported where it is written
            default = evaluate(argument.default_from, known)
    if default is not None and not isinstance(default, tuple):
        return default
    if argument.choices:
        return argument.choices[0]
    if argument.type is ParameterType.BOOL:
        return False
    if argument.type is ParameterType.STRING:
        return argument.name
    bounds = argument.interval
    value = 0.0
    if bounds is not None and value not in bounds:
        value = next(filter(bounds.__contains__, points((bounds.lower, bounds.upper))), 0.0)
    return value if argument.type is ParameterType.DOUBLE else math.ceil(value)


def is_open(argument: Parameter, known: Mapping[str, Scalar]) -> bool:
    """Return whether a default is a variable of which nothing is known but ``one_of``.

    The name of the variable stands for such a text elsewhere, but would be none of the choices.
    """
    match argument.default_from:
        case Lookup(function="env", default=None, key=key):
            is_text = argument.type is ParameterType.STRING
            return key not in known and is_text and bool(argument.choices)
    return False


def typed(values: Mapping[str, Scalar], arguments: Iterable[Parameter]) -> dict[str, Scalar]:
    """Return values with integers of double arguments as doubles."""
    types = {each.name: each.type for each in arguments}
    found: dict[str, Scalar] = {}
    for name, value in values.items():
        converted = as_double(value, types.get(name, ParameterType.STRING))
        assert not isinstance(converted, tuple)
        found[name] = converted
    return found


def points(constants: Iterable[float]) -> list[float]:
    """Return the constants, and a number on each side of each of them."""
    ordered = sorted({each for each in constants if math.isfinite(each)})
    between = [(low + high) / 2 for low, high in itertools.pairwise(ordered)]
    outside = [ordered[0] - 1, ordered[-1] + 1] if ordered else []
    return [*ordered, *between, *outside]
