"""Checks of ``safety`` statements: their names, rules and connections."""

from __future__ import annotations

from collections.abc import Iterator

from deros import codes
from deros.diagnostics import Diagnostic, Related, Span, report
from deros.models.rules import Rules
from deros.models.system import SafetyInstance, System
from deros.names.names import check_namespace, check_node_name, check_package_name
from deros.systems.flat import FlatSystem
from deros.systems.safety_instances import statements_of


def check_statements(flat: FlatSystem) -> Iterator[Diagnostic]:
    """Yield the findings about the statements that ``flat.system``'s own file writes."""
    first: dict[int, SafetyInstance] = {}
    for statement in statements_of(flat.system):
        yield from _names(statement)
        rules = statement.rules
        if rules is None:
            continue
        yield from _uses(statement, rules, flat.system)
        other = first.setdefault(id(rules), statement)
        if other is not statement:
            yield report(
                codes.RULES_RUN_TWICE,
                f"the nodes of the rules '{rules.name}' are in the system twice",
                statement.path_span,
                "keep one of the two statements",
                (Related(other.path_span, "the other one"),),
            )
        else:
            yield from _wirings(statement, rules, flat)


def _names(statement: SafetyInstance) -> Iterator[Diagnostic]:
    for name, span, check in (
        (statement.node_name, statement.node_name_span, check_node_name),
        (statement.namespace, statement.namespace_span, check_namespace),
        (statement.package, statement.package_span, check_package_name),
    ):
        if name is not None and span is not None and (fault := check(name)) is not None:
            message = f"ROS 2 rejects the name '{name}': it {fault}"
            yield report(codes.INVALID_SYSTEM_NAME, message, span)


def _uses(statement: SafetyInstance, rules: Rules, system: System) -> Iterator[Diagnostic]:
    used = [use.system for use in rules.uses]
    if any(each is None or each.source is system.source for each in used):
        return  # a system that could not be loaded may have been this one
    places = [Related(use.span, "the rules use this system") for use in rules.uses]
    yield report(
        codes.RULES_DO_NOT_USE_SYSTEM,
        f"the rules '{rules.name}' do not use the system '{system.name}'",
        statement.path_span,
        "name this system in the rules, or put the statement into the system that they use",
        tuple(places) or (Related(Span(rules.source, 0, 0), "the rules use no system"),),
    )


def _wirings(statement: SafetyInstance, rules: Rules, flat: FlatSystem) -> Iterator[Diagnostic]:
    nodes = [node for node in flat.nodes if node.statement is statement]
    applied = {id(wiring) for node in nodes for wiring in node.instance.wirings}
    ports = {end.port.name: end for node in nodes for end in node.ports}
    for wiring in statement.wirings:
        if id(wiring) in applied:
            continue
        end = ports.get(wiring.port) or ports.get(f"/{wiring.port}")
        place = end.port.span if end is not None else Span(rules.source, 0, 0)
        yield report(
            codes.CONNECTED_BY_RULES,
            f"the rules '{rules.name}' already connect '{wiring.port}'"
            + (f" to '{end.topic}'" if end is not None else ""),
            wiring.span,
            "remove the connection; to use another topic, name it in the rules",
            (Related(place, "connected by this"),),
        )
