"""Checks of the files that a system has made, and of where their paths are used."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace

from deros import codes
from deros.diagnostics import Diagnostic, Related, Span, report
from deros.models.arguments import Condition, Expression, Lookup, made_in
from deros.models.launch_files import MadeFile
from deros.models.node import Parameter
from deros.models.programs import ProcessInstance
from deros.models.system import System
from deros.names.names import check_identifier
from deros.systems.arguments.varied_programs import into_of, remappings_of
from deros.systems.groups import groups_of, members_of

_NAME = "no name in the ROS graph holds the path of a file"
_PATH = "what is read to check the system has to be there before anything is made"
_CONDITION = "what is started is decided before anything is made"
_DEFAULT = "arguments have their values before anything is made"
_ADDRESS = "an address is asked for before anything is made"
_MADE = "of the files that are made, none is there before another one"


def check_made_files(
    system: System,
    expressions: Iterable[Expression],
    conditions: Sequence[Condition],
    taken: Iterable[str],
) -> Iterator[Diagnostic]:
    """Yield what is wrong with the names of made files, and with the places where they are used.

    Args:
        system: as written.
        expressions: of its own file.
        conditions: of its own file.
        taken: words that are not names.
    """
    files = [each for _, group in groups_of(system) for each in group.made]
    if not files:
        return
    yield from _names(files, {each.name: each for each in system.arguments}, set(taken))
    used = {use.name for found in (*expressions, *conditions) for use in made_in(found)}
    for each in files:
        if each.name not in used:
            message = f"file '{each.name}' is not used, so it is not made"
            hint = f"use its path as '${each.name}', or remove it"
            yield report(codes.UNUSED_ARGUMENT, message, each.name_span, hint)
    reported: set[Span] = set()
    refused = [*_refused(system, files), *((each, _CONDITION) for each in conditions)]
    for expression, why in refused:
        for use in made_in(expression):
            if use.span not in reported:
                reported.add(use.span)
                yield _misplaced(use, why)


def decided_by_file(use: Lookup, condition: Condition) -> Iterator[Diagnostic]:
    """Yield that a condition of a used system depends on the path of a file that is made.

    Where it is the file's own system, :func:`check_made_files` reports it.
    """
    if use.span.source is not condition.span.source:
        place = Related(condition.span, "the condition")
        yield replace(_misplaced(use, _CONDITION), related=(place,))


def _misplaced(use: Lookup, why: str) -> Diagnostic:
    return report(
        codes.UNFIT_MADE_FILE,
        f"the path of file '{use.name}' cannot stand here: {why}",
        use.span,
        "use it in arguments and variables of programs, in parameters, and in what launch files and"
        " used systems are given",
    )


def _names(
    files: Iterable[MadeFile], arguments: Mapping[str, Parameter], taken: set[str]
) -> Iterator[Diagnostic]:
    first: dict[str, MadeFile] = {}
    for each in files:
        fault = check_identifier(each.name)
        if each.name in taken:
            fault = "is a word of conditions, or of Python, in which scripts are written"
        if fault is not None:
            message = f"'{each.name}' cannot be the name of a file: it {fault}"
            yield report(codes.INVALID_SYSTEM_NAME, message, each.name_span)
        other: MadeFile | Parameter | None = arguments.get(each.name)
        if other is None and first.setdefault(each.name, each) is not each:
            other = first[each.name]
        if other is not None:
            yield report(
                codes.UNFIT_MADE_FILE,
                f"'${each.name}' would be two things: the path of this file, and another value",
                each.name_span,
                "rename one of the two",
                (Related(other.name_span, "the other one"),),
            )


def _refused(system: System, files: Iterable[MadeFile]) -> Iterator[tuple[Expression, str]]:
    """Yield the expressions of a system in which no made file is known, and why."""
    for argument in system.arguments:
        yield from _if_any(_DEFAULT, argument.default_from)
    yield from _if_any(_ADDRESS, *(text for each in system.hosts for text in each.computed))
    for made in files:
        yield from ((each, _MADE) for each in made.xacro.computed)
    for _, group in groups_of(system):
        yield from _if_any(_NAME, *(each.name_from for each in group.topics))
        yield from ((e, _NAME) for each in group.settings.remappings for e in each.computed)
        yield from ((text, _PATH) for each in group.files for text in each.computed)
        for setting in group.settings.parameters:
            yield from _if_any(_PATH, None if setting.xacro is None else setting.xacro.path_from)
        if not isinstance(group, System):
            yield from _if_any(_NAME, group.namespace_from)
            yield from _if_any(_PATH, None if group.launch is None else group.launch.path_from)
        for member in members_of(group):
            yield from _if_any(_NAME, *(each.container_from for each in into_of(member)))
            yield from ((e, _NAME) for each in remappings_of(member) for e in each.computed)
            if isinstance(member, ProcessInstance):
                continue
            yield from _if_any(_NAME, member.namespace_from)
            yield from _if_any(_NAME, *(each.target_from for each in member.wirings))
            yield from ((text, _PATH) for each in member.files for text in each.computed)
            for setting in member.parameters:
                yield from _if_any(
                    _PATH, None if setting.xacro is None else setting.xacro.path_from
                )


def _if_any(why: str, *found: Expression | None) -> Iterator[tuple[Expression, str]]:
    return ((each, why) for each in found if each is not None)
