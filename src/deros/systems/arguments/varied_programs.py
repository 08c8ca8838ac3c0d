"""What varies with the arguments in the settings of groups, and in what programs start with."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, replace

from deros.models.arguments import Condition, Expression
from deros.models.composition import Into, IntraProcess, OtherType
from deros.models.programs import ProcessInstance, Remapping, Respawn, Variable, Word, words_of
from deros.models.system import (
    GroupSettings,
    NodeInstance,
    ParameterSetting,
    SafetyInstance,
    Subsystem,
    System,
)
from deros.systems.arguments.scopes import Scope
from deros.systems.groups import (
    Member,
    groups_of,
    has_parameter,
    members_of,
    not_covered,
    settled_parameters,
    settled_variables,
)


@dataclass(frozen=True, slots=True)
class Level:
    """The settings of a group around a member, and the arguments that they use."""

    scope: Scope
    settings: GroupSettings


def own_words(member: Member) -> tuple[Word, ...]:
    """Return the texts that the program of a member is started with."""
    if isinstance(member, ProcessInstance):
        return member.words
    arguments = member.arguments if isinstance(member, NodeInstance) else ()
    return words_of(arguments, member.environment, member.prefix)


def plain_words(member: Member) -> tuple[Word, ...]:
    """Return those texts that say nothing to other programs: all but the values of variables."""
    return own_words(replace(member, environment=()))


def into_of(member: Member) -> tuple[Into, ...]:
    """Return where a member is loaded, if it says so."""
    into = member.into if isinstance(member, NodeInstance) else None
    return () if into is None else (into,)


def awaited_name_of(member: Member) -> tuple[Expression, ...]:
    """Return what the name in the ROS graph that a member waits for is computed from, if it is."""
    starting = None if isinstance(member, SafetyInstance) else member.starting
    ready = None if starting is None else starting.ready
    return () if ready is None or ready.name_from is None else (ready.name_from,)


def remappings_of(member: Member) -> tuple[Remapping, ...]:
    """Return the remappings of a member's own."""
    return member.remappings if isinstance(member, NodeInstance) else ()


def switches_of(member: Member) -> Iterator[Condition]:
    """Yield the conditions of words, and of elements of lists, that count where these hold."""
    parts: list[Respawn | IntraProcess | OtherType | None] = [member.respawn]
    if isinstance(member, NodeInstance):
        parts += [member.intra_process, member.other_type]
    yield from (each.when for each in parts if each is not None and each.when is not None)
    if isinstance(member, NodeInstance | ProcessInstance):
        yield from (each.when for each in member.arguments if each.when is not None)
    if not isinstance(member, ProcessInstance):
        yield from (found for each in member.parameters for found in each.switches)


def texts_in(system: System) -> Iterator[Expression]:
    """Yield what a system's own file computes for programs, and in settings of its groups."""
    yield from (text for each in system.hosts for text in each.computed)
    for _, group in groups_of(system):
        settings = group.settings
        found: list[_Setting] = [*settings.environment, *settings.parameters]
        for each in (*found, *settings.remappings):
            yield from _values(each)
        for member in members_of(group):
            texts = (word.text_from for word in own_words(member))
            yield from (each for each in texts if each is not None)
            yield from (found for each in remappings_of(member) for found in each.computed)
            containers = (each.container_from for each in into_of(member))
            yield from (each for each in containers if each is not None)
            yield from awaited_name_of(member)


def conditions_in(system: System) -> Iterator[Condition]:
    """Yield the conditions of processes, containers and settings of groups in its own file."""
    for _, group in groups_of(system):
        settings = group.settings
        parts: list[_Setting | ProcessInstance | Into]
        parts = [*group.processes, *settings.environment]
        parts += (*settings.parameters, *settings.remappings)
        for member in members_of(group):
            parts += (*into_of(member), *remappings_of(member))
            yield from switches_of(member)
        yield from (found for each in settings.parameters for found in each.switches)
        yield from (each.when for each in parts if each.when is not None)


_Uses = tuple[tuple[tuple[Scope, Condition], ...], tuple[tuple[Scope, Expression], ...]]


def group_parts(member: Member | Subsystem, levels: Sequence[Level]) -> _Uses:
    """Return the conditions and the expressions of groups that a member may depend on.

    Args:
        member: in the groups; of a subsystem, there are none: what is in it has them, but for a
            launch file, to which all of them are passed on.
        levels: the groups around it, the innermost first.
    """
    if all(each.settings == GroupSettings() for each in levels):
        return (), ()
    if isinstance(member, Subsystem) and member.launch is None:
        return (), ()
    found = [(levels[number].scope, each) for number, each in _settings(member, levels)]
    conditions = [(scope, each.when) for scope, each in found if each.when is not None]
    lists = ((scope, each) for scope, each in found if isinstance(each, ParameterSetting))
    conditions += ((scope, when) for scope, each in lists for when in each.switches)
    together = ((scope, each) for scope, each in found if not _is_made_by_xacro(each))
    values = ((scope, value) for scope, each in together for value in _values(each))
    return tuple(conditions), tuple(values)


_Setting = Variable | ParameterSetting | Remapping


def _is_made_by_xacro(setting: _Setting) -> bool:
    return isinstance(setting, ParameterSetting) and setting.xacro is not None


def _settings(
    member: Member | Subsystem, levels: Sequence[Level]
) -> Iterator[tuple[int, _Setting]]:
    groups = [each.settings for each in levels]
    if isinstance(member, Subsystem):
        yield from not_covered((), [each.environment for each in groups])
        yield from _remappings([each.remappings for each in groups])
        yield from not_covered((), [each.parameters for each in groups])
        return
    own = settled_variables(member.environment)
    yield from not_covered(own, [each.environment for each in groups])
    if isinstance(member, ProcessInstance):
        return
    own_names = {e.name for e in remappings_of(member) if e.when is None and e.name_from is None}
    yield from _remappings([each.remappings for each in groups], own_names)
    node_type = member.type if isinstance(member, NodeInstance) else None
    parameters = [each.parameters for each in groups]
    for number, each in not_covered(settled_parameters(member), parameters):
        if node_type is None or has_parameter(node_type, each.name):
            yield number, each


def _remappings(
    levels: Sequence[Sequence[Remapping]], settled: Collection[str] = ()
) -> Iterator[tuple[int, Remapping]]:
    """Yield what may count; which of those with a computed name do is not known yet."""
    named = [[each for each in level if each.name_from is None] for level in levels]
    yield from not_covered(settled, named)
    for number, level in enumerate(levels):
        yield from ((number, each) for each in level if each.name_from is not None)


def _values(setting: _Setting) -> Iterator[Expression]:
    if isinstance(setting, ParameterSetting | Remapping):
        yield from setting.computed
    elif setting.value.text_from is not None:
        yield setting.value.text_from
