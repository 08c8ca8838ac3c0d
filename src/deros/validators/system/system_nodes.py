"""Checks of node instances against their types: parameters, ports and wirings."""

from __future__ import annotations

import functools
from collections.abc import Iterator, Mapping

from deros import codes
from deros.diagnostics import Code, Diagnostic, Related, Span, report
from deros.interfaces.standard_topics import standard_topic
from deros.models.node import (
    BUILT_IN_PARAMETERS,
    NodeType,
    Parameter,
    ParameterType,
    Port,
    PortKind,
)
from deros.models.parameter_files import NotInstalled
from deros.models.qos import OVERRIDES, overridden_policy
from deros.models.system import NodeInstance, ParameterSetting, System, Wiring
from deros.names import names
from deros.names.graph_names import resolve_name
from deros.names.names import check_parameter_name, check_topic_name
from deros.names.topic_likeness import LikelyTopics
from deros.systems.flat import FlatNode, FlatSystem, entries_of, is_topic_parameter
from deros.systems.groups import is_inherited
from deros.systems.remapping import wired_apart, wired_ends
from deros.validators.findings.hints import did_you_mean, one_of
from deros.validators.node.values import (
    constraint_fault,
    entry_faults,
    file_type_fault,
    names_in,
    type_fault,
    value_hint,
)
from deros.validators.system.parameters.xacro import unfit_made
from deros.validators.wiring.graph import End

_TOPIC_KINDS = frozenset({PortKind.PUBLISHER, PortKind.SUBSCRIPTION})
_OVERRIDABLE = {PortKind.PUBLISHER: "publisher", PortKind.SUBSCRIPTION: "subscription"}


def check_instances(flat: FlatSystem) -> Iterator[Diagnostic]:
    """Yield the findings about nodes, and settings of groups, that the system's own file writes."""
    declared = {topic.name: None for topic in flat.topics}
    likely = LikelyTopics(declared)
    of_groups: dict[tuple[Code, Span, str], Diagnostic] = {}
    for node in flat.nodes:
        if node.instance.span.source is flat.system.source:
            yield from _settings(node)
            yield from _wirings(node, declared, likely)
            yield from _listed(node, declared, likely)
        of_groups |= {(f.code, f.span, f.message): f for f in _inherited(node, flat.system)}
    yield from of_groups.values()


# Parameters -------------------------------------------------------------------------------------


def _inherited(node: FlatNode, system: System) -> Iterator[Diagnostic]:
    """Yield what is wrong with what groups of the system's own file give a node, or files."""
    is_own = node.instance.span.source is system.source
    for setting in node.instance.parameters if node.type is not None else ():
        assert node.type is not None
        of_group = setting.span.source is system.source and is_inherited(node, setting)
        if of_group or (setting.origin is not None and not is_own):
            yield from _setting(node, node.type, setting)
            yield from _topic_setting(node.type, setting)


def _settings(node: FlatNode) -> Iterator[Diagnostic]:
    seen: dict[str, ParameterSetting] = {}
    for setting in node.instance.parameters:
        if is_inherited(node, setting):
            continue
        first = seen.setdefault(setting.name, setting)
        if first is not setting:
            yield report(
                codes.DUPLICATE_SETTING,
                f"parameter '{setting.name}' of '{node.instance.name}' is set twice",
                setting.name_span,
                hint="keep one of the two values",
                related=(Related(first.span, "the first value"),),
            )
        if node.type is not None:
            yield from _setting(node, node.type, setting)
            yield from _topic_setting(node.type, setting)
    if node.type is not None and node.type.parameters:
        yield from _without_value(node, node.type)


def _setting(
    node: FlatNode, node_type: NodeType, setting: ParameterSetting
) -> Iterator[Diagnostic]:
    parameter = node_type.parameter_for(setting.name)
    if parameter is None:
        kind = BUILT_IN_PARAMETERS.get(setting.name)
        if kind is None and setting.name.startswith(OVERRIDES):
            yield from _override(node, node_type, setting)
            fault = check_parameter_name(setting.name)
            if fault is not None:
                message = f"ROS 2 rejects the name '{setting.name}': it {fault}"
                yield report(codes.INVALID_SYSTEM_NAME, message, setting.name_span)
        elif kind is None and (node_type.takes_any_parameter or _is_for_several(setting)):
            pass  # whether any of several nodes has it, is asked of the whole file
        elif kind is None:
            names = [p.name for p in node_type.parameters]
            yield report(
                codes.UNKNOWN_PARAMETER,
                f"node type '{node_type.name}' has no parameter '{setting.name}'",
                setting.name_span,
                hint=did_you_mean(setting.name, names, one_of(names, "its parameters")),
                related=(Related(node_type.name_span, "the node type"),),
            )
        elif kind is not None and (fault := type_fault(kind, setting.value)) is not None:
            yield report(
                codes.WRONG_PARAMETER_VALUE,
                f"parameter '{setting.name}' of every ROS 2 node is {kind.value}: {fault}",
                setting.value_span,
            )
        if setting.unit is not None:
            yield _unit_fault(None, setting)
        return
    yield from _value(node_type, parameter, setting)
    if parameter.keys:
        yield from _entry(node, parameter, setting)


