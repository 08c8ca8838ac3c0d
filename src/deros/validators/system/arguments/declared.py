"""Checks of the arguments of a system, and of what is computed from them."""

from __future__ import annotations

import contextlib
import itertools
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace

from deros import codes
from deros.diagnostics import Diagnostic, Related, Span, report
from deros.interfaces.units import UnitRegistry
from deros.models.arguments import (
    Argument,
    Condition,
    Expression,
    Passed,
    arguments_in,
    lookups_in,
    made_in,
)
from deros.models.common import Scalar
from deros.models.launch_files import MadeFile
from deros.models.node import Parameter, as_double
from deros.models.parameter_files import ParameterFile
from deros.models.system import (
    NodeInstance,
    ParameterSetting,
    SafetyInstance,
    Subsystem,
    System,
    Topic,
    Wiring,
)
from deros.names.keywords import NO_ARGUMENT
from deros.names.names import check_identifier
from deros.systems.arguments.assignments import space_of
from deros.systems.arguments.diagrams import TooManyCombinations
from deros.systems.arguments.evaluate import CannotEvaluate, Values, evaluate, holds
from deros.systems.arguments.resolve import resolved
from deros.systems.arguments.scopes import Scope, is_open, typed, usual_values
from deros.systems.arguments.symbolic import inlined_condition
from deros.systems.arguments.varied import parts_of
from deros.systems.arguments.varied_programs import conditions_in, texts_in
from deros.systems.groups import groups_of
from deros.validators.findings.hints import did_you_mean, one_of
from deros.validators.node.constraints import constraint_findings
from deros.validators.node.values import constraint_fault, type_fault
from deros.validators.system.arguments.given import arguments_of, check_given
from deros.validators.system.arguments.made import check_made_files, decided_by_file
from deros.validators.system.arguments.namespaces import (
    check_namespaces,
    in_namespaces,
    namespace_fault,
)
from deros.validators.system.system_names import refused_names

_Holder = System | Subsystem
_Conditional = (
    MadeFile
    | ParameterFile
    | Topic
    | NodeInstance
    | SafetyInstance
    | Subsystem
    | ParameterSetting
    | Wiring
)


def check_arguments(system: System) -> Iterator[Diagnostic]:
    """Yield the findings about the arguments that a system declares, uses and passes on."""
    yield from _declared(system.arguments)
    yield from _defaults(system.arguments)
    yield from check_namespaces(system)
    yield from check_made_files(
        system, [*_expressions(system)], [*_conditions(system)], NO_ARGUMENT
    )
    if not system.is_computed and not system.arguments:
        return
    declared = {each.name: each for each in system.arguments}
    uses = list(_uses(system))
    for use in uses:
        if use.name not in declared:
            yield _unknown(use, declared)
    yield from _looked_up_late(system)
    hidden = {each.name for _, group in groups_of(system) for each in group.made}
    yield from _unused(system.arguments, {each.name for each in uses} | hidden)
    for part in _subsystems(system):
        yield from _passed(part)
    yield from check_given(system)
    if all(use.name in declared for use in uses):
        yield from _idle(system)


def check_values(
    system: System, values: Mapping[str, Scalar], faults: Iterable[CannotEvaluate] | None = None
) -> Iterator[Diagnostic]:
    """Yield what has no value in a system, given those of its arguments, or no fitting one.

    Of the systems that it uses, what is so by the values that they get: the rest is found where
    they are checked themselves.

    Args:
        system: as written.
        values: of some of its arguments.
        faults: of resolving it for these values, if that has been done.
    """
    for fault in resolved(system, values)[1] if faults is None else faults:
        if fault.span.source is system.source:
            yield report(codes.UNFIT_ARGUMENT, fault.message, fault.span)
    scope = Scope(system.arguments).values(values)
    for part in _present(system, scope):
        for passed in part.passed:
            yield from _unfit(part, passed, scope)
        yield from _inside(part, scope, (system,))


