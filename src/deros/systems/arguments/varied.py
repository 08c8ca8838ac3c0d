"""The parts of a system that vary with its arguments, and what each depends on."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

from deros.diagnostics import Span
from deros.models.arguments import Condition, Expression, arguments_in
from deros.models.composition import Into
from deros.models.launch_files import MadeFile
from deros.models.parameter_files import ParameterFile
from deros.models.programs import ProcessInstance, Remapping, Variable
from deros.models.system import (
    NodeInstance,
    ParameterSetting,
    SafetyInstance,
    Subsystem,
    System,
    Topic,
    Wiring,
)
from deros.systems.arguments.assignments import Space, space_of
from deros.systems.arguments.scopes import Scope
from deros.systems.arguments.told_apart import choices_in
from deros.systems.arguments.varied_programs import (
    Level,
    awaited_name_of,
    group_parts,
    into_of,
    own_words,
    remappings_of,
    switches_of,
)
from deros.systems.flat import FlatLaunch, FlatNode, FlatProcess

Place = tuple[tuple[str, ...], Span]
"""By which a part as written and its flat counterpart are known as one: path, and a name's span."""


@dataclass(frozen=True, slots=True)
class Part:
    """A topic, node, process, statement or setting of a group, with all that decides it.

    Attributes:
        place: by which its flat counterpart is known: the path, and the span of its name.
        present: the conditions of it and of what holds it.
        inner: the conditions of its settings and connections.
        computed: what its names and values are computed from.
        owners: the places of the programs in whose processes it is, if it is a node of such.
        is_container: whether nodes may be loaded into it.
        is_loaded: whether it may be loaded into a container, by whatever name.
    """

    place: Place
    present: tuple[tuple[Scope, Condition], ...]
    inner: tuple[tuple[Scope, Condition], ...] = ()
    computed: tuple[tuple[Scope, Expression], ...] = ()
    owners: tuple[Place, ...] = ()
    is_container: bool = False
    is_loaded: bool = False

    @property
    def arguments(self) -> set[str]:
        """The arguments of the outermost system that it depends on."""
        return _origins((*self.present, *self.inner, *self.computed))


def _origins(uses: Iterable[tuple[Scope, Expression | Condition]]) -> set[str]:
    return {
        name
        for scope, found in uses
        for name in scope.origins(each.name for each in arguments_in(found))
    }


def place_of(node: FlatNode | FlatProcess | FlatLaunch) -> Place:
    """Return by which a flat program and the part that it is made of are known as one."""
    if not isinstance(node, FlatNode):
        return node.path, node.instance.name_span
    if node.statement is not None:
        return node.path, node.statement.path_span
    return node.path, node.instance.name_span


@dataclass(frozen=True, slots=True)
class Varied:
    """The parts of a system and of all that it uses, and the combinations of its arguments."""

    parts: Sequence[Part]
    space: Space


def varied(system: System) -> Varied:
    """Return the parts of a system that is used with any values of its arguments."""
    parts = with_processes(parts_of(system))
    conditions = [each for part in parts for each in (*part.present, *part.inner)]
    computed = (each for part in parts for each in part.computed)
    conditions += (each for scope, found in computed for each in choices_in(scope, found))
    used = {name for part in parts for name in part.arguments}
    return Varied(parts, space_of(system.arguments, used, conditions))


def with_processes(found: Iterable[Part]) -> tuple[Part, ...]:
    """Return parts, those of one process with all that decides about any of them.

    A program is started with what is said about all nodes in its process, and these read its files.
    """
    parts = tuple(found)
    if not any(part.owners for part in parts):
        return parts
    by_place = {part.place: part for part in parts}
    containers = [part.place for part in parts if part.is_container]
    groups: dict[Place, list[Place]] = {}
    for part in parts:
        for place in part.owners:
            _link(groups, part.place, place)
            if place in by_place and by_place[place].is_loaded:
                # Which container it is decides only the name; to look at all is never wrong.
                for container in containers:
                    _link(groups, place, container)
    made: dict[Place, Part] = {}
    for group in {id(each): each for each in groups.values()}.values():
        joined = _joined(by_place[place] for place in group if place in by_place)
        made |= {part.place: part for part in joined}
    return tuple(made.get(part.place, part) for part in parts)


def _link(groups: dict[Place, list[Place]], one: Place, other: Place) -> None:
    """Put two places into one group."""
    large, small = groups.setdefault(one, [one]), groups.setdefault(other, [other])
    if large is small:
        return
    if len(large) < len(small):
        large, small = small, large
    large += small
    groups.update(dict.fromkeys(small, large))


def _joined(group: Iterable[Part]) -> Iterator[Part]:
    """Yield the parts of one process with all that decides about any of them."""
    parts = sorted(group, key=lambda part: part.place[1].start)
    presence = (each for part in parts if part.owners or part.is_loaded for each in part.present)
    settings = (each for part in parts for each in part.inner)
    inner = tuple(dict.fromkeys((*presence, *settings)))
    computed = tuple(dict.fromkeys(each for part in parts for each in part.computed))
    for part in parts:
        yield replace(part, inner=inner, computed=computed)


def parts_of(system: System) -> Iterator[Part]:
    """Yield the parts of a system and of all that it uses."""
    yield from _parts(system, _Holder(Scope(system.arguments), (), (), (), (), (system,)))


