"""Resets of running safety nodes and gates, by their service ``~/reset``."""

from __future__ import annotations

import time
from collections.abc import Collection
from dataclasses import dataclass
from typing import Any

from deros.live.graph import did_you_mean
from deros.live.observer import Observer, printable
from deros.live.states import DiagnosticsListener, Reports, awaited
from deros.names.graph_names import resolve_name
from deros.systems.safety_nodes import RESET, TRIGGER


@dataclass(frozen=True)
class Answer:
    """The response of a node to a request of a reset, in its own words."""

    granted: bool
    message: str


class NoAnswerError(Exception):
    """A reset was not decided; the text says why."""


class Resettable:
    """Finds the nodes that can be reset: other nodes may have a service ``~/reset``, too."""

    def __init__(self, observer: Observer) -> None:
        """Begin to listen to reports, which tell what is a safety node or a gate."""
        self._observer = observer
        self._reports = Reports()
        self._listener = DiagnosticsListener(observer, self._reports.take)

    def known(self) -> frozenset[str]:
        """Return the full names of the safety nodes and gates that are known by now."""
        self._listener.listen()
        return awaited(self._observer, self._reports)

    def nodes(self) -> tuple[str, ...]:
        """Return those of them of which something latches, sorted: they serve a reset."""
        return tuple(sorted(filter(self._has_reset, self.known())))

    def _has_reset(self, node: str) -> bool:
        """Return whether a node serves a reset: a client alone gives a service a name, too."""
        name = _reset_of(node)
        types = dict(self._observer.node.get_service_names_and_types()).get(name, ())
        return str(TRIGGER) in types and self._observer.node.count_services(name) > 0


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
    resettable = Resettable(observer)
    if not observer.until(lambda: _is_ready(observer, client, node, resettable), deadline):
        raise NoAnswerError(_not_found(observer, node, timeout, resettable.nodes()))
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


def _is_ready(observer: Observer, client: Any, node: str, resettable: Resettable) -> bool:
    """Return whether exactly one node would answer, which is a safety node or a gate."""
    if node not in resettable.known() or not client.service_is_ready():
        return False
    return bool(observer.node.count_services(client.srv_name) == 1)


def _not_found(observer: Observer, node: str, timeout: float, known: Collection[str]) -> str:
    """Return why a node cannot be reset, and which ones may be meant instead."""
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
