"""Checks of existing launch files that a system starts: the file, its arguments, its nodes.

What a launch file in XML or YAML declares is read; of one in Python it is known that it is there.
What a file without ``provides`` starts is not known: a finding that something is missing then names
it as where that may be.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace

from deros import codes
from deros.diagnostics import Diagnostic, Related, report
from deros.models.arguments import LaunchArgument
from deros.models.launch_files import LaunchDocument, LaunchFile
from deros.systems.flat import FlatLaunch, FlatSystem
from deros.validators.findings.hints import did_you_mean, one_of
from deros.validators.findings.named_files import Kind, unusable

_FILE = Kind(
    codes.NO_LAUNCH_FILE,
    codes.UNCHECKED_LAUNCH_FILE,
    codes.BAD_LAUNCH_FILE,
    "the system starts it here",
)
_MAY_BE_THERE = frozenset(
    {
        codes.NO_PUBLISHER,
        codes.NO_SUBSCRIBER,
        codes.UNUSED_TOPIC,
        codes.LIKELY_MISSPELLING,
        codes.SERVICE_WITHOUT_SERVER,
        codes.SIMULATED_TIME,
        codes.GATE_READER_KEEPS_GOING,
    }
)
"""Warnings that a node which is not described may answer."""
_NOT_KNOWN = frozenset(
    {
        codes.NEVER_ACTIVATED,
        codes.UNKNOWN_MANAGER,
        codes.LOAD_OF_UNKNOWN_NODE,
        codes.TRANSFORM_OF_NOBODY,
    }
)
"""Errors that are none where a node which is not described does what is missing."""


def unknown_nodes(flat: FlatSystem) -> list[FlatLaunch]:
    """Return the launch files of which the system does not say what they start."""
    return [each for each in flat.launches if not each.launch.is_described]


def with_unknown_nodes(flat: FlatSystem, findings: Iterable[Diagnostic]) -> Iterator[Diagnostic]:
    """Yield findings about the nodes of a system, which may not be all of them."""
    places = tuple(
        Related(each.launch.path_span, "what this starts is not known: say it with 'provides'")
        for each in unknown_nodes(flat)
    )
    for each in findings:
        if places and each.code in _NOT_KNOWN:
            continue
        if places and each.code in _MAY_BE_THERE:
            yield replace(each, related=(*each.related, *places))
        else:
            yield each


def check_launch_files(flat: FlatSystem) -> Iterator[Diagnostic]:
    """Yield the findings about the launch files that a system starts."""
    for each in flat.launches:
        yield from given_twice(each.launch.arguments)
        found = each.launch.load()
        if isinstance(found, LaunchDocument):
            yield from _arguments(each.launch, found)
            yield from _nodes(each, found)
        else:
            yield from unusable(each.launch.path, each.launch.path_span, found, _FILE)


# Arguments ----------------------------------------------------------------------------------------


def given_twice(arguments: Iterable[LaunchArgument]) -> Iterator[Diagnostic]:
    """Yield the arguments of one name but the first."""
    first: dict[str, LaunchArgument] = {}
    for each in arguments:
        if first.setdefault(each.name, each) is not each:
            yield report(
                codes.DUPLICATE_ARGUMENT,
                f"argument '{each.name}' is given twice",
                each.name_span,
                "keep one of the two values",
                (Related(first[each.name].span, "the first value"),),
            )


def _arguments(launch: LaunchFile, found: LaunchDocument) -> Iterator[Diagnostic]:
    given = {each.name for each in launch.arguments}
    for each in launch.arguments:
        declared = found.arguments.get(each.name)
        if declared is not None:
            if declared.choices and each.value not in declared.choices and not each.is_assumed:
                yield report(
                    codes.UNFIT_LAUNCH_ARGUMENT,
                    f"argument '{each.name}' of '{launch.path}' cannot be \"{each.value}\"",
                    each.value_span,
                    one_of(declared.choices, "its choices"),
                    (Related(declared.span, "declared here"),),
                )
        elif found.is_complete and each.name not in found.used:
            names = list(found.arguments)
            yield report(
                codes.UNFIT_LAUNCH_ARGUMENT,
                f"'{launch.path}' has no argument '{each.name}': nothing in it would use the value",
                each.name_span,
                did_you_mean(each.name, names, one_of(names, "its arguments")) or "remove it",
            )
    for name, declared in found.arguments.items():
        if declared.is_required and name not in given:
            yield report(
                codes.UNFIT_LAUNCH_ARGUMENT,
                f"'{launch.path}' needs a value for its argument '{name}', which has no default",
                launch.path_span,
                f"write '({name} = …)' behind the path",
                (Related(declared.span, "declared here without a default"),),
            )


# Nodes --------------------------------------------------------------------------------------------


def _nodes(launch: FlatLaunch, found: LaunchDocument) -> Iterator[Diagnostic]:
    """Yield the described nodes that a file does not start, if all that it starts is known."""
    if not found.is_complete:
        return
    for node in launch.instance.members:
        if node.name not in found.nodes:
            yield report(
                codes.NOT_IN_LAUNCH_FILE,
                f"'{launch.launch.path}' starts no node called '{node.name}'",
                node.name_span,
                did_you_mean(node.name, found.nodes)
                or one_of(sorted(found.nodes), "its nodes")
                or "remove it: the file starts no node",
                (Related(launch.launch.path_span, "the launch file"),),
            )
