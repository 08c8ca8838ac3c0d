"""The view of parameters whose values xacro makes when a system is started."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from deros import codes
from deros.diagnostics import Diagnostic, report
from deros.generators.system.computed import Text
from deros.generators.system.files import FileView, file_view
from deros.models.system import ParameterSetting, System
from deros.systems.arguments.symbolic import as_written
from deros.systems.flat import FlatNode


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


def not_made(node: FlatNode, why: str) -> Iterator[Diagnostic]:
    """Yield that a target cannot have xacro make the parameters of a node, and why."""
    for setting in made_settings(node).values():
        yield report(
            codes.UNSUPPORTED_BY_TARGET,
            f"xacro makes the value of '{setting.name}' when the system is started, and {why}",
            setting.value_span,
            "start the system with 'deros up', the script or the launch file",
        )
