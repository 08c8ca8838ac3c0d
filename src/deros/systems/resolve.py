"""A system without expressions and conditions, given the values of its arguments.

The result is what the author could have written for these values alone, and all else reads that. It
keeps the source and the spans of the system as written: by them findings name their places, and by
its ``source`` the system is known as the same one.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from typing import TypeVar

from deros.models.arguments import Condition, Expression
from deros.models.common import Scalar, Value
from deros.models.node import NodeType, as_double
from deros.models.system import (
    NodeInstance,
    ParameterSetting,
    SafetyInstance,
    Subsystem,
    System,
    Topic,
    Wiring,
)
from deros.systems.evaluate import CannotEvaluate, Values, evaluate, holds
from deros.systems.scopes import typed, usual_values

_Part = Topic | ParameterSetting | Wiring | NodeInstance | SafetyInstance | Subsystem
_Conditional = TypeVar("_Conditional", bound=_Part)
_Named = TypeVar("_Named", NodeInstance, SafetyInstance, Subsystem)


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
    work = _Resolution()
    return work.system(system, values or {}, (system,)), tuple(work.faults)


@dataclass(slots=True)
class _Resolution:
    """Collects what could not be evaluated while a system is resolved."""

    faults: list[CannotEvaluate] = field(default_factory=list)

    def system(self, system: System, given: Values, open_systems: tuple[System, ...]) -> System:
        values = typed({**usual_values(system.arguments), **given}, system.arguments)
        return replace(
            system,
            topics=self._topics(system.topics, values),
            members=tuple(self._members(system.members, values, open_systems)),
            safety=tuple(self._safety(system.safety, values)),
            is_computed=False,
        )

    def _topics(self, topics: tuple[Topic, ...], values: Values) -> tuple[Topic, ...]:
        found = []
        for each in self._present(topics, values):
            name = self._text(each.name, each.name_from, values)
            if name is not None:
                found.append(replace(each, name=name, name_from=None, when=None))
        return tuple(found)

    def _members(
        self,
        members: tuple[NodeInstance | Subsystem, ...],
        values: Values,
        open_systems: tuple[System, ...],
    ) -> Iterator[NodeInstance | Subsystem]:
        for member in self._present(members, values):
            if isinstance(member, NodeInstance):
                yield self._node(self._placed(member, values), values)
            else:
                yield self._subsystem(self._placed(member, values), values, open_systems)

    def _node(self, node: NodeInstance, values: Values) -> NodeInstance:
        return replace(
            node,
            parameters=self._settings(node.parameters, values, node.type),
            wirings=self._wirings(node.wirings, values),
        )

    def _subsystem(
        self, part: Subsystem, values: Values, open_systems: tuple[System, ...]
    ) -> Subsystem:
        used = part.system
        # A system that uses itself is reported as a cyclic import; resolving it would never end.
        if used is not None and used.is_computed and not any(used is one for one in open_systems):
            used = self.system(used, self._passed(part, values), (*open_systems, used))
        return replace(
            part,
            topics=self._topics(part.topics, values),
            members=tuple(self._members(part.members, values, open_systems)),
            safety=tuple(self._safety(part.safety, values)),
            system=used,
            passed=(),
        )

    def _passed(self, part: Subsystem, values: Values) -> dict[str, Scalar]:
        given: dict[str, Scalar] = {}
        for each in part.passed:
            value = self._value(each.value, values)
            if value is not None:
                given[each.name.text] = value
        return given

    def _safety(
        self, found: tuple[SafetyInstance, ...], values: Values
    ) -> Iterator[SafetyInstance]:
        for each in self._present(found, values):
            yield replace(
                self._placed(each, values),
                parameters=self._settings(each.parameters, values, None),
                wirings=self._wirings(each.wirings, values),
            )

    def _settings(
        self, found: tuple[ParameterSetting, ...], values: Values, node_type: NodeType | None
    ) -> tuple[ParameterSetting, ...]:
        settings = []
        for each in self._present(found, values):
            value: Value | None = each.value
            if each.value_from is not None:
                value = self._setting(each, each.value_from, values, node_type)
            if value is not None:
                settings.append(replace(each, value=value, value_from=None, when=None))
        return tuple(settings)

    def _setting(
        self,
        setting: ParameterSetting,
        written: Expression | tuple[Expression, ...],
        values: Values,
        node_type: NodeType | None,
    ) -> Value | None:
        value: Value | None
        if isinstance(written, tuple):
            items = [self._value(each, values) for each in written]
            present = tuple(item for item in items if item is not None)
            value = present if len(present) == len(items) else None
        else:
            value = self._value(written, values)
        parameter = node_type.parameter_for(setting.name) if node_type is not None else None
        if value is None or parameter is None:
            return value
        return as_double(value, parameter.type)

    def _wirings(self, found: tuple[Wiring, ...], values: Values) -> tuple[Wiring, ...]:
        wirings = []
        for each in self._present(found, values):
            target = self._text(each.target, each.target_from, values)
            if target is not None:
                wirings.append(replace(each, target=target, target_from=None, when=None))
        return tuple(wirings)

    def _placed(self, part: _Named, values: Values) -> _Named:
        """Return a part with its namespace computed, and without its condition, which holds."""
        namespace = part.namespace
        if namespace is not None:
            namespace = self._text(namespace, part.namespace_from, values) or "/"
        return replace(part, namespace=namespace, namespace_from=None, when=None)

    # Values --------------------------------------------------------------------------------------

    def _present(self, parts: tuple[_Conditional, ...], values: Values) -> Iterator[_Conditional]:
        return (each for each in parts if each.when is None or self._holds(each.when, values))

    def _holds(self, condition: Condition, values: Values) -> bool:
        try:
            return holds(condition, values)
        except CannotEvaluate as fault:
            self.faults.append(fault)
            return False

    def _value(self, expression: Expression, values: Values) -> Scalar | None:
        try:
            return evaluate(expression, values)
        except CannotEvaluate as fault:
            self.faults.append(fault)
            return None

    def _text(self, plain: str, expression: Expression | None, values: Values) -> str | None:
        if expression is None:
            return plain
        value = self._value(expression, values)
        if value is not None and not isinstance(value, str):
            message = f"a name is a text, and this is {value!r}"
            self.faults.append(CannotEvaluate(message, expression.span))
            return None
        return value
