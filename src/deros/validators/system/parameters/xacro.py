"""Checks of parameters whose values xacro makes of files: the file, and the arguments it gets."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from deros import codes
from deros.diagnostics import Diagnostic, Related, Span, report
from deros.models.launch_files import LaunchArgument, XacroDocument, XacroFile
from deros.models.node import NodeType, Parameter, ParameterType
from deros.models.parameter_files import Fault, Missing, NotInstalled
from deros.models.system import ParameterSetting
from deros.systems.flat import FlatSystem
from deros.validators.findings.hints import did_you_mean, one_of
from deros.validators.system.running.launch_files import alike


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
    for each in settings:
        if each.xacro is None or each.xacro.path_span in seen:
            continue
        seen.add(each.xacro.path_span)
        yield from _given_twice(each.xacro)
        found = each.xacro.load()
        if isinstance(found, XacroDocument):
            yield from _arguments(each.xacro, found)
        else:
            yield from _unusable(each.xacro, found)


def _unusable(
    xacro: XacroFile, found: Missing | NotInstalled | Fault | None
) -> Iterator[Diagnostic]:
    match found:
        case Missing(path, reason):
            message = reason or f"there is no file '{xacro.path}'"
            hint = "" if reason else alike(Path(path))
            yield report(codes.NO_XACRO_FILE, message, xacro.path_span, hint)
        case NotInstalled(package):
            yield report(
                codes.UNCHECKED_LAUNCH_FILE,
                f"'{xacro.path}' has not been checked: package '{package}' is not installed here",
                xacro.path_span,
                "check the system where AMENT_PREFIX_PATH names its install space",
            )
        case Fault(message, span, hint):
            place = Related(xacro.path_span, "xacro is to read it here")
            yield report(codes.UNFIT_XACRO, message, span, hint, (place,))


def _given_twice(xacro: XacroFile) -> Iterator[Diagnostic]:
    first: dict[str, LaunchArgument] = {}
    for each in xacro.arguments:
        if first.setdefault(each.name, each) is not each:
            yield report(
                codes.DUPLICATE_ARGUMENT,
                f"argument '{each.name}' is given twice",
                each.name_span,
                "keep one of the two values",
                (Related(first[each.name].span, "the first value"),),
            )


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
