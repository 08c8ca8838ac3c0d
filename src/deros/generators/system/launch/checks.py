"""What a launch file asks of the values of its arguments, which come to it as text."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass, replace

from deros.generators.system.empty_parts import may_be_empty
from deros.generators.system.literals import python_literal
from deros.generators.system.view import SystemView
from deros.models.arguments import arguments_in
from deros.models.node import Parameter, ParameterType

INTEGER = r"-?(?:0|[1-9]\d*)"
DOUBLE = r"[+-]?(?:inf|(?:(?:0|[1-9]\d*)(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d+)?)"
"""Values come into expressions as they are given; for Python, too, ``01`` is no number."""
NAMESPACE = r"[A-Za-z0-9_]+(?:/[A-Za-z0-9_]+)*"
NAME = rf"(?:~?/)?{NAMESPACE}"


@dataclass(frozen=True, slots=True)
class Check:
    """What has to hold for the value of one argument.

    Attributes:
        name: of the argument.
        holds: a condition in Python about the variable ``value``.
        wanted: the same in words, after "it has to be".
    """

    name: str
    holds: str
    wanted: str

    @property
    def condition(self) -> str:
        """The condition as the operand of ``not``."""
        is_one = not any(each in self.holds for each in (" and ", " or ", "len("))
        return self.holds if is_one else f"({self.holds})"


@dataclass(frozen=True, slots=True)
class Named:
    """Which names are made of an argument.

    Attributes:
        in_names: those of topics and services.
        in_namespaces: of nodes.
        may_be_empty: these names are checked without it, too.
    """

    in_names: bool
    in_namespaces: bool
    may_be_empty: bool


def checks_of(view: SystemView, quoted: Collection[str]) -> Iterator[Check]:
    """Yield what the values of all arguments have to be.

    Args:
        view: of the system.
        quoted: the arguments whose values stand between quotes.
    """
    names, namespaces = view.arguments_in_names, view.arguments_in_namespaces
    empty = may_be_empty(view.arguments)
    nan = _may_be_nan(view.arguments)
    for each in view.arguments:
        name = each.name
        is_named = Named(name in names, name in namespaces, name in empty)
        for check in checks(each, is_named, name in quoted):
            # A default is seen as a text, too: it cannot be told from what is given.
            yield replace(check, holds=f"value == 'nan' or {check.holds}") if name in nan else check


def _may_be_nan(arguments: Iterable[Parameter]) -> set[str]:
    """Return the arguments whose defaults may be what nobody may give."""
    found: set[str] = set()
    for each in arguments:
        uses = () if each.default_from is None else arguments_in(each.default_from)
        is_nan = isinstance(each.default, float) and math.isnan(each.default)
        if is_nan or any(use.name in found for use in uses):
            found.add(each.name)
    return found


def checks(argument: Parameter, named: Named, is_quoted: bool) -> Iterator[Check]:
    """Yield what is asked of the value of an argument; ``choices`` of texts see to themselves."""
    if argument.type in (ParameterType.INTEGER, ParameterType.DOUBLE):
        yield _number(argument)
        return
    if argument.type is not ParameterType.STRING:
        return
    if argument.choices is not None:
        is_quoted = is_quoted and any(set(str(each)) & set("'\"\\") for each in argument.choices)
        named = Named(in_names=False, in_namespaces=False, may_be_empty=False)
    pattern, what = "", ""
    if named.in_namespaces:
        pattern, what = NAMESPACE, "a relative namespace such as front or arm/left"
    elif named.in_names:
        pattern, what = NAME, "a name such as scan, front/scan or /scan"
    elif is_quoted:
        pattern, what = r"[^'\x22\\]*", "a text without quotes and backslashes"
    if named.may_be_empty and (named.in_namespaces or named.in_names):
        pattern, what = f"(?:{pattern})?", f"{what}, or empty"
    if pattern:
        quote = '"' if "'" in pattern else "'"
        yield Check(argument.name, f"re.fullmatch(r{quote}{pattern}{quote}, value)", what)
    if argument.choices is None:
        yield from _sizes(argument, is_named=named.in_names or named.in_namespaces)


def _number(argument: Parameter) -> Check:
    is_integer = argument.type is ParameterType.INTEGER
    kind = "int" if is_integer else "float"
    holds = [f"re.fullmatch({'INTEGER' if is_integer else 'DOUBLE'}, value)"]
    wanted = "an integer" if is_integer else "a number"
    interval = argument.interval
    if is_integer and argument.choices is None and not _is_bounded(argument):
        holds.append("int(value).bit_length() < 64")
        wanted += " of 64 bits"
    if interval is not None:
        holds.append(_within(f"{kind}(value)", argument))
        wanted += f" {interval.clause()}"
    if argument.choices is not None:
        listed = ", ".join(map(repr, argument.choices))
        known = ", ".join(map(python_literal, argument.choices))
        holds.append(f"{kind}(value) in ({known},)")
        wanted += f", one of {listed}"
    return Check(argument.name, " and ".join(holds), wanted)


def _is_bounded(argument: Parameter) -> bool:
    interval = argument.interval
    return interval is not None and all(map(math.isfinite, (interval.lower, interval.upper)))


def _within(value: str, argument: Parameter) -> str:
    interval = argument.interval
    assert interval is not None
    below = "<=" if interval.lower_closed else "<"
    above = "<=" if interval.upper_closed else "<"
    lower = f"{interval.lower!r} {below} " if math.isfinite(interval.lower) else ""
    upper = f" {above} {interval.upper!r}" if math.isfinite(interval.upper) else ""
    return f"{lower}{value}{upper}"


def _sizes(argument: Parameter, *, is_named: bool) -> Iterator[Check]:
    most = [size for size in (argument.size, argument.max_size) if size is not None]
    if argument.least_size == 1:
        if not is_named:  # no name is empty
            yield Check(argument.name, "value", "a text that is not empty")
    elif argument.least_size:
        yield Check(
            argument.name,
            f"len(value) >= {argument.least_size}",
            f"a text of {argument.least_size} characters or more",
        )
    if most:
        yield Check(
            argument.name,
            f"len(value) <= {min(most)}",
            f"a text of {min(most)} characters at most",
        )
