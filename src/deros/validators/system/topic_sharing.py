"""Checks of topics with several publishers.

They are commanders that override one another, or instances of one system that share a topic.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from deros import codes
from deros.diagnostics import Diagnostic, Related, report
from deros.interfaces.standard_topics import standard_topic
from deros.systems.flat import FlatSystem, FlatTopic
from deros.validators.findings.hints import SHOWN
from deros.validators.system.topic_partners import Robots
from deros.validators.wiring.graph import (
    End,
    Vertex,
    is_one_gate,
    publishers,
    subscribers,
)
from deros.validators.wiring.rules_ends import RulesEnds
from deros.validators.wiring.system_safety import is_a_gate

if TYPE_CHECKING:
    import networkx as nx

_COMMANDS = frozenset(
    f"{package}.{name}"
    for package, names in {
        "geometry_msgs": "Twist TwistStamped Accel AccelStamped Wrench WrenchStamped",
        "ackermann_msgs": "AckermannDrive AckermannDriveStamped",
        "trajectory_msgs": "JointTrajectory MultiDOFJointTrajectory",
        "control_msgs": "JointJog",
    }.items()
    for name in names.split()
)
"""Types of messages that move something, wherever they have a subscription."""


def check_sharing(
    flat: FlatSystem, graph: nx.MultiDiGraph[Vertex], rules: RulesEnds
) -> Iterator[Diagnostic]:
    """Yield the findings about topics whose messages come from where they may not be meant to.

    What a topic moves, it moves as each of its publishers wants in turn, unless the topic is
    declared with ``publishers any``. The topics of two instances of one system are two, unless the
    system around them declares the one that both use.
    """
    robots = Robots(flat.nodes)
    declared: dict[str, list[FlatTopic]] = {}
    for topic in flat.topics:
        declared.setdefault(topic.name, []).append(topic)
    commanded = {name for pair in rules.gated for name in pair}
    for vertex in graph:
        if vertex[0] != "topic":
            continue
        topics = declared.get(vertex[1], [])
        sources, sinks = publishers(graph, vertex), subscribers(graph, vertex)
        if not sources or any(each.declaration.any_publishers for each in topics):
            continue
        shared = list(_shared(vertex[1], topics, sources, sinks, robots))
        yield from shared
        moves = vertex[1] in commanded or (sinks and sources[0].type.short in _COMMANDS)
        if moves and not shared:
            yield from _commanders(vertex[1], sources)


def _commanders(topic: str, sources: Sequence[End]) -> Iterator[Diagnostic]:
    """Yield that several nodes command one thing; what a gate has of several is its own finding."""
    by_node = {each.node.full_name: each for each in reversed(sources)}
    ends = [each for each in sources if by_node[each.node.full_name] is each]
    others = [each for each in ends[1:] if not is_one_gate(each.node, ends[0].node)]
    if not others or any(is_a_gate(each.node) for each in ends):
        return
    names = [each.name for each in (ends[0], *others)]
    listed = f"{', '.join(names[:-1])} and {names[-1]}"
    if len(names) > SHOWN:
        listed = f"{', '.join(names[:SHOWN])} and {len(names) - SHOWN} more"
    yield report(
        codes.SEVERAL_COMMANDERS,
        f"{len(names)} nodes command '{topic}', each without knowing of the others: {listed}",
        others[0].span,
        "give each its own topic, and let one node decide which of them is obeyed; if they take"
        f" turns, declare 'topic {topic} publishers any'",
        tuple(Related(each.span, f"{each.name} is connected here") for each in ends[:SHOWN]),
    )


def _shared(
    name: str,
    topics: Sequence[FlatTopic],
    sources: Sequence[End],
    sinks: Sequence[End],
    robots: Robots,
) -> Iterator[Diagnostic]:
    """Yield that a topic is shared by repeated parts alone, though each has both of its ends."""
    fed = {robots.of(each.node.full_name) for each in sources}
    read = {robots.of(each.node.full_name) for each in sinks}
    parts = [each for each in dict.fromkeys((*fed, *read)) if each is not None]
    if None in fed | read or len(fed & read) < 2 or robots.of(name) is not None:
        return
    if any(not each.path for each in topics) or standard_topic(name, sources[0].type) is not None:
        return
    first, *others = sorted(parts)
    end = next(each for each in sources if robots.of(each.node.full_name) == first)
    listed = f"'{first}' and '{others[0]}'" if len(others) == 1 else f"{len(parts)} instances"
    yield report(
        codes.SHARED_BY_INSTANCES,
        f"{listed} share '{name}', and each has nodes that publish it and nodes that read it: what"
        " is meant for one reaches the others",
        end.span,
        f"write '{name[1:]}', without the first '/', so that each instance has its own; if one for"
        f" all is meant, declare 'topic {name}' in the system that holds them",
        tuple(Related(each.declaration.span, "declared here") for each in topics[:1]),
    )
