"""Checks of the settings that hold for all nodes of a group, and of all remappings."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from deros import codes
from deros.diagnostics import Diagnostic, Related, report
from deros.interfaces.standard_topics import standard_topic
from deros.models.node import BUILT_IN_PARAMETERS, PortKind
from deros.models.programs import Remapping
from deros.models.system import NodeInstance, ParameterSetting, Wiring
from deros.names import names
from deros.names.names import check_topic_name
from deros.names.topic_likeness import LikelyTopics
from deros.systems.flat import FlatNode, FlatSystem
from deros.systems.groups import groups_of, has_parameter, is_inherited
from deros.validators.findings.hints import did_you_mean, one_of
from deros.validators.system.running.launch_files import unknown_nodes
from deros.validators.system.running.programs import set_twice

_MAY_HAVE_NODES = ("node", "safety", "subsystem")
"""Where a statement with one of these words could not be read, a node below may be missing."""

_TOPIC_KINDS = frozenset({PortKind.PUBLISHER, PortKind.SUBSCRIPTION})


def check_groups(flat: FlatSystem) -> Iterator[Diagnostic]:
    """Yield the findings about settings of groups, and remappings, that its own file writes.

    Values are checked where they come, at the parameters of each node.
    """
    for path, part in groups_of(flat.system):
        settings = part.settings
        if settings.parameters:
            yield from _parameters(settings.parameters, _Below(flat, path))
        yield from _remappings(settings.remappings)
        for member in part.members:
            if isinstance(member, NodeInstance) and member.remappings:
                yield from _remappings(member.remappings)
                yield from _connected(member)
    yield from _undeclared(flat)


@dataclass(frozen=True, slots=True)
class _Below:
    """The nodes of a group."""

    flat: FlatSystem
    path: tuple[str, ...]

    @property
    def nodes(self) -> list[FlatNode]:
        depth = len(self.path)
        return [node for node in self.flat.nodes if node.path[:depth] == self.path]

    @property
    def may_have_others(self) -> bool:
        """Whether a launch file in it starts nodes that are not described."""
        depth = len(self.path)
        return any(each.path[:depth] == self.path for each in unknown_nodes(self.flat))


def _parameters(settings: tuple[ParameterSetting, ...], below: _Below) -> Iterator[Diagnostic]:
    yield from set_twice(
        ((each.name, each.name_span, each.span) for each in settings), "parameter", "values"
    )
    nodes = below.nodes
    types = [node.type for node in nodes if node.type is not None]
    if len(types) < len(nodes) or below.may_have_others:
        return  # the node whose type is not known may have it
    for each in settings:
        if any(has_parameter(node_type, each.name) for node_type in types):
            continue
        known = [parameter.name for node_type in types for parameter in node_type.parameters]
        yield report(
            codes.NO_NODE_BELOW,
            f"no node of this group has a parameter '{each.name}'"
            if nodes
            else f"there is no node in this group that could have the parameter '{each.name}'",
            each.name_span,
            did_you_mean(
                each.name, [*known, *BUILT_IN_PARAMETERS], one_of(known, "their parameters")
            ),
            subjects=_MAY_HAVE_NODES,
        )


def _remappings(found: tuple[Remapping, ...]) -> Iterator[Diagnostic]:
    yield from set_twice(
        ((each.name, each.name_span, each.span) for each in found), "remapping", "targets"
    )
    for each in found:
        for name, span in ((each.name, each.name_span), (each.target, each.target_span)):
            fault = check_topic_name(name)
            if fault is not None:
                message = f"ROS 2 rejects the name '{name}': it {fault}"
                yield report(codes.INVALID_SYSTEM_NAME, message, span)


def _connected(node: NodeInstance) -> Iterator[Diagnostic]:
    """Yield the remappings of a node that connections of it leave without effect."""
    if node.type is None:
        return
    connected: dict[tuple[str, PortKind], Wiring] = {}
    for wiring in reversed(node.wirings):
        for port in node.type.ports_named(wiring.port, wiring.kind):
            connected[port.name, port.kind] = wiring
    for each in node.remappings:
        ends = [(port.name, port.kind) for port in node.type.ports if port.name == each.name]
        if ends and all(end in connected for end in ends):
            wiring = connected[ends[0]]
            yield report(
                codes.DUPLICATE_SETTING,
                f"'{each.name}' is connected to '{wiring.target}', which comes before this"
                " remapping",
                each.name_span,
                "keep one of the two",
                (Related(wiring.span, "the connection"),),
            )


def _undeclared(flat: FlatSystem) -> Iterator[Diagnostic]:
    """Yield the topics to which groups move ports, but which are not declared."""
    declared = {topic.name: None for topic in flat.topics}
    likely = LikelyTopics(declared)
    reported: set[tuple[int, str]] = set()
    for node in flat.nodes:
        for port in node.ports:
            wiring = port.wiring
            if wiring is None or port.port.kind not in _TOPIC_KINDS:
                continue
            if not is_inherited(node, wiring) or node.statement is not None:
                continue
            if wiring.span.source is not flat.system.source or port.topic in declared:
                continue
            if standard_topic(port.topic, port.port.type) or check_topic_name(wiring.target):
                continue
            key = (wiring.span.start, port.topic)
            if key not in reported:
                reported.add(key)
                yield report(
                    codes.UNKNOWN_TOPIC,
                    f"topic '{port.topic}', to which this moves '{port.port.name}' of"
                    f" '{node.full_name}', is not declared",
                    wiring.target_span,
                    names.did_you_mean(likely.best(port.topic), wiring.target, port.topic)
                    or f"declare it: 'topic {port.topic}' under 'topics'",
                )
