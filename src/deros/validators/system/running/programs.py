"""Checks of what programs are started with: variables, prefixes, and processes that are not nodes.

They are those of the system's own file; what it computes has its value here.
"""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterator

from deros import codes
from deros.diagnostics import Diagnostic, Related, Span, report
from deros.models.programs import ProcessInstance, Variable, Word
from deros.models.system import System
from deros.names.names import check_node_name
from deros.systems.flat import FlatLaunch, FlatNode, FlatProcess, FlatSystem
from deros.systems.groups import groups_of, members_of, variables_in

_NAME = re.compile(r"[A-Za-z_]\w*", re.ASCII)
_KINDS = {FlatNode: "node", FlatProcess: "process", FlatLaunch: "launch file"}
_DOMAIN = "ROS_DOMAIN_ID"
_GREATEST_DOMAIN = 232
"""With a greater one, the ports of DDS would be beyond 65535 (DDS-I/RTPS 9.6.1)."""


def check_programs(flat: FlatSystem) -> Iterator[Diagnostic]:
    """Yield what programs of the system's own file cannot be started with."""
    for variable in variables_in(flat.system):
        yield from _variable(variable)
    for prefix in _prefixes(flat.system):
        yield from _prefix(prefix)
    for _, group in groups_of(flat.system):
        yield from _set_twice(group.settings.environment)
        for member in members_of(group):
            yield from _set_twice(member.environment)
        for process in group.processes:
            yield from _process(process)
    yield from _called_alike(flat)


def _variable(variable: Variable) -> Iterator[Diagnostic]:
    if not _NAME.fullmatch(variable.name):
        yield report(
            codes.BAD_VARIABLE,
            f"'{variable.name}' cannot be the name of an environment variable",
            variable.name_span,
            "its name has letters of ASCII, digits and '_', and begins with no digit",
        )
    value = variable.value.text
    if variable.name == _DOMAIN and not (
        re.fullmatch(r"\d{1,9}", value, re.ASCII) and int(value) <= _GREATEST_DOMAIN
    ):
        yield report(
            codes.BAD_VARIABLE,
            f'a domain of ROS 2 is a number from 0 to {_GREATEST_DOMAIN}, and this is "{value}"',
            variable.value.span,
            f"write 'env {_DOMAIN} = 7', or another number",
        )


def _prefixes(system: System) -> Iterator[Word]:
    for _, group in groups_of(system):
        for member in members_of(group):
            if member.prefix is not None:
                yield member.prefix


def _prefix(prefix: Word) -> Iterator[Diagnostic]:
    try:
        shlex.split(prefix.text)
    except ValueError as fault:
        yield report(
            codes.UNFIT_COMMAND,
            f"a prefix is taken apart as a shell does it, and this cannot be: {fault}",
            prefix.span,
            "close each quotation; a backslash at the end escapes nothing",
        )


def _set_twice(variables: tuple[Variable, ...]) -> Iterator[Diagnostic]:
    yield from set_twice(
        ((each.name, each.name_span, each.span) for each in variables), "variable", "values"
    )


def set_twice(
    settings: Iterator[tuple[str, Span, Span]], what: str, several: str
) -> Iterator[Diagnostic]:
    """Yield the second of two settings of one name.

    Args:
        settings: each with its name, the place of the name, and its own place.
        what: the settings are, in words.
        several: what two of them would give to one name, in words.
    """
    first: dict[str, Span] = {}
    for name, place, span in settings:
        if first.setdefault(name, span) is not span:
            yield report(
                codes.DUPLICATE_SETTING,
                f"{what} '{name}' is set twice",
                place,
                f"keep one of the two {several}",
                (Related(first[name], "the first one"),),
            )


def _process(process: ProcessInstance) -> Iterator[Diagnostic]:
    fault = check_node_name(process.name)
    if fault is not None:
        message = f"'{process.name}' cannot be the name of a process: it {fault}"
        yield report(codes.INVALID_SYSTEM_NAME, message, process.name_span)
    if not process.program.text.strip():
        yield report(
            codes.UNFIT_COMMAND,
            f"process '{process.name}' has no program: its name is empty",
            process.program.span,
            "write the name of a program in the PATH, or a path",
        )


def _called_alike(flat: FlatSystem) -> Iterator[Diagnostic]:
    """Yield processes and launch files that are called like another member of their subsystem."""
    first: dict[str, tuple[str, Span]] = {}
    for each in flat.programs:
        name = "/".join((*each.path, each.instance.name))
        what = _KINDS[type(each)]
        place = (what, each.instance.name_span)
        kind, span = first.setdefault(name, place)
        is_reported = what == kind and what != "process"  # as nodes, or subsystems, of one name
        if is_reported or (kind, span) == place or place[1].source is not flat.system.source:
            continue
        yield report(
            codes.DUPLICATE_PROCESS,
            f"there is already a {kind} '{each.instance.name}' here: their output could not be"
            " told apart",
            place[1],
            "give one of them another name" + ("" if what != "launch file" else ", with 'as NAME'"),
            (Related(span, "the other one"),),
        )
