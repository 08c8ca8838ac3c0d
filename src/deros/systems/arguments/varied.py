"""The parts of a system that vary with its arguments, and what each depends on."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

from deros.diagnostics import Span
from deros.models.arguments import Condition, Expression, arguments_in
from deros.models.composition import Into
from deros.models.launch_files import LaunchFile, MadeFile, XacroFile
from deros.models.parameter_files import ParameterFile
from deros.models.programs import ProcessInstance, Remapping, Variable, Word
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
    plain_words,
    remappings_of,
    switches_of,
)
from deros.systems.flat import FlatLaunch, FlatNode, FlatProcess
from deros.systems.groups import Member

Place = tuple[tuple[str, ...], Span]
"""By which a part as written and its flat counterpart are known as one: path, and a name's span."""

_Conditions = tuple[tuple[Scope, Condition], ...]
_File = tuple[Scope, ParameterFile]


@dataclass(frozen=True, slots=True)
class Part:
    """A topic, node, process, statement or setting of a group, with all that decides it.

    Attributes:
        place: by which its flat counterpart is known: the path, and the span of its name.
        present: the conditions of it and of what holds it.
        inner: the conditions of its settings and connections.
        computed: what its names and values are computed from.
        files: its parameter files in which values are put. Which of these count, the files say.
        apart: what else is computed for it. Whether one of these is right, no other one decides: so
            each is looked at by itself, where all of them together would have too many forms.
        owners: the places of the programs in whose processes it is, if it is a node of such.
        is_container: whether nodes may be loaded into it.
        is_loaded: whether it may be loaded into a container, by whatever name.
    """

    place: Place
    present: tuple[tuple[Scope, Condition], ...]
    inner: tuple[tuple[Scope, Condition], ...] = ()
    computed: tuple[tuple[Scope, Expression], ...] = ()
    files: tuple[tuple[Scope, ParameterFile], ...] = ()
    apart: tuple[Part, ...] = ()
    owners: tuple[Place, ...] = ()
    is_container: bool = False
    is_loaded: bool = False

    @property
    def expressions(self) -> Iterator[tuple[Scope, Expression]]:
        """All that is computed for it."""
        return itertools.chain(self.computed, *(each.expressions for each in self.apart))

    @property
    def arguments(self) -> set[str]:
        """The arguments of the outermost system that it depends on."""
        conditions = itertools.chain(
            *((*each.present, *each.inner) for each in (self, *self.apart))
        )
        return _origins((*conditions, *self.expressions))


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
    computed = (each for part in parts for each in part.expressions)
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
    files = tuple(dict.fromkeys(each for part in parts for each in part.files))
    for part in parts:
        yield replace(part, inner=inner, computed=computed, files=files)


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
    files: tuple[tuple[Scope, ParameterFile], ...] = ()
    """Those of these files in which values are put."""

    def with_files(self, files: tuple[ParameterFile, ...]) -> _Holder:
        """Return it with the files of a system or a subsystem."""
        optional = itertools.chain(*(_condition(each, self.scope) for each in files))
        paths = _scoped((text for each in files for text in each.placed), self.scope)
        return replace(
            self,
            optional=(*self.optional, *optional),
            paths=(*self.paths, *paths),
            files=(*self.files, *_with_values(files, self.scope)),
        )