def _inside(
    part: Subsystem, values: Values, open_systems: tuple[System, ...]
) -> Iterator[Diagnostic]:
    """Yield what the values that a used system gets make unfit in it, or in what it uses."""
    used = part.system
    if used is None or not used.is_computed or any(used is one for one in open_systems):
        return
    types = {each.name: each.type for each in used.arguments}
    given: dict[str, Scalar] = {}
    for passed in part.passed:
        kind = types.get(passed.name.text)
        with contextlib.suppress(CannotEvaluate):  # which is reported as such
            value = evaluate(passed.value, values)
            if kind is not None and type_fault(kind, as_double(value, kind)) is None:
                given[passed.name.text] = value
    place = Related(part.system_span or part.name_span, "it gets its values here")
    own = {(each.message, each.span) for each in _of_values(used, {})}
    for each in _of_values(used, typed(given, used.arguments)):
        if (each.message, each.span) not in own:
            yield replace(each, related=(*each.related, place))


def _of_values(system: System, values: Mapping[str, Scalar]) -> Iterator[Diagnostic]:
    """Yield what the values of its arguments make unfit in a system: names, too."""
    there, faults = resolved(system, values)
    yield from check_values(system, values, faults)
    yield from refused_names(there)


def _present(part: _Holder, values: Values) -> Iterator[Subsystem]:
    """Yield the subsystems that are there, with those that they contain."""
    for member in part.members:
        if isinstance(member, Subsystem) and _is_there(member, values):
            yield member
            yield from _present(member, values)


def _is_there(part: Subsystem, values: Values) -> bool:
    try:
        return part.when is None or holds(part.when, values)
    except CannotEvaluate:
        return False  # which is reported as such


# Declarations -------------------------------------------------------------------------------------


def _declared(arguments: tuple[Parameter, ...]) -> Iterator[Diagnostic]:
    units = UnitRegistry()
    first: dict[str, Parameter] = {}
    for each in arguments:
        if first.setdefault(each.name, each) is not each:
            yield report(
                codes.DUPLICATE_ARGUMENT,
                f"argument '{each.name}' is declared twice",
                each.name_span,
                "keep one of the two",
                (Related(first[each.name].name_span, "the first one"),),
            )
        yield from _declaration(each, units)


def _declaration(argument: Parameter, units: UnitRegistry) -> Iterator[Diagnostic]:
    what = f"argument '{argument.name}'"
    fault = check_identifier(argument.name)
    if argument.name in NO_ARGUMENT:
        fault = "is a word of conditions, or of Python, in which scripts are written"
    if fault is not None:
        message = f"'{argument.name}' cannot be the name of an argument: it {fault}"
        yield report(codes.INVALID_SYSTEM_NAME, message, argument.name_span)
    if argument.type.is_array:
        yield report(
            codes.UNFIT_ARGUMENT,
            f"{what} is {argument.type.value}: an argument has one value, which is given as text",
            argument.span,
            "declare an argument for each element, and write 'param x = [$a, $b]'",
        )
        return
    for fault, is_given in (
        ("'custom' is for parameters: the system cannot call the function", argument.custom),
        ("'read_only' is for parameters: an argument is given once", argument.read_only),
    ):
        if is_given:
            yield report(codes.UNFIT_ARGUMENT, f"{what}: {fault}", argument.span, "remove it")
    yield from constraint_findings(argument, units)
    if argument.default is not None:
        span = argument.default_span or argument.span
        refused = type_fault(argument.type, argument.default)
        refused = refused or constraint_fault(argument, argument.default)
        if refused is not None:
            yield report(codes.UNFIT_ARGUMENT, f"default of {what}: {refused}", span)


