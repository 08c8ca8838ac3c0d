"""A system without expressions and conditions, given the values of its arguments.

The result is what the author could have written for these values alone, and all else reads that. It
keeps the source and the spans of the system as written: by them findings name their places, and by
its ``source`` the system is known as the same one.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TypeVar

from deros.models.arguments import (
    Condition,
    Expression,
    LaunchArgument,
    arguments_in,
    launch_text,
    made_in,
)
from deros.models.common import Scalar, Value
from deros.models.launch_files import LaunchFile, MadeFile, XacroFile
from deros.models.node import NodeType, Parameter, ParameterType, as_double
from deros.models.parameter_files import Below, ParameterFile
from deros.models.starting import Host
from deros.models.system import (
    GroupSettings,
    NodeInstance,
    ParameterSetting,
    SafetyInstance,
    Subsystem,
    System,
    Topic,
    Wiring,
)
from deros.systems.arguments.assignments import MadeUp
from deros.systems.arguments.evaluate import CannotEvaluate, Values, evaluate, holds
from deros.systems.arguments.resolve_programs import ProgramResolution
from deros.systems.arguments.scopes import Scope

Named = TypeVar("Named", NodeInstance, SafetyInstance, Subsystem)


def resolve(system: System, values: Values | None = None) -> System:
    """Return the system for these values of its arguments; what has no value is left out.

    Args:
        system: as written.
        values: of some or all of its arguments. The others have their defaults; one without a
            default has some value that its declaration allows.
    """
    return resolved(system, values)[0]


def resolved(
    system: System, values: Values | None = None
) -> tuple[System, tuple[CannotEvaluate, ...]]:
    """Return what :func:`resolve` does, and why parts of the system have been left out."""
    if not system.is_computed:
        return system, ()
    work = Resolution(values or {})
    return work.system(system, Scope(system.arguments), (system,)), tuple(work.faults)


class Resolution(ProgramResolution):
    """Resolves systems, and collects what could not be evaluated in ``faults``."""

    def __init__(self, values: Values) -> None:
        """Resolve for the values of some arguments of the outermost system."""
        self.faults: list[CannotEvaluate] = []
        self._outermost = values
        self._known: dict[Scope, Values] = {}

    def system(self, system: System, scope: Scope, open_systems: tuple[System, ...]) -> System:
        """Return a system as it is at one place where it is used."""
        return replace(
            system,
            topics=self._topics(system.topics, scope),
            members=tuple(self._members(system.members, scope, open_systems)),
            safety=tuple(self._safety(system.safety, scope)),
            settings=self._group(system.settings, scope),
            processes=self.processes(system.processes, scope),
            is_computed=False,
            files=self._files(system.files, scope),
            hosts=tuple(self._hosts(system.hosts, scope)),
            made=self._made(system.made, scope),
        )

    def _hosts(self, hosts: tuple[Host, ...], scope: Scope) -> Iterator[Host]:
        for each in hosts:
            address = self.text(each.address, each.address_from, scope)
            setup = self.text(each.setup, each.setup_from, scope)
            if address is not None and setup is not None:
                plain = replace(each, address=address, address_from=None)
                yield replace(plain, setup=setup, setup_from=None)

    def _topics(self, topics: tuple[Topic, ...], scope: Scope) -> tuple[Topic, ...]:
        found = []
        for each in self.present(topics, scope):
            name = self.text(each.name, each.name_from, scope)
            if name is not None:
                plain = each.name_from is None and each.when is None
                named = each if plain else replace(each, name=name, name_from=None, when=None)
                found.append(named)
        return tuple(found)

    def _members(
        self,
        members: tuple[NodeInstance | Subsystem, ...],
        scope: Scope,
        open_systems: tuple[System, ...],
    ) -> Iterator[NodeInstance | Subsystem]:
        for member in self.present(members, scope):
            if isinstance(member, NodeInstance):
                yield self._node(self._placed(member, scope), scope)
            else:
                yield self._subsystem(self._placed(member, scope), scope, open_systems)

    def _node(self, node: NodeInstance, scope: Scope) -> NodeInstance:
        return replace(
            self.started(self.switched(node, scope), scope),
            arguments=self.words(node.arguments, scope),
            parameters=self._settings(node.parameters, scope, node.type),
            wirings=self._wirings(node.wirings, scope),
            remappings=self.remappings(node.remappings, scope),
            files=self._files(node.files, scope),
            into=self.into(node.into, scope),
            starting=self.starting(node.starting, scope),
        )

    def _group(self, settings: GroupSettings, scope: Scope) -> GroupSettings:
        return GroupSettings(
            self.variables(settings.environment, scope),
            self._settings(settings.parameters, scope, None),
            self.remappings(settings.remappings, scope),
        )

    def _subsystem(
        self, part: Subsystem, scope: Scope, open_systems: tuple[System, ...]
    ) -> Subsystem:
        used = part.system
        # A system that uses itself is reported as a cyclic import; resolving it would never end.
        if used is not None and used.is_computed and not any(used is one for one in open_systems):
            inner = Scope(used.arguments, self._passed(part, scope), scope)
            used = self.system(used, inner, (*open_systems, used))
        return replace(
            part,
            topics=self._topics(part.topics, scope),
            members=tuple(self._members(part.members, scope, open_systems)),
            safety=tuple(self._safety(part.safety, scope)),
            settings=self._group(part.settings, scope),
            processes=self.processes(part.processes, scope),
            system=used,
            passed=(),
            files=self._files(part.files, scope),
            made=self._made(part.made, scope),
            launch=None if part.launch is None else self._launch(part.launch, scope),
        )

    def _passed(self, part: Subsystem, scope: Scope) -> dict[str, Expression]:
        """Return what is passed to a system, without what has no value."""
        found = ((each, self.value(each.value, scope)) for each in part.passed)
        return {each.name.text: each.value for each, value in found if value is not None}

    def _safety(self, found: tuple[SafetyInstance, ...], scope: Scope) -> Iterator[SafetyInstance]:
        for each in self.present(found, scope):
            yield replace(
                self._placed(self.started(each, scope), scope),
                parameters=self._settings(each.parameters, scope, None),
                wirings=self._wirings(each.wirings, scope),
                files=self._files(each.files, scope),
            )

    def _files(self, found: tuple[ParameterFile, ...], scope: Scope) -> tuple[ParameterFile, ...]:
        files = []
        for each in self.present(found, scope):
            path = self.text(each.path, each.path_from, scope)
            below = None if each.below is None else self._below(each.below, scope)
            if path is not None and (below is not None or each.below is None):
                assumed = self._is_assumed(each.path_from, scope)
                given = each.given and tuple(self._launch_arguments(each.given, scope))
                plain = replace(
                    each, path=path, path_from=None, when=None, below=below, given=given
                )
                files.append(replace(plain, is_assumed=assumed))
        return tuple(files)

    def _below(self, found: Below, scope: Scope) -> Below | None:
        namespace = self.text(found.namespace, found.namespace_from, scope)
        if namespace is None:
            return None
        assumed = self._is_assumed(found.namespace_from, scope)
        return replace(found, namespace=namespace, namespace_from=None, is_assumed=assumed)

    def _made(self, found: tuple[MadeFile, ...], scope: Scope) -> tuple[MadeFile, ...]:
        present = self.present(found, scope)
        return tuple(replace(e, xacro=self._xacro(e.xacro, scope), when=None) for e in present)

    def _launch(self, found: LaunchFile, scope: Scope) -> LaunchFile:
        path = self.text(found.path, found.path_from, scope)
        return replace(
            found,
            path=found.path if path is None else path,
            path_from=None,
            is_assumed=path is None or self._is_assumed(found.path_from, scope),
            arguments=tuple(self._launch_arguments(found.arguments, scope)),
        )

    def _xacro(self, found: XacroFile, scope: Scope) -> XacroFile:
        path = self.text(found.path, found.path_from, scope)
        return replace(
            found,
            path=found.path if path is None else path,
            path_from=None,
            is_assumed=path is None or self._is_assumed(found.path_from, scope),
            arguments=tuple(self._launch_arguments(found.arguments, scope)),
        )

    def _launch_arguments(
        self, found: tuple[LaunchArgument, ...], scope: Scope
    ) -> Iterator[LaunchArgument]:
        for each in found:
            value: Scalar | None = each.value
            if each.value_from is not None:
                value = self.value(each.value_from, scope)
            if value is not None:
                is_assumed = self._is_assumed(each.value_from, scope)
                text = launch_text(value)
                yield replace(each, value=text, value_from=None, is_assumed=is_assumed)

    def _is_assumed(self, expression: Expression | None, scope: Scope) -> bool:
        return expression is not None and self.is_assumed(expression, scope)

    def is_assumed(self, expression: Expression, scope: Scope) -> bool:
        """Return whether a value comes from one that only stands for many others.

        Known are defaults, choices, and texts that conditions name.
        """
        if _holds_made(expression, scope):
            return True
        names = set(scope.origins(each.name for each in arguments_in(expression)))
        while scope.outer is not None:
            scope = scope.outer
        values = self._values(scope)
        used = (each for each in scope.arguments if each.name in names)
        return any(not _is_known(each, values[each.name]) for each in used)

    def _settings(
        self, found: tuple[ParameterSetting, ...], scope: Scope, node_type: NodeType | None
    ) -> tuple[ParameterSetting, ...]:
        settings = []
        for each in self.present(found, scope):
            if each.xacro is not None:
                settings.append(replace(each, xacro=self._xacro(each.xacro, scope), when=None))
                continue
            if each.value_from is None and each.when is None:
                settings.append(each)  # of the many variants of a system, most parts are plain
                continue
            value: Value | None = each.value
            if each.value_from is not None:
                value = self._setting(each, each.value_from, scope, node_type)
            if value is not None:
                plain = replace(each, value=value, value_from=None, when=None)
                settings.append(replace(plain, element_conditions=()))
        return tuple(settings)

    def _setting(
        self,
        setting: ParameterSetting,
        written: Expression | tuple[Expression, ...],
        scope: Scope,
        node_type: NodeType | None,
    ) -> Value | None:
        value: Value | None
        if isinstance(written, tuple):
            conditions = setting.element_conditions or (None,) * len(written)
            items = [
                self.value(each, scope)
                for each, when in zip(written, conditions, strict=True)
                if when is None or self.holds(when, scope)
            ]
            present = tuple(item for item in items if item is not None)
            value = present if len(present) == len(items) else None
        else:
            value = self.value(written, scope)
        parameter = node_type.parameter_for(setting.name) if node_type is not None else None
        if value is None or parameter is None:
            return value
        return as_double(value, parameter.type)

    def _wirings(self, found: tuple[Wiring, ...], scope: Scope) -> tuple[Wiring, ...]:
        wirings = []
        for each in self.present(found, scope):
            if each.target_from is None and each.when is None:
                wirings.append(each)
                continue
            target = self.text(each.target, each.target_from, scope)
            if target is not None:
                wirings.append(replace(each, target=target, target_from=None, when=None))
        return tuple(wirings)

    def _placed(self, part: Named, scope: Scope) -> Named:
        """Return a part with its namespace computed, and without its condition, which holds."""
        if part.namespace_from is None and part.when is None and part.namespace != "":
            return part
        namespace = part.namespace
        if namespace is not None:
            # An empty one leaves names where they are, as launch_ros and ROS 2 have it.
            namespace = self.text(namespace, part.namespace_from, scope) or None
        return replace(part, namespace=namespace, namespace_from=None, when=None)

    # Values --------------------------------------------------------------------------------------

    def holds(self, condition: Condition, scope: Scope) -> bool:
        """Return whether a condition holds; one without a value does not."""
        try:
            return holds(condition, self._values(scope))
        except CannotEvaluate as fault:
            self.faults.append(fault)
            return False

    def value(self, expression: Expression, scope: Scope) -> Scalar | None:
        """Return the value of an expression; ``None`` where it has none."""
        try:
            return evaluate(expression, self._values(scope))
        except CannotEvaluate as fault:
            self.faults.append(fault)
            return None

    def _values(self, scope: Scope) -> Values:
        if scope not in self._known:
            self._known[scope] = scope.values(self._outermost)
        return self._known[scope]

    def text(self, plain: str, expression: Expression | None, scope: Scope) -> str | None:
        """Return a name, computed if it is; ``None`` where it has no value."""
        if expression is None:
            return plain
        value = self.value(expression, scope)
        if value is not None and not isinstance(value, str):
            message = f"a name is a text, and this is {value!r}"
            self.faults.append(CannotEvaluate(message, expression.span))
            return None
        return value


def _holds_made(expression: Expression, scope: Scope) -> bool:
    """Return whether the path of a made file is in a value, be it by way of arguments."""
    meanings = (scope.meaning(each.name) for each in arguments_in(expression))
    return any(made_in(expression)) or any(_holds_made(*each) for each in meanings if each)


def _is_known(argument: Parameter, value: Scalar) -> bool:
    """Return whether a value of an argument is one that its author has thought of."""
    if argument.type is ParameterType.BOOL or argument.choices:
        return True
    if argument.default is None and value == argument.name:
        return False  # which stands for any
    if isinstance(value, str):
        return not isinstance(value, MadeUp)
    return value == argument.default
