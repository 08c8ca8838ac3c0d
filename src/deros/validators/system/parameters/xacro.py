"""Checks of parameters whose values xacro makes of files: the file, and the arguments it gets."""

from __future__ import annotations

from collections.abc import Iterator

from deros import codes
from deros.diagnostics import Diagnostic, Related, Span, report
from deros.models.launch_files import XacroDocument, XacroFile
from deros.models.node import NodeType, Parameter, ParameterType
from deros.models.system import ParameterSetting
from deros.systems.flat import FlatSystem
from deros.validators.findings.hints import did_you_mean, one_of
from deros.validators.findings.named_files import Kind, unusable
from deros.validators.system.running.launch_files import given_twice

_FILE = Kind(
    codes.NO_XACRO_FILE,
    codes.UNCHECKED_LAUNCH_FILE,
    codes.UNFIT_XACRO,
    "xacro is to read it here",
)


def unfit_made(
    node_type: NodeType, parameter: Parameter, setting: ParameterSetting
) -> Iterator[Diagnostic]:
    """Yield why a parameter cannot have a text that xacro makes."""
    place = (Related(parameter.span, "declared here"),)
    if parameter.type is not ParameterType.STRING:
        yield report(
            codes.UNFIT_XACRO,
            f"parameter '{setting.name}' is {parameter.type.value}, and xacro makes a text",
            setting.value_span,
            "write a value, or declare the parameter as string",
            place,
        )
    elif any(port.via == parameter.name for port in node_type.ports):
        yield report(
            codes.UNFIT_XACRO,
            f"parameter '{setting.name}' holds the name of a topic, and xacro makes a document",
            setting.value_span,
            "connect the port, or write the name",
            place,
        )


def check_xacro(flat: FlatSystem) -> Iterator[Diagnostic]:
    """Yield the findings about the files for xacro that a system names."""
    seen: set[Span] = set()
    settings = [each for node in flat.nodes for each in node.instance.parameters]
    settings += (each for launch in flat.launches for each in launch.parameters)
    for each in (*(s.xacro for s in settings), *(made.xacro for made in flat.made)):
        if each is None or each.path_span in seen:
            continue
        seen.add(each.path_span)
        yield from given_twice(each.arguments)
        found = each.load()
        if isinstance(found, XacroDocument):
            yield from _arguments(each, found)
        else:
            yield from unusable(each.path, each.path_span, found, _FILE)


def _arguments(xacro: XacroFile, found: XacroDocument) -> Iterator[Diagnostic]:
    """Yield arguments that a file does not look at, or lacks; of one not known whole, none."""
    if not found.is_complete:
        return
    names = list(found.arguments)
    for each in xacro.arguments:
        if each.name not in found.arguments and each.name not in found.used:
            yield report(
                codes.UNFIT_XACRO,
                f"'{xacro.path}' has no argument '{each.name}': nothing in it would use the value",
                each.name_span,
                did_you_mean(each.name, names, one_of(names, "its arguments")) or "remove it",
            )
    given = {each.name for each in xacro.arguments}
    for name, span in found.needed.items():
        if name not in given and name not in found.arguments:
            yield report(
                codes.UNFIT_XACRO,
                f"'{xacro.path}' needs a value for its argument '{name}', which has no default",
                xacro.path_span,
                f"write '({name} = …)' behind the path",
                (Related(span, "used here"),),
            )
