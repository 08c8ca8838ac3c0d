"""Resets of running safety nodes and gates, by their service ``~/reset``."""

from __future__ import annotations

import time
from collections.abc import Collection
from dataclasses import dataclass
from typing import Any

from deros.live.graph import did_you_mean, reporting_nodes
from deros.live.observer import Observer, printable
from deros.names.graph_names import resolve_name
from deros.systems.safety_nodes import RESET, TRIGGER


@dataclass(frozen=True)
class Answer:
    """The response of a node to a request of a reset, in its own words."""

    granted: bool
    message: str


class NoAnswerError(Exception):
    """A reset was not decided; the text says why."""


def resettable_nodes(observer: Observer) -> tuple[str, ...]:
    """Return the full names of the nodes that publish diagnostics and serve ``~/reset``, sorted.

    Every safety node and gate publishes diagnostics. Those of which something latches serve a
    reset, too.
    """
    return tuple(sorted(filter(lambda node: _has_reset(observer, node), reporting_nodes(observer))))


def _has_reset(observer: Observer, node: str) -> bool:
    """Return whether a node serves a reset: a client alone gives a service a name, too."""
    name = _reset_of(node)
    types = dict(observer.node.get_service_names_and_types()).get(name, ())
    return str(TRIGGER) in types and observer.node.count_services(name) > 0


def reset(observer: Observer, node: str, timeout: float) -> Answer:
    """Call the reset of a node once, and return its answer.

    Args:
        observer: the node that calls.
        node: a full name.
        timeout: seconds for discovery and answer together.

    Raises:
        NoAnswerError: if no single node of that name decides it in time.
    """
    from std_srvs.srv import Trigger

    deadline = time.monotonic() + timeout
    client = observer.node.create_client(Trigger, _reset_of(node))
    if not observer.until(lambda: _is_ready(observer, client, node), deadline):
        raise NoAnswerError(_not_found(observer, node, timeout))
    future = client.call_async(Trigger.Request())
    if not observer.until(future.done, deadline):
        raise NoAnswerError(
            f"{node} did not answer within {timeout:g} s. It may still reset when it does: see "
            "what 'deros state' says before you call again"
        )
    response = future.result()
    return Answer(response.success, printable(response.message))


def _reset_of(node: str) -> str:
    return resolve_name(RESET, "/", node)


def _is_ready(observer: Observer, client: Any, node: str) -> bool:
    """Return whether exactly one node would answer, and reports as safety nodes and gates do."""
    servers = observer.node.count_services(client.srv_name)
    return servers == 1 and client.service_is_ready() and node in reporting_nodes(observer)


def _not_found(observer: Observer, node: str, timeout: float) -> str:
    """Return why a node cannot be reset, and which ones may be meant instead."""
    known = resettable_nodes(observer)
    if node in known:
        return (
            f"several nodes are called {node}, and each would answer: end all but one. One that "
            "was killed counts until its lease ends, 20 s with Fast DDS (--timeout 30 waits for it)"
        )
    why = f"no node {node} was found within {timeout:g} s"
    if node in observer.node.get_fully_qualified_node_names():
        why = (
            f"{node} runs, but nothing of it can be reset: a safety node has a reset if an action "
            "is 'latched', a gate if a line says 'until reset'"
        )
    return f"{why}; {did_you_mean(node, known) or _listed(known)}"


def _listed(known: Collection[str]) -> str:
    if not known:
        return "there is nothing to reset in this domain (ROS_DOMAIN_ID)"
    return f"these can be reset: {', '.join(known)}"