def _override(
    node: FlatNode, node_type: NodeType, setting: ParameterSetting
) -> Iterator[Diagnostic]:
    """Yield a QoS override of a generated node, which has no effect."""
    if node_type.executable is not None:
        return
    for port in node.ports:
        entity = _OVERRIDABLE.get(port.port.kind)
        if entity is None or overridden_policy(setting.name, port.topic, entity) is None:
            continue
        yield report(
            codes.QOS_OVERRIDE_UNREAD,
            f"'{node.full_name}' does not read this override: the QoS of '{port.port.name}' is"
            " fixed by its node description",
            setting.name_span,
            "state the 'qos' of the port in the node description; if the program exists already,"
            " declare it there with 'executable'",
            (Related(port.port.span, f"'{port.port.name}' is declared here"),),
        )
        return


def _entry(node: FlatNode, parameter: Parameter, setting: ParameterSetting) -> Iterator[Diagnostic]:
    """Check that the list has the entry that a parameter such as ``gains.elbow.p`` belongs to."""
    entries = _entries(node, parameter)
    entry = parameter.entry_of(setting.name)
    if entries is not None and entry is not None and entry not in entries:
        listed = did_you_mean(entry, entries, one_of(entries, "its entries"))
        yield report(
            codes.UNKNOWN_ENTRY,
            f"'{setting.name}' is for the entry '{entry}', which '{parameter.keys[0]}' of"
            f" '{node.instance.name}' does not have: the node ignores the value",
            setting.name_span,
            hint=listed or f'the list is empty: add "{entry}" to it',
            related=(Related(parameter.span, "declared here"),),
        )


def _entries(node: FlatNode, parameter: Parameter) -> tuple[str, ...] | None:
    """Return the entries that a parameter is declared for; ``None`` if they are not known."""
    return entries_of(node.type, parameter, dict(node.parameters)) if node.type else None


def _topic_setting(node_type: NodeType, setting: ParameterSetting) -> Iterator[Diagnostic]:
    """Check the value of a parameter that a port takes its name from."""
    parameter = node_type.parameter_for(setting.name)
    if parameter is None or not any(port.via == parameter.name for port in node_type.ports):
        return
    if setting.xacro is not None:
        return  # which is reported as such
    for name in names_in(setting.value):
        fault = check_topic_name(name)
        if fault is not None:
            message = f"ROS 2 rejects the name '{name}': it {fault}"
            yield report(codes.INVALID_SYSTEM_NAME, message, setting.value_span)


def _value(
    node_type: NodeType, parameter: Parameter, setting: ParameterSetting
) -> Iterator[Diagnostic]:
    place = (Related(parameter.span, "declared here"),)
    if setting.xacro is not None:
        yield from unfit_made(node_type, parameter, setting)
        return
    if setting.unit is not None:
        yield _unit_fault(parameter.unit, setting, place)
        return
    fault = type_fault(parameter.type, setting.value)
    if setting.origin is not None:
        fault = fault or file_type_fault(parameter.type, setting.value)
    if fault is not None:
        yield report(
            codes.WRONG_PARAMETER_VALUE,
            f"parameter '{setting.name}' is {parameter.type.value}: {fault}",
            setting.value_span,
            hint=value_hint(parameter.type, setting.value),
            related=place,
        )
        return
    fault = constraint_fault(parameter, setting.value)
    fault = fault or next(entry_faults(node_type, parameter, setting.value), None)
    if fault is not None:
        yield report(
            codes.PARAMETER_OUT_OF_RANGE,
            f"value of parameter '{setting.name}': {fault}",
            setting.value_span,
            related=place,
        )


def _is_for_several(setting: ParameterSetting) -> bool:
    return setting.origin is not None and setting.origin.is_for_several


def _unit_fault(
    wanted: str | None, setting: ParameterSetting, place: tuple[Related, ...] = ()
) -> Diagnostic:
    """Report a unit that could not be converted into that of the parameter."""
    span = setting.unit_span or setting.value_span
    message = f"parameter '{setting.name}' has no unit, '{setting.unit}' follows its value"
    hint = "write the number alone"
    if wanted is not None:
        message = f"'{setting.unit}' cannot be converted into '{wanted}' here"
        hint = f"write the number in {wanted}: units are converted for tunable constants only"
    return report(codes.INCOMPATIBLE_UNITS, message, span, hint, place)


