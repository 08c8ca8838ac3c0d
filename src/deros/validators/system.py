"""Checks of system descriptions: what is written, instance by instance, and what it amounts to.

A system that another one imports is checked as written (:func:`check_written`); its topics may well
be fed by the importing system, so only a system that stands on its own is also checked as a whole,
on the graph that it amounts to (:func:`check_system`).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from deros.diagnostics import Diagnostic
from deros.interfaces.store import InterfaceStore
from deros.metamodels.flatten import flatten
from deros.metamodels.rules import Rules
from deros.metamodels.system import System
from deros.validators.crossed_ports import check_crossed
from deros.validators.files import check_files
from deros.validators.graph import wiring_graph
from deros.validators.rules_ends import ends_of
from deros.validators.safety_statements import check_statements
from deros.validators.safety_wiring import check_gate_targets, check_hand_wired
from deros.validators.system_names import check_names
from deros.validators.system_nodes import check_instances
from deros.validators.system_qos import check_qos
from deros.validators.system_safety import check_safety_publishers
from deros.validators.system_topics import check_topics


def check_system(
    system: System,
    store: InterfaceStore,
    watchers: Iterable[Rules] = (),
    watchers_of_parts: Iterable[Rules] = (),
) -> Iterator[Diagnostic]:
    """Yield all findings of a system that stands on its own; linear in its size.

    Args:
        system: the system.
        store: the message definitions.
        watchers: rules that use the system: the topics that they read or feed are not one-sided.
        watchers_of_parts: rules that use a system that this one contains.
    """
    flat = flatten(system)
    yield from check_names(flat, store)
    yield from check_instances(flat)
    yield from check_statements(flat)
    yield from check_files(flat, store)
    yield from check_crossed(flat)
    programs = tuple(watchers)
    if not any(node.statement is not None and node.type is None for node in flat.nodes):
        # Else what the rules would read and publish is not known, and nothing proves to be missing.
        graph = wiring_graph(flat)
        ends = ends_of(programs)
        yield from check_topics(flat, graph, ends)
        yield from check_qos(flat, graph, ends)
    yield from check_safety_publishers(flat, programs)
    everybody = (*programs, *watchers_of_parts)
    yield from check_hand_wired(flat, everybody)
    yield from check_gate_targets(flat, everybody)


def check_written(system: System, store: InterfaceStore) -> Iterator[Diagnostic]:
    """Yield the findings of a system as it is written, whoever else may use its topics."""
    flat = flatten(system)
    yield from check_names(flat, store)
    yield from check_instances(flat)
    yield from check_statements(flat)
    yield from check_files(flat, store)
