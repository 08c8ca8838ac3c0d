"""Arguments of which namespaces are made: their values are relative namespaces.

What is given when the system is started is refused there, by the same rule.
"""

from __future__ import annotations

from collections.abc import Iterator

from deros import codes
from deros.diagnostics import Diagnostic, report
from deros.models.arguments import Expression, arguments_in
from deros.models.system import NodeInstance, SafetyInstance, Subsystem, System
from deros.names.names import check_namespace
from deros.systems.arguments.scopes import is_open, usual_values
from deros.systems.groups import groups_of, members_of


def check_namespaces(system: System) -> Iterator[Diagnostic]:
    """Yield the defaults and choices that cannot be in the namespaces that are made of them."""
    made_of = in_namespaces(system)
    usual = usual_values(system.arguments) if made_of else {}
    for each in system.arguments:
        if each.name not in made_of:
            continue
        what, default = f"argument '{each.name}'", usual[each.name]
        fault = namespace_fault(default)
        if fault is not None and each.has_default and not is_open(each, usual):
            span = each.default_span or each.span
            yield report(codes.UNFIT_ARGUMENT, f"default of {what}: {fault}", span)
        for choice in each.choices or ():
            fault = namespace_fault(choice)
            if choice == "":
                fault = "an empty namespace may be chosen only where it is the default"
            if fault is not None and choice != default:
                yield report(codes.UNFIT_ARGUMENT, f"a choice of {what}: {fault}", each.span)


def namespace_fault(value: object) -> str | None:
    """Return why a value cannot be in a namespace; an empty text leaves the one around it."""
    if not isinstance(value, str) or not value:
        return None
    if value.startswith("/") or check_namespace(f"n{value}") is not None:
        return f"'{value}' is not a relative namespace such as front or arm/left"
    return None


def in_namespaces(system: System) -> set[str]:
    """Return the arguments of a system of which namespaces are made, in it and in what it uses."""
    return _in_namespaces(system, ())


def _in_namespaces(system: System, open_systems: tuple[System, ...]) -> set[str]:
    if not system.arguments or any(system is each for each in open_systems):
        return set()
    found: list[Expression] = []
    for _, group in groups_of(system):
        members = (e for e in members_of(group) if isinstance(e, NodeInstance | SafetyInstance))
        parts = (group, *members) if isinstance(group, Subsystem) else members
        found += (each.namespace_from for each in parts if each.namespace_from is not None)
        if isinstance(group, Subsystem) and group.system is not None:
            found += _passed_into_namespaces(group, group.system, (*open_systems, system))
    return {use.name for each in found for use in arguments_in(each)}


def _passed_into_namespaces(
    part: Subsystem, used: System, open_systems: tuple[System, ...]
) -> Iterator[Expression]:
    wanted = _in_namespaces(used, open_systems)
    passed = {each.name.text for each in part.passed}
    for each in reversed(used.arguments):  # a default uses those before it
        if each.name in wanted - passed and each.default_from is not None:
            wanted |= {use.name for use in arguments_in(each.default_from)}
    yield from (each.value for each in part.passed if each.name.text in wanted)