def _without_value(node: FlatNode, node_type: NodeType) -> Iterator[Diagnostic]:
    if any(isinstance(each.load(), NotInstalled | None) for each in node.files):
        return  # the value may stand in a file that is only there where the system is started
    given = {name for name, _ in node.parameters}
    for parameter in node_type.parameters:
        if parameter.default is not None:
            continue
        names = [parameter.name]
        if parameter.keys:
            names = [parameter.name_for(entry) for entry in _entries(node, parameter) or ()]
        for name in dict.fromkeys(names):
            if name not in given:
                yield report(
                    codes.PARAMETER_WITHOUT_VALUE,
                    f"parameter '{name}' of '{node.instance.name}' has neither a default nor a"
                    " value",
                    node.instance.name_span,
                    hint=f"add 'param {name} = …' to the node",
                    related=(Related(parameter.span, "declared here without a default"),),
                )


# Wirings ----------------------------------------------------------------------------------------


def _wirings(
    node: FlatNode, declared: Mapping[str, None], likely: LikelyTopics
) -> Iterator[Diagnostic]:
    instance, node_type = node.instance, node.type
    if node_type is None:
        return
    seen: dict[tuple[PortKind | None, str], Wiring] = {}
    for wiring in instance.wirings:
        ends = wired_ends(node_type, wiring)
        yield from _connected_twice(instance, wiring, ends, seen)
        for port, parameter in ends:
            if port is not None and node_type.is_listed(port):
                yield _connected_list(node, port, wiring)
            elif parameter is not None and (port or is_topic_parameter(node_type, parameter)):
                yield from _conflict(node, parameter, wiring)
        ports = [port for port, _ in ends if port is not None]
        if not ports and (
            wiring.kind is not None or not is_topic_parameter(node_type, wiring.port)
        ):
            yield _unknown_port(instance, node_type, wiring)
        is_topic = not ports or any(port.kind in _TOPIC_KINDS for port in ports)
        if is_topic and _is_written(node, wiring):
            target = resolve_name(wiring.target, node.namespace, instance.name)
            kind = next((port.type for port in ports if port.kind in _TOPIC_KINDS), None)
            is_standard = standard_topic(target, kind) or standard_topic(target, None)
            if target not in declared and not is_standard:
                yield report(
                    codes.UNKNOWN_TOPIC,
                    f"topic '{target}' is not declared",
                    wiring.target_span,
                    hint=names.did_you_mean(likely.best(target), wiring.target, target)
                    or f"declare it: 'topic {wiring.target}' under 'topics'",
                )
    yield from wired_apart(node)
    for untyped in node.untyped:
        yield report(
            codes.UNTYPED_WIRING,
            f"no port of '{node_type.name}' takes its name from parameter '{untyped.wiring.port}': "
            f"the type of '{untyped.topic}' is not known here",
            untyped.wiring.span,
            hint=f"add the port with 'via {untyped.wiring.port}' to the node description",
            related=(Related(node_type.name_span, "the node type"),),
        )


def _connected_list(node: FlatNode, port: Port, wiring: Wiring) -> Diagnostic:
    source = f"the list '{port.via}'"
    hint = f"list the topic: 'param {port.via} = [\"{wiring.target}\"]'"
    parameter = node.type.parameter(port.via or "") if node.type is not None else None
    if parameter is not None and parameter.keys:
        source = f"the parameters '{port.via}'"
        entry = next(iter(_entries(node, parameter) or ()), "…")
        hint = (
            f"set the topic of an entry: 'param {parameter.name_for(entry)} = \"{wiring.target}\"'"
        )
    return report(
        codes.TOPIC_PARAMETER_CONFLICT,
        f"'{port.name}' takes its topics from {source}: a connection has no effect",
        wiring.span,
        hint,
        (Related(port.span, "declared here"),),
    )


def _listed(
    node: FlatNode, declared: Mapping[str, None], likely: LikelyTopics
) -> Iterator[Diagnostic]:
    """Yield the topics in the lists and maps of a node that are not declared."""
    for port in node.ports:
        listing = End(node, port).listing
        if listing is None or port.entry is None or port.topic in declared:
            continue
        if standard_topic(port.topic, port.port.type) or check_topic_name(port.entry) is not None:
            continue
        yield report(
            codes.UNKNOWN_TOPIC,
            f"topic '{port.topic}' in {_container(listing)} '{listing.name}' is not declared",
            _place_of(port.entry, listing.value_span),
            hint=names.did_you_mean(likely.best(port.topic), port.entry, port.topic)
            or f"declare it: 'topic {port.entry}' under 'topics'",
        )


