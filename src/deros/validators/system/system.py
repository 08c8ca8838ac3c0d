"""Checks of system descriptions: each instance as written, and the wiring as a whole.

The topics of a system that another one imports may be fed by the importing system. So the wiring is
checked only for a system that stands on its own.
"""

from __future__ import annotations

from collections.abc import Iterator

from deros.diagnostics import Diagnostic
from deros.models.system import System
from deros.systems.flat import FlatSystem
from deros.validators.findings.context import CheckContext
from deros.validators.node.files import check_files
from deros.validators.safety.gate_readers import check_gate_readers
from deros.validators.safety.safety_statements import check_statements
from deros.validators.safety.safety_wiring import check_gate_targets, check_hand_wired
from deros.validators.system.arguments.declared import check_arguments
from deros.validators.system.arguments.variants import in_variants
from deros.validators.system.frames import check_broadcasts, check_transform_monitors
from deros.validators.system.late_subscriptions import check_late_subscriptions
from deros.validators.system.parameters.files import check_parameter_files
from deros.validators.system.parameters.xacro import check_xacro
from deros.validators.system.running.activation import check_activation
from deros.validators.system.running.autostart import check_autostart
from deros.validators.system.running.autostart import check_groups as check_autostart_groups
from deros.validators.system.running.composition import check_composed, check_containers
from deros.validators.system.running.groups import check_groups
from deros.validators.system.running.hosts import check_hosts, check_places
from deros.validators.system.running.inside import check_inside, check_own_names
from deros.validators.system.running.launch_files import check_launch_files, with_unknown_nodes
from deros.validators.system.running.loads import check_loads
from deros.validators.system.running.programs import check_programs
from deros.validators.system.running.readiness import check_readiness
from deros.validators.system.running.separation import check_separation
from deros.validators.system.running.simulated_time import check_simulated_time
from deros.validators.system.running.starting import check_starting
from deros.validators.system.swapped_ports import check_swapped
from deros.validators.system.system_names import check_names
from deros.validators.system.system_nodes import check_instances
from deros.validators.system.system_qos import check_qos
from deros.validators.system.system_topics import check_topics
from deros.validators.system.topic_sharing import check_sharing
from deros.validators.system.topic_units import check_topic_units
from deros.validators.wiring.graph import wiring_graph
from deros.validators.wiring.rules_ends import RulesEnds, ends_of
from deros.validators.wiring.system_safety import check_safety_publishers


def check(system: System, context: CheckContext) -> Iterator[Diagnostic]:
    """Yield all findings of a system, in time linear in its size.

    Of one that is computed from arguments, those of every combination of their values.
    """
    faults = list(check_arguments(system))
    yield from faults
    yield from check_autostart_groups(system)
    yield from check_composed(system)
    yield from check_hosts(system)
    yield from check_own_names(system)
    ends = ends_of(context.rules)
    if not system.is_computed:
        yield from _check_flat(context.builds.flat(system), context, ends)
    elif not any(each.is_error for each in faults):  # else most of the others only follow
        yield from in_variants(system, lambda flat: _check_flat(flat, context, ends))


def _check_flat(flat: FlatSystem, context: CheckContext, ends: RulesEnds) -> Iterator[Diagnostic]:
    yield from check_names(flat, context.store)
    yield from check_instances(flat)
    yield from check_programs(flat)
    yield from check_groups(flat)
    yield from check_containers(flat)
    yield from check_inside(flat)
    yield from check_starting(flat)
    yield from check_places(flat)
    yield from check_launch_files(flat)
    yield from check_parameter_files(flat, is_whole=context.is_whole)
    yield from check_xacro(flat)
    yield from check_statements(flat)
    yield from check_files(flat, context.store)
    if context.is_whole:
        yield from with_unknown_nodes(flat, _check_wiring(flat, context, ends))


def _check_wiring(flat: FlatSystem, context: CheckContext, ends: RulesEnds) -> Iterator[Diagnostic]:
    """Yield the findings of a system that stands on its own, about both ends of its topics.

    Args:
        flat: the system.
        context: with the rules that use the system: they read and feed its topics, too.
        ends: those that these rules are.
    """
    yield from check_swapped(flat)
    yield from check_activation(flat)
    yield from check_autostart(flat)
    yield from check_readiness(flat)
    yield from check_loads(flat)
    yield from check_simulated_time(flat)
    yield from check_separation(flat)
    yield from check_broadcasts(flat)
    yield from check_transform_monitors(flat)
    if not any(node.statement is not None and node.type is None for node in flat.nodes):
        # Otherwise the topics of the rules are not known, and no end is known to be missing.
        graph = wiring_graph(flat)
        yield from check_topics(flat, graph, ends)
        yield from check_qos(flat, graph, ends)
        yield from check_topic_units(flat, graph, context.store)
        yield from check_sharing(flat, graph, ends)
        yield from check_late_subscriptions(graph)
    yield from check_safety_publishers(flat, context.rules)
    everybody = (*context.rules, *context.rules_of_parts)
    yield from check_hand_wired(flat, everybody)
    yield from check_gate_targets(flat, everybody)
    yield from check_gate_readers(flat, everybody)