_Conditional = (
    ParameterFile
    | MadeFile
    | Topic
    | Member
    | Subsystem
    | ParameterSetting
    | Wiring
    | Variable
    | Word
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
        present = (*holder.present, *_condition(setting, scope))
        place = holder.path, setting.name_span
        apart = () if setting.xacro is None else _passed(setting.xacro, scope, place, present)
        if setting.when is not None or apart:  # whether any node below has it is to be seen
            yield Part(place, present, apart=apart)
    for made in part.made:
        present = (*holder.present, *_condition(made, scope))
        place = holder.path, made.name_span
        yield Part(place, present, apart=_passed(made.xacro, scope, place, present))
    holder = replace(holder, levels=(Level(scope, part.settings), *holder.levels))
    members: Iterable[Member | Subsystem] = part.members
    if part.safety or part.processes:
        everything = (*part.members, *part.safety, *part.processes)
        members = sorted(everything, key=lambda each: each.span.start)
    for member in members:
        inside = replace(holder, present=(*holder.present, *_condition(member, scope)))
        if isinstance(member, Subsystem):
            yield from _subsystem(member, inside)
        else:
            yield _program(member, inside)


def _program(member: Member, holder: _Holder) -> Part:
    """Return the part that a node, safety node or process is, with what holds it."""
    scope = holder.scope
    of_groups, computed_in_groups = group_parts(member, holder.levels)
    span = member.path_span if isinstance(member, SafetyInstance) else member.name_span
    place = holder.path, span
    settings: tuple[_Conditional, ...] = member.environment
    optional: _Conditions = ()
    computed: tuple[tuple[Scope, Expression], ...] = ()
    files: tuple[_File, ...] = ()
    apart: list[Part] = []
    if not isinstance(member, ProcessInstance):
        settings = (*settings, *member.files, *member.parameters, *member.wirings)
        settings = (*settings, *into_of(member), *remappings_of(member))
        plain = (each for each in member.parameters if each.xacro is None)
        values = (
            member.namespace_from,
            *itertools.chain(*(each.computed for each in plain)),
            *(each.target_from for each in member.wirings),
            *itertools.chain(*(each.placed for each in member.files)),
            *itertools.chain(*(each.computed for each in remappings_of(member))),
            *(each.container_from for each in into_of(member)),
        )
        computed, optional = (*holder.computed, *holder.paths), holder.optional
        computed = (*computed, *_scoped(values, scope))
        files = (*holder.files, *_with_values(member.files, scope))
        for setting in member.parameters:
            if setting.xacro is not None:
                there = (*holder.present, *_condition(setting, scope))
                apart += _passed(setting.xacro, scope, place, there)
    conditions = (_condition(each, scope) for each in settings)
    switches = ((scope, each) for each in switches_of(member))
    for word in plain_words(member):
        there = (*holder.present, *_condition(word, scope))
        apart += (
            Part(place, there, computed=(each,)) for each in _scoped((word.text_from,), scope)
        )
    shown = (each.value.text_from for each in member.environment)
    named = _scoped((*shown, *awaited_name_of(member)), scope)
    return Part(
        place,
        holder.present,
        (*optional, *itertools.chain(*conditions), *of_groups, *switches),
        (*computed, *named, *computed_in_groups),
        files,
        (*apart, *_given(files, place, holder.present)),
        () if isinstance(member, ProcessInstance) else _owners(member, holder.path),
        is_container=isinstance(member, NodeInstance) and member.is_container,
        is_loaded=isinstance(member, NodeInstance) and member.into is not None,
    )


def _subsystem(part: Subsystem, holder: _Holder) -> Iterator[Part]:
    scope = holder.scope
    computed = (*holder.computed, *_scoped((part.namespace_from,), scope))
    if part.launch is not None:
        of_groups, computed_in_groups = group_parts(part, holder.levels)
        path_from = _scoped((part.launch.path_from,), scope)
        place = holder.path, part.name_span
        passed = _passed(part.launch, scope, place, holder.present)
        yield Part(
            place,
            holder.present,
            (*holder.optional, *of_groups),
            (*computed, *holder.paths, *path_from, *computed_in_groups),
            holder.files,
            (*passed, *_given(holder.files, place, holder.present)),
        )
    holder = replace(holder, path=(*holder.path, part.name), computed=computed)
    yield from _parts(part, holder)
    holder = holder.with_files(part.files)
    used = part.system
    if used is None or any(used is one for one in holder.open_systems):
        return
    bound = {each.name.text: each.value for each in part.passed}
    inner = Scope(used.arguments, bound, scope)
    opened = (*holder.open_systems, used)
    levels = (Level(scope, part.settings), *holder.levels)
    yield from _parts(used, replace(holder, scope=inner, levels=levels, open_systems=opened))


def _passed(
    file: LaunchFile | XacroFile, scope: Scope, place: Place, present: _Conditions
) -> tuple[Part, ...]:
    """Return what is passed to a file at a place, each with the path: the file declares it."""
    path = _scoped((file.path_from,), scope)
    values = _scoped((each.value_from for each in file.arguments), scope)
    looks = [path] if path else []
    looks += [(*path, value) for value in values]
    return tuple(Part(place, present, computed=each) for each in looks)


def _with_values(files: Iterable[ParameterFile], scope: Scope) -> Iterator[_File]:
    return ((scope, each) for each in files if each.given)


def _given(files: Iterable[_File], place: Place, present: _Conditions) -> Iterator[Part]:
    """Yield each value that is put into one of some files."""
    for scope, file in files:
        there = (*present, *_condition(file, scope))
        for value in _scoped((each.value_from for each in file.given or ()), scope):
            yield Part(place, there, computed=(value,))


def _owners(member: NodeInstance | SafetyInstance, path: tuple[str, ...]) -> tuple[Place, ...]:
    inside = member.inside if isinstance(member, NodeInstance) else None
    return () if inside is None else inside.places(path)


def _condition(part: _Conditional, scope: Scope) -> tuple[tuple[Scope, Condition], ...]:
    return () if part.when is None else ((scope, part.when),)


def _scoped(
    found: Iterable[Expression | None], scope: Scope
) -> tuple[tuple[Scope, Expression], ...]:
    return tuple((scope, each) for each in found if each is not None)