def _container(listing: ParameterSetting) -> str:
    return "the list" if isinstance(listing.value, tuple) else "parameter"


def _place_of(entry: str, value: Span) -> Span:
    """Return where a name stands in a value; the whole value, where it is written with escapes."""
    offset = value.text.find(f'"{entry}"')
    if offset < 0:
        return value
    start = value.start + offset + 1
    return Span(value.source, start, start + len(entry))


def _connected_twice(
    instance: NodeInstance,
    wiring: Wiring,
    ends: list[tuple[Port | None, str | None]],
    seen: dict[tuple[PortKind | None, str], Wiring],
) -> Iterator[Diagnostic]:
    """Yield a port or name that an earlier wiring has connected already."""
    keys: list[tuple[PortKind | None, str]]
    keys = [(port.kind, port.name) for port, _ in ends if port is not None]
    for key in keys or [(wiring.kind, wiring.port.removeprefix("/"))]:
        first = seen.setdefault(key, wiring)
        if first is not wiring:
            name = f"{key[0].word} '{key[1]}'" if key[0] is not None else f"'{wiring.port}'"
            plain = wiring.kind is None and first.kind is None
            yield report(
                codes.DUPLICATE_SETTING,
                f"{name if not plain else repr(wiring.port)} of '{instance.name}' is connected"
                " twice",
                wiring.port_span,
                hint="a port has one topic; remove one of the two connections",
                related=(Related(first.span, "the first connection"),),
            )
            return


def _is_written(node: FlatNode, wiring: Wiring) -> bool:
    """Return whether the system itself contains a wiring; those from rules are checked there."""
    return node.statement is None or any(wiring is each for each in node.statement.wirings)


def _unknown_port(instance: NodeInstance, node_type: NodeType, wiring: Wiring) -> Diagnostic:
    parameter = node_type.parameter_for(wiring.port)
    others = node_type.ports_named(wiring.port)
    if wiring.kind is not None:
        words = " and ".join(port.kind.word for port in others)
        message = f"node type '{node_type.name}' has no {wiring.kind.word} '{wiring.port}'"
        related = Related(node_type.name_span, f"the type of '{instance.name}'")
        names = [port.name for port in node_type.ports_of(wiring.kind)]
        hint = (
            f"it has the {words} '{wiring.port}'"
            if others
            else did_you_mean(wiring.port, names, one_of(names, "its ports of that kind"))
        )
    elif parameter is not None and parameter.keys and parameter.type is ParameterType.STRING:
        message = f"'{wiring.port}' is not a port, but a parameter for an entry of a list"
        related = Related(parameter.span, "declared here")
        hint = f"set it: 'param {wiring.port} = \"{wiring.target}\"'"
        if wiring.port == parameter.name:
            hint = f"set it for each entry of '{parameter.keys[0]}'"
    elif parameter is not None:
        message = (
            f"parameter '{parameter.name}' is {parameter.type.value} and cannot hold a topic's name"
        )
        related = Related(parameter.span, "declared here")
        hint = "connect a port, or a string parameter that holds the topic's name"
    else:
        message = f"node type '{node_type.name}' has no port '{wiring.port}'"
        related = Related(node_type.name_span, f"the type of '{instance.name}'")
        names = [port.name for port in node_type.ports]
        names += [p.name for p in node_type.parameters if is_topic_parameter(node_type, p.name)]
        hint = did_you_mean(
            wiring.port, names, one_of((p.name for p in node_type.ports), "its ports")
        )
    return report(codes.UNKNOWN_PORT, message, wiring.port_span, hint, (related,))


def _conflict(node: FlatNode, parameter: str, wiring: Wiring) -> Iterator[Diagnostic]:
    """Compare the topic that a parameter is wired to with the value that ``param`` gives it."""
    setting = next((p for p in node.instance.parameters if p.name == parameter), None)
    if setting is None or setting.origin is not None or not isinstance(setting.value, str):
        return

    full = functools.partial(resolve_name, namespace=node.namespace, node_name=node.instance.name)
    if full(setting.value) != full(wiring.target):
        yield report(
            codes.TOPIC_PARAMETER_CONFLICT,
            f"parameter '{setting.name}' is set to \"{setting.value}\", "
            f"but is connected to '{wiring.target}'",
            setting.value_span,
            hint="remove the param: the wiring sets it",
            related=(Related(wiring.span, "connected here"),),
        )
