"""Names in a launch file that go with the namespace that it is included in.

What a system leaves relative is so in its launch file: whoever includes the file below a namespace
(``PushRosNamespace``) has all of it there.
"""

from __future__ import annotations

from dataclasses import replace

from deros.generators.system.computed import Computed, Setting, Text
from deros.generators.system.launched import LaunchView
from deros.generators.system.programs import InsideView
from deros.generators.system.view import ProcessView, ProgramView, SystemView
from deros.models.arguments import Expression
from deros.names.graph_names import ANY_ROOT, from_root


def relative(view: SystemView) -> SystemView:
    """Return a view, made for :data:`ANY_ROOT`, with names below it as relative ones."""
    groups = (
        replace(group, programs=tuple(map(_program, group.programs))) for group in view.groups
    )
    return replace(view, groups=tuple(groups))


def _program(program: ProgramView) -> ProgramView:
    if isinstance(program, LaunchView):
        return replace(program, namespace=_below(program.namespace, (ANY_ROOT,)))
    others = tuple(map(_inside, program.inside))
    if isinstance(program, ProcessView):
        return replace(program, inside=others)
    inside = _pieces(program.namespace)
    return replace(
        program,
        namespace=_below(program.namespace, (ANY_ROOT,)),
        remappings=tuple((name, _below(target, inside)) for name, target in program.remappings),
        parameters=tuple((name, _setting(value, inside)) for name, value in program.parameters),
        container=None if program.container is None else _absolute(program.container),
        address=None if program.address is None else _absolute(program.address),
        inside=others,
    )


def _inside(node: InsideView) -> InsideView:
    inside = _pieces(node.namespace)
    return replace(
        node,
        namespace=_below(node.namespace, (ANY_ROOT,)),
        remappings=tuple((name, _below(target, inside)) for name, target in node.remappings),
        parameters=tuple((name, _setting(value, inside)) for name, value in node.parameters),
    )


def _setting(value: Setting, inside: _Pieces) -> Setting:
    """Return a value; a topic that the system sets by a parameter is a name, too."""
    if isinstance(value, str | Computed):
        return _below(value, inside)
    if isinstance(value, tuple):
        return tuple(_below(e, inside) if isinstance(e, str | Computed) else e for e in value)
    return value


_Pieces = tuple[str | Expression, ...]


def _pieces(text: Text) -> _Pieces:
    return (text,) if isinstance(text, str) else text.pieces


def _below(text: Text, start: _Pieces) -> Text:
    """Return a name as a node in the namespace ``start`` resolves it; any other text as it is."""
    pieces = _pieces(text)
    if not isinstance(pieces[0], str) or not pieces[0].startswith(ANY_ROOT):
        return text
    for position, each in enumerate(start):
        found = pieces[position] if position < len(pieces) else None
        if isinstance(found, str) and isinstance(each, str) and found.startswith(each):
            rest = (found.removeprefix(each), *pieces[position + 1 :])
        elif found == each:
            rest = ("", *pieces[position + 1 :])
        else:
            return _absolute(text)
        if position + 1 < len(start) and rest[0]:
            return _absolute(text)
    first, *others = rest if rest[0] or len(rest) == 1 else rest[1:]
    if isinstance(first, str):
        if first and not first.startswith("/"):
            return _absolute(text)
        first = first.removeprefix("/")
    return _as(text, (first, *others))


def _absolute(text: Text) -> Text:
    first, *others = _pieces(text)
    return _as(text, (from_root(first) if isinstance(first, str) else first, *others))


def _as(text: Text, pieces: _Pieces) -> Text:
    """Return pieces in the form of a text that they are made from."""
    if isinstance(text, str):
        return "".join(map(str, pieces))
    return replace(text, pieces=tuple(each for each in pieces if each != ""))
