"""The view of parameters whose values xacro makes when a system is started."""

from __future__ import annotations

import itertools
import re
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, fields, is_dataclass, replace

from deros import codes
from deros.diagnostics import Diagnostic, report
from deros.generators.system.computed import Computed, Text
from deros.generators.system.files import FileView, file_view
from deros.models.arguments import (
    LaunchArgument,
    Literally,
    Lookup,
    launch_text,
    made_in,
    merged,
)
from deros.models.system import ParameterSetting, System
from deros.systems.arguments.symbolic import as_written
from deros.systems.flat import FlatNode

_MARK = re.compile("\ue000(\\d+)\ue001")


@dataclass(frozen=True, slots=True)
class XacroView:
    """One text that xacro makes: of which file, and with which arguments, as texts."""

    file: FileView
    arguments: tuple[tuple[str, Text], ...]


def made_settings(node: FlatNode) -> dict[str, ParameterSetting]:
    """Return the parameters of a node whose values xacro makes, by name."""
    wired = {each.wiring.port for each in node.untyped}
    wired |= {each.port.via for each in node.ports if each.sets_parameter and each.port.via}
    last = {each.name: each for each in node.instance.parameters}
    return {n: each for n, each in last.items() if each.xacro is not None and n not in wired}


def described(
    node: FlatNode, system: System, text: Callable[[str], Text]
) -> tuple[tuple[str, XacroView], ...]:
    """Return the parameters of a node that xacro makes, each with how.

    Args:
        node: at run time.
        system: for which something is generated.
        text: returns what a text with marks of computed parts is made of.
    """
    found = []
    for name, setting in made_settings(node).items():
        assert setting.xacro is not None
        given = ((each.name, text(as_written(each.value))) for each in setting.xacro.arguments)
        found.append((name, XacroView(file_view(setting.xacro, system, text), tuple(given))))
    return tuple(found)


def made_views(found: Iterable[Lookup], system: System) -> tuple[tuple[Lookup, XacroView], ...]:
    """Return how each of some files is made, by a use of its path in terms of the arguments."""
    return tuple((each, _made_view(each, system)) for each in found)


def made_texts(program: object) -> tuple[Computed, ...]:
    """Return the texts in the view of a program that hold the path of a file that is made."""
    return tuple(dict.fromkeys(_made_texts(program)))


def _made_texts(found: object) -> Iterator[Computed]:
    if isinstance(found, Computed):
        expressions = (each for each in found.pieces if not isinstance(each, str))
        if any(True for each in expressions for _ in made_in(each)):
            yield found
    elif isinstance(found, tuple):
        yield from itertools.chain(*map(_made_texts, found))
    elif is_dataclass(found) and not isinstance(found, type):
        yield from itertools.chain(*(_made_texts(getattr(found, e.name)) for e in fields(found)))


def _made_view(found: Lookup, system: System) -> XacroView:
    made = found.made
    assert made is not None
    pieces = () if made.path_from is None else merged((made.path_from,))
    marked = "".join(p if isinstance(p, str) else f"\ue000{n}\ue001" for n, p in enumerate(pieces))
    if pieces and not isinstance(pieces[0], str):
        marked = f"\ue002{marked}"  # whether it is an absolute path is open

    def text(path: str) -> Text:
        parts = _MARK.split(path)
        known = [pieces[int(p)] if at % 2 else p for at, p in enumerate(parts)]
        inside = tuple(each for each in known if each != "")
        return Computed(inside) if len(parts) > 1 else path

    file = file_view(replace(made, path=marked or made.path), system, text)
    given = ((each.name, _given(each)) for each in made.arguments)
    return XacroView(file, tuple(given))


def _given(found: LaunchArgument) -> Text:
    value = found.value_from
    if value is None:
        return found.value
    if isinstance(value, Literally):
        return launch_text(value.value)
    return Computed(merged((value,)))


def not_made(node: FlatNode, why: str) -> Iterator[Diagnostic]:
    """Yield that a target cannot have xacro make the parameters of a node, and why."""
    for setting in made_settings(node).values():
        yield report(
            codes.UNSUPPORTED_BY_TARGET,
            f"xacro makes the value of '{setting.name}' when the system is started, and {why}",
            setting.value_span,
            "start the system with 'deros up', the script or the launch file",
        )