@dataclass(frozen=True, slots=True)
class _Holder:
    """What decides about everything in a system or a subsystem."""

    scope: Scope
    path: tuple[str, ...]
    present: tuple[tuple[Scope, Condition], ...]
    computed: tuple[tuple[Scope, Expression], ...]
    levels: tuple[Level, ...]
    open_systems: tuple[System, ...]
    optional: tuple[tuple[Scope, Condition], ...] = ()
    """The conditions of the parameter files of all nodes in it."""
    paths: tuple[tuple[Scope, Expression], ...] = ()
    """What the paths of these files are computed from."""

    def with_files(self, files: tuple[ParameterFile, ...]) -> _Holder:
        """Return it with the files of a system or a subsystem."""
        optional = itertools.chain(*(_condition(each, self.scope) for each in files))
        paths = _scoped((text for each in files for text in each.computed), self.scope)
        return replace(self, optional=(*self.optional, *optional), paths=(*self.paths, *paths))


_Conditional = (
    ParameterFile
    | MadeFile
    | Topic
    | NodeInstance
    | SafetyInstance
    | ProcessInstance
    | Subsystem
    | ParameterSetting
    | Wiring
    | Variable
    | Into
    | Remapping
)


def _parts(part: System | Subsystem, holder: _Holder) -> Iterator[Part]:
    holder = holder.with_files(part.files)
    scope = holder.scope
    for topic in part.topics:
        present = (*holder.present, *_condition(topic, scope))
        named = (*holder.computed, *_scoped((topic.name_from,), scope))
        yield Part((holder.path, topic.name_span), present, (), named)
    for setting in part.settings.parameters:
        if setting.when is not None:  # whether any node below has it is to be seen
            yield Part((holder.path, setting.name_span), (*holder.present, (scope, setting.when)))
    for made in part.made:
        written = _scoped(made.xacro.computed, scope)
        present = (*holder.present, *_condition(made, scope))
        yield Part((holder.path, made.name_span), present, (), written)
    levels = (Level(scope, part.settings), *holder.levels)
    members: Iterable[NodeInstance | Subsystem | SafetyInstance | ProcessInstance] = part.members
    if part.safety or part.processes:
        everything = (*part.members, *part.safety, *part.processes)
        members = sorted(everything, key=lambda each: each.span.start)
    for member in members:
        present = (*holder.present, *_condition(member, scope))
        of_groups, computed_in_groups = group_parts(member, levels)
        settings: tuple[_Conditional, ...]
        computed: tuple[tuple[Scope, Expression], ...] = ()
        values: tuple[Expression | None, ...] = ()
        optional: tuple[tuple[Scope, Condition], ...] = ()
        if isinstance(member, ProcessInstance):
            settings = member.environment
        else:
            computed = (*holder.computed, *_scoped((member.namespace_from,), scope))
            if isinstance(member, Subsystem):
                if member.launch is not None:
                    optional = (*holder.optional, *of_groups)
                    written = _scoped(member.launch.computed, scope)
                    for_file = (*computed, *holder.paths, *written, *computed_in_groups)
                    yield Part((holder.path, member.name_span), present, optional, for_file)
                path = (*holder.path, member.name)
                inside = replace(
                    holder, path=path, present=present, computed=computed, levels=levels
                )
                yield from _subsystem(member, inside)
                continue
            settings = (*member.files, *member.parameters, *member.wirings, *member.environment)
            settings = (*settings, *into_of(member), *remappings_of(member))
            values = (
                *itertools.chain(*(each.computed for each in member.parameters)),
                *(each.target_from for each in member.wirings),
                *itertools.chain(*(each.computed for each in member.files)),
                *itertools.chain(*(each.computed for each in remappings_of(member))),
                *(each.container_from for each in into_of(member)),
            )
            computed, optional = (*computed, *holder.paths), holder.optional
        conditions = (_condition(each, scope) for each in settings)
        switches = ((scope, each) for each in switches_of(member))
        inner = (*optional, *itertools.chain(*conditions), *of_groups, *switches)
        values = (*values, *(each.text_from for each in own_words(member)))
        values = (*values, *awaited_name_of(member))
        span = member.path_span if isinstance(member, SafetyInstance) else member.name_span
        computed = (*computed, *_scoped(values, scope), *computed_in_groups)
        owners = () if isinstance(member, ProcessInstance) else _owners(member, holder.path)
        yield Part(
            (holder.path, span),
            present,
            inner,
            computed,
            owners,
            is_container=isinstance(member, NodeInstance) and member.is_container,
            is_loaded=isinstance(member, NodeInstance) and member.into is not None,
        )


def _subsystem(part: Subsystem, holder: _Holder) -> Iterator[Part]:
    yield from _parts(part, holder)
    holder = holder.with_files(part.files)
    used = part.system
    if used is None or any(used is one for one in holder.open_systems):
        return
    bound = {each.name.text: each.value for each in part.passed}
    scope = Scope(used.arguments, bound, holder.scope)
    opened = (*holder.open_systems, used)
    levels = (Level(holder.scope, part.settings), *holder.levels)
    yield from _parts(used, replace(holder, scope=scope, levels=levels, open_systems=opened))


def _owners(member: NodeInstance | SafetyInstance, path: tuple[str, ...]) -> tuple[Place, ...]:
    inside = member.inside if isinstance(member, NodeInstance) else None
    return () if inside is None else inside.places(path)


def _condition(part: _Conditional, scope: Scope) -> tuple[tuple[Scope, Condition], ...]:
    return () if part.when is None else ((scope, part.when),)


def _scoped(
    found: Iterable[Expression | None], scope: Scope
) -> tuple[tuple[Scope, Expression], ...]:
    return tuple((scope, each) for each in found if each is not None)
