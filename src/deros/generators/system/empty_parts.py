"""Names with arguments in them that may be empty: a namespace that is the root by default.

``/${robot}/scan`` in the namespace ``$robot`` would be ``//scan`` for an empty one, and ``arm`` in
it ``/arm``, which is no longer relative. The slash behind such an argument is there only with it.
"""

from __future__ import annotations

import functools
from collections.abc import Sequence
from dataclasses import replace
from typing import TypeVar

from deros.generators.system.computed import Computed, Text
from deros.generators.system.launched import LaunchView
from deros.generators.system.programs import InsideView
from deros.generators.system.view import NodeView, ProcessView, ProgramView, SystemView
from deros.models.arguments import Argument, Chosen, Compared, Expression, Interpolation, Literally
from deros.models.node import Parameter
from deros.systems.arguments.scopes import usual_values

_Named = TypeVar("_Named", LaunchView, InsideView, NodeView)


def may_be_empty(arguments: Sequence[Parameter]) -> set[str]:
    """Return the arguments that are empty texts by default: names without them are checked."""
    return {name for name, value in usual_values(arguments).items() if value == ""}


def without_empty_parts(view: SystemView) -> SystemView:
    """Return a view whose names have no empty part, whatever the arguments are."""
    empty = may_be_empty(view.arguments)
    if not empty & (view.arguments_in_names | view.arguments_in_namespaces):
        return view
    program = functools.partial(_program, empty=empty)
    groups = (replace(group, programs=tuple(map(program, group.programs))) for group in view.groups)
    return replace(view, groups=tuple(groups))


def _program(program: ProgramView, empty: set[str]) -> ProgramView:
    if isinstance(program, LaunchView):
        return _named(program, empty)
    inside = tuple(_named(each, empty) for each in program.inside)
    if program.wait is not None:
        awaited = _joined(program.wait.name, empty)
        program = replace(program, wait=replace(program.wait, name=awaited))
    if isinstance(program, ProcessView):
        return replace(program, inside=inside)
    return replace(
        _named(program, empty),
        inside=inside,
        container=None if program.container is None else _joined(program.container, empty),
        address=None if program.address is None else _joined(program.address, empty),
    )


def _named(view: _Named, empty: set[str]) -> _Named:
    return replace(
        view,
        namespace=_joined(view.namespace, empty),
        remappings=tuple(
            (_joined(name, empty), _joined(target, empty)) for name, target in view.remappings
        ),
    )


def _joined(name: Text, empty: set[str]) -> Text:
    if isinstance(name, str):
        return name
    pieces: list[str | Expression] = []
    is_whole = False  # whether the last piece is an argument behind a slash, or at the beginning
    has_end = True  # whether all pieces so far end with a slash, whatever the arguments are
    for each in name.pieces:
        if isinstance(each, Chosen):
            pieces.append(_one_of(each, empty))
            is_whole = has_end = False
        elif is_whole and isinstance(each, str) and each.startswith("/"):
            argument = pieces.pop()
            assert isinstance(argument, Argument)
            rest = each[1:]
            pieces += [_with_slash(argument), rest]
            is_whole, has_end = False, not rest or rest.endswith("/")
        else:
            pieces.append(each)
            is_whole = has_end and isinstance(each, Argument) and each.name in empty
            has_end = isinstance(each, str) and each.endswith("/")
    return Computed(tuple(each for each in pieces if each != ""), name.type)


def _one_of(found: Chosen, empty: set[str]) -> Chosen:
    """Return the name of a node that has several, depending on the arguments."""

    def name(each: Expression) -> Expression:
        if isinstance(each, Chosen):
            return _one_of(each, empty)
        if not isinstance(each, Interpolation):
            return each
        text = _joined(Computed(each.pieces), empty)
        return replace(each, pieces=(text,) if isinstance(text, str) else text.pieces)

    return replace(found, chosen=name(found.chosen), otherwise=name(found.otherwise))


def _with_slash(argument: Argument) -> Chosen:
    span = argument.span
    nothing = Literally("", span)
    is_there = Compared("!=", argument, nothing, span)
    return Chosen(is_there, Interpolation((argument, "/"), span), nothing, span)
