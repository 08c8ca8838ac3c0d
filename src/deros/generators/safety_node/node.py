"""The safety node as a node type: its subscriptions, publishers and services.

Its parts are defined in :mod:`deros.systems.safety_nodes`; here they follow from a program.
"""

from __future__ import annotations

from deros import codes
from deros.diagnostics import Related, SourceFile, Span, report
from deros.generators.api.protocol import GenerationError, OptionError, Options
from deros.generators.runtime.interface import RuntimeSource
from deros.models.node import NodeType
from deros.models.rules import Rules
from deros.names.names import check_node_name, check_package_name
from deros.rules.compiler.scope.topics import SystemTopics
from deros.rules.program.ir import Program
from deros.rules.program.outline import program_outline
from deros.systems.safety_instances import stated_package
from deros.systems.safety_nodes import (
    node_name,
    package_name,
    safety_node_type,
)


def safety_node(
    program: Program, topics: SystemTopics, options: Options, rules_source: SourceFile
) -> NodeType:
    """Return the node that runs ``program``.

    Args:
        program: the rules.
        topics: the topics of the used systems, for the QoS of the subscriptions.
        options: ``package`` and ``node``; by default, both follow from the name of the rules.
        rules_source: for the locations of diagnostics about the node.

    Raises:
        GenerationError: if the rules watch a topic that they publish.
        OptionError: if an option is not a name that ROS 2 accepts.
    """
    _check_ends(program)
    package = options.get("package", package_name(program.name))
    if "package" in options and (why := check_package_name(package)) is not None:
        raise OptionError(f"package name {package!r} {why}")
    name = options.get("node", node_name(package))
    if (why := check_node_name(name)) is not None:
        raise OptionError(f"node name {name!r} {why}")
    start = Span(rules_source, 0, 0)
    return safety_node_type(program_outline(program, start), topics.offers, package, name)


def package_options(rules: Rules, options: Options, target: str) -> Options:
    """Return the options of a safety package with their defaults.

    These are the package that the used system states, and the runtime as a package.
    """
    options = {"runtime": RuntimeSource.PACKAGE.value, **options}
    package = stated_package(rules, target)
    if package is None or "package" in options:
        return options
    return {**options, "package": package}


def _check_ends(program: Program) -> None:
    """Reject a topic that the node publishes and watches: its own state would be its input."""
    watched = {each.topic: each.span for each in reversed(program.inputs)}
    found = [
        report(
            codes.UNSUPPORTED_BY_TARGET,
            f"the rules both publish and watch '{action.binding.topic}'",
            action.span,
            hint=f"where the topic is watched, write '{action.name}.active'",
            related=(Related(watched[action.binding.topic], "watched here"),),
        )
        for action in program.actions
        if action.binding is not None and action.span and action.binding.topic in watched
    ]
    if found:
        raise GenerationError(found)


def bound_actions(program: Program, topic: str) -> list[str]:
    """Return the names of the actions whose states a topic carries, in the order declared."""
    return [a.name for a in program.actions if a.binding is not None and a.binding.topic == topic]
