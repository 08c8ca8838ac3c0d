"""The settings of the groups around a node or a process: those of the innermost group count.

A setting of the node itself counts before any of them, as does a connection of the port, or of the
parameter, that a group would set.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import Protocol, TypeVar

from deros.models.arguments import Condition
from deros.models.common import Value
from deros.models.node import BUILT_IN_PARAMETERS, NodeType, as_double
from deros.models.programs import ProcessInstance, Remapping, Variable
from deros.models.system import (
    GroupSettings,
    NodeInstance,
    ParameterSetting,
    SafetyInstance,
    Subsystem,
    System,
    Wiring,
)
from deros.systems.flat import FlatNode
from deros.systems.remapping import wired_ends


class _Setting(Protocol):
    @property
    def name(self) -> str: ...

    @property
    def when(self) -> Condition | None: ...


Member = NodeInstance | SafetyInstance | ProcessInstance

Setting = TypeVar("Setting", bound=_Setting)


def has_parameter(node_type: NodeType, name: str) -> bool:
    """Return whether nodes of a type have a parameter, as those of every type have some."""
    return node_type.parameter_for(name) is not None or name in BUILT_IN_PARAMETERS


def not_covered(
    settled: Collection[str], levels: Sequence[Sequence[Setting]]
) -> Iterator[tuple[int, Setting]]:
    """Yield what may count of several levels, each setting with the number of its level.

    Args:
        settled: the names that are set, whatever the levels say.
        levels: the innermost first.
    """
    covered = set(settled)
    for number, level in enumerate(levels):
        here = [each for each in level if each.name not in covered]
        yield from ((number, each) for each in here)
        covered.update(each.name for each in here if each.when is None)


def _first(settled: Collection[str], levels: Sequence[Sequence[Setting]]) -> tuple[Setting, ...]:
    """Return the settings that count, the outermost first; none has a condition any more."""
    found: dict[str, tuple[int, Setting]] = {}
    for number, each in not_covered(settled, levels):
        found.setdefault(each.name, (number, each))
    ordered = sorted(found.values(), key=lambda entry: -entry[0])
    return tuple(each for _, each in ordered)


def settled_parameters(node: NodeInstance | SafetyInstance) -> set[str]:
    """Return the parameters that a node sets itself, by a ``param`` or a connection."""
    settled = {each.name for each in node.parameters if each.when is None}
    if isinstance(node, NodeInstance) and node.type is not None:
        for wiring in node.wirings:
            if wiring.when is None:
                settled.update(name for _, name in wired_ends(node.type, wiring) if name)
    return settled


def settled_variables(environment: Sequence[Variable]) -> set[str]:
    """Return the environment variables that a node or a process sets itself."""
    return {each.name for each in environment if each.when is None}


@dataclass(frozen=True, slots=True)
class Groups:
    """The settings of the groups around a place, of the innermost first; without conditions."""

    levels: tuple[GroupSettings, ...] = ()
    _made: dict[tuple[int, ...], tuple[NodeInstance, NodeInstance]] = field(
        default_factory=dict, compare=False, repr=False
    )

    def within(self, settings: GroupSettings) -> Groups:
        """Return the groups around what is in a further one."""
        if settings == GroupSettings():
            return self
        return Groups((settings, *self.levels), self._made)

    def applied(self, node: NodeInstance) -> NodeInstance:
        """Return a node with the parameters of the groups that it has; the same one each time."""
        node_type = node.type
        if node_type is None or not any(each.parameters for each in self.levels):
            return node
        key = (id(node), *map(id, self.levels))
        if key not in self._made:
            own = settled_parameters(node)
            inherited = tuple(
                replace(each, value=_typed(each, node_type))
                for each in _first(own, [each.parameters for each in self.levels])
                if has_parameter(node_type, each.name)
            )
            made = replace(node, parameters=(*node.parameters, *inherited)) if inherited else node
            self._made[key] = (node, made)
        return self._made[key][1]

    def applied_to_rules(
        self, statement: SafetyInstance, types: Sequence[NodeType]
    ) -> SafetyInstance:
        """Return a statement with the parameters of the groups that one of its nodes has."""
        inherited = tuple(
            each
            for each in _first(
                settled_parameters(statement), [each.parameters for each in self.levels]
            )
            if any(has_parameter(node_type, each.name) for node_type in types)
        )
        if not inherited:
            return statement
        return replace(statement, parameters=(*statement.parameters, *inherited))

    def environment(self, own: Sequence[Variable]) -> tuple[Variable, ...]:
        """Return the environment variables of a node or a process, those of groups first."""
        of_groups = _first(settled_variables(own), [each.environment for each in self.levels])
        return (*of_groups, *_first((), [own]))

    @property
    def parameters(self) -> tuple[ParameterSetting, ...]:
        """The parameters for every node, of each name the innermost."""
        return _first((), [each.parameters for each in self.levels])

    @property
    def remappings(self) -> tuple[Remapping, ...]:
        """The remappings for every node, of each name the innermost; these stand first.

        Two names may be one, as `scan` and `/scan` where a launch file is included in no namespace:
        then the first rule counts.
        """
        found: dict[str, Remapping] = {}
        for level in self.levels:
            for each in level.remappings:
                found.setdefault(each.name, each)
        return tuple(found.values())


def _typed(setting: ParameterSetting, node_type: NodeType) -> Value:
    parameter = node_type.parameter_for(setting.name)
    return setting.value if parameter is None else as_double(setting.value, parameter.type)


def is_inherited(node: FlatNode, setting: ParameterSetting | Wiring) -> bool:
    """Return whether a parameter or a connection of a node is one of a group around it."""
    own, span = node.instance.span, setting.span
    is_outside = span.source is not own.source or not own.start <= span.start < own.end
    return is_outside and (isinstance(setting, Wiring) or setting.origin is None)


# As written ---------------------------------------------------------------------------------------


def groups_of(
    part: System | Subsystem, path: tuple[str, ...] = ()
) -> Iterator[tuple[tuple[str, ...], System | Subsystem]]:
    """Yield a system and the subsystems in its own file, each with its path."""
    yield path, part
    for member in part.members:
        if isinstance(member, Subsystem):
            yield from groups_of(member, (*path, member.name))


def members_of(group: System | Subsystem) -> Iterator[Member]:
    """Yield the members of a group that stand for programs, without those of its subsystems."""
    for each in group.members:
        if isinstance(each, NodeInstance):
            yield each
    yield from group.safety
    yield from group.processes


def variables_in(part: System | Subsystem) -> Iterator[Variable]:
    """Yield every environment variable that a system's own file sets."""
    for _, group in groups_of(part):
        yield from group.settings.environment
        for each in members_of(group):
            yield from each.environment