def _defaults(arguments: tuple[Parameter, ...]) -> Iterator[Diagnostic]:
    """Yield what is wrong with defaults that are computed."""
    declared = {each.name for each in arguments}
    before: set[str] = set()
    values = usual_values(arguments)
    for each in arguments:
        found = each.default_from
        if found is not None:
            late = [use for use in arguments_in(found) if use.name not in before]
            for use in late:
                if use.name in declared:  # others are reported as unknown
                    yield report(
                        codes.UNKNOWN_ARGUMENT,
                        f"the default of '{each.name}' uses '{use.name}', which is not known yet",
                        use.span,
                        f"declare '{use.name}' before '{each.name}'",
                    )
            if not late:
                yield from _unfit_default(each, found, values)
        before.add(each.name)


def _unfit_default(argument: Parameter, found: Expression, values: Values) -> Iterator[Diagnostic]:
    if is_open(argument, values):
        return  # whoever starts the system is told
    try:
        value = as_double(evaluate(found, values), argument.type)
    except CannotEvaluate as fault:
        yield report(codes.UNFIT_ARGUMENT, fault.message, fault.span)
        return
    refused = type_fault(argument.type, value) or constraint_fault(argument, value)
    if refused is not None:
        message = f"default of argument '{argument.name}': {refused}"
        yield report(codes.UNFIT_ARGUMENT, message, found.span)


def _looked_up_late(system: System) -> Iterator[Diagnostic]:
    """Yield what conditions of used systems depend on, but no combination of arguments shows."""
    seen: set[Span] = set()
    for part in parts_of(system):
        for scope, condition in (*part.present, *part.inner):
            try:
                found = inlined_condition(condition, scope)
            except CannotEvaluate:
                continue  # which is reported as such
            for each in () if isinstance(found, bool) else lookups_in(found):
                if each.made is not None and each.span not in seen:
                    seen.add(each.span)
                    yield from decided_by_file(each, condition)
                elif each.span not in seen:
                    seen.add(each.span)
                    yield report(
                        codes.UNFIT_ARGUMENT,
                        "a condition depends on this, which is known only when the system is"
                        " started",
                        each.span,
                        f"make it the default of an argument of '{system.name}', and pass that on:"
                        " then every value is checked",
                        (Related(condition.span, "the condition"),),
                    )


def _unused(arguments: Iterable[Parameter], used: set[str]) -> Iterator[Diagnostic]:
    for each in arguments:
        if each.name not in used:
            yield report(
                codes.UNUSED_ARGUMENT,
                f"argument '{each.name}' is not used",
                each.name_span,
                f"use it as '${each.name}' or in a condition, or remove it",
            )


# Uses ---------------------------------------------------------------------------------------------


def _unknown(use: Argument, declared: Mapping[str, Parameter]) -> Diagnostic:
    return report(
        codes.UNKNOWN_ARGUMENT,
        f"the system declares no argument '{use.name}'",
        use.span,
        did_you_mean(use.name, declared, one_of(declared, "its arguments"))
        or f"declare it: 'argument {use.name} : string'",
    )


def _members(part: _Holder) -> Iterator[NodeInstance | SafetyInstance]:
    yield from part.safety
    for member in part.members:
        if isinstance(member, Subsystem):
            yield from _members(member)
        else:
            yield member


def _subsystems(system: System) -> Iterator[Subsystem]:
    return (group for _, group in groups_of(system) if isinstance(group, Subsystem))


def _uses(system: System) -> Iterator[Argument]:
    """Yield every use of an argument in the system's own file."""
    for found in itertools.chain(_expressions(system), _conditions(system)):
        yield from arguments_in(found)


def _expressions(system: System) -> Iterator[Expression]:
    for _, holder in groups_of(system):
        yield from (each.name_from for each in holder.topics if each.name_from is not None)
        yield from (text for each in holder.files for text in each.computed)
        yield from (text for each in holder.made for text in each.xacro.computed)
    for argument in system.arguments:
        if argument.default_from is not None:
            yield argument.default_from
    for part in _subsystems(system):
        yield from (each.value for each in part.passed)
        yield from () if part.launch is None else part.launch.computed
    for member in (*_subsystems(system), *_members(system)):
        if member.namespace_from is not None:
            yield member.namespace_from
    for member in _members(system):
        yield from (each for setting in member.parameters for each in setting.computed)
        yield from (each.target_from for each in member.wirings if each.target_from is not None)
        yield from (text for each in member.files for text in each.computed)
    yield from texts_in(system)


def _conditions(system: System) -> Iterator[Condition]:
    parts: list[_Conditional] = [*_subsystems(system)]
    for _, holder in groups_of(system):
        parts += [*holder.topics, *holder.files, *holder.made]
    for member in _members(system):
        parts += [member, *member.files, *member.parameters, *member.wirings]
    own = (each.when for each in parts if each.when is not None)
    return itertools.chain(own, conditions_in(system))


def _idle(system: System) -> Iterator[Diagnostic]:
    """Yield the conditions that hold for all values of the arguments, or for none."""
    scope = Scope(system.arguments)
    for condition in _conditions(system):
        if any(made_in(condition)):
            continue  # which is reported as such
        used = {each.name for each in arguments_in(condition)}
        space = space_of(system.arguments, used, [(scope, condition)])
        try:
            mask = space.where(condition, scope)
        except (CannotEvaluate, TooManyCombinations):
            continue  # which is reported as such
        if mask not in (space.nothing, space.everything):
            continue
        when = "whatever the arguments are" if mask else "for no value of the arguments"
        yield report(
            codes.IDLE_CONDITION,
            f"this condition holds {when}",
            condition.span,
            "remove it" if mask else "correct it, or remove what it is written for",
        )


# What is passed to a system -----------------------------------------------------------------------


def _passed(part: Subsystem) -> Iterator[Diagnostic]:
    used = part.system
    if used is None:
        if part.passed and part.system_name is None:
            message = f"subsystem '{part.name}' uses no system that could have arguments"
            yield report(codes.UNKNOWN_ARGUMENT, message, part.passed[0].name.span)
        return
    declared = {each.name: each for each in used.arguments}
    first: dict[str, Passed] = {}
    for each in part.passed:
        name = each.name.text
        if name not in declared:
            yield report(
                codes.UNKNOWN_ARGUMENT,
                f"system '{used.name}' has no argument '{name}'",
                each.name.span,
                did_you_mean(name, declared, one_of(declared, "its arguments")),
                (Related(used.name_span, "the system"),),
            )
        elif first.setdefault(name, each) is not each:
            yield report(
                codes.DUPLICATE_ARGUMENT,
                f"argument '{name}' is given twice",
                each.name.span,
                "keep one of the two values",
                (Related(first[name].span, "the first value"),),
            )
    for argument in used.arguments:
        if not argument.has_default and argument.name not in first:
            yield report(
                codes.MISSING_ARGUMENT,
                f"subsystem '{part.name}' gives no value to argument '{argument.name}' of"
                f" '{used.name}', which has no default",
                part.system_span or part.name_span,
                f"write '{part.name} : {used.name}({argument.name} = …)'",
                (Related(argument.name_span, "declared here without a default"),),
            )


def _unfit(part: Subsystem, passed: Passed, values: Values) -> Iterator[Diagnostic]:
    declared = next((a for a in arguments_of(part) if a.name == passed.name.text), None)
    if declared is None:
        return
    try:
        value = as_double(evaluate(passed.value, values), declared.type)
    except CannotEvaluate:
        return  # which is reported as such
    fault = type_fault(declared.type, value) or constraint_fault(declared, value)
    if fault is None and part.system is not None and declared.name in in_namespaces(part.system):
        fault = namespace_fault(value)
    if fault is not None:
        yield report(
            codes.UNFIT_ARGUMENT,
            f"argument '{declared.name}' of '{part.system_name}': {fault}",
            passed.value.span,
            related=(Related(declared.name_span, "declared here"),),
        )
