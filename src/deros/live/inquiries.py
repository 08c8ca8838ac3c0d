"""What a node says of itself when it is asked: parameters, and the state of a managed node."""

from __future__ import annotations

import importlib
from collections.abc import Collection, Iterator
from typing import Any

from deros.live.ends import PARAMETER_LIST, NodeEnds
from deros.live.observer import printable
from deros.live.snapshots import VALUE_FIELDS, SeenParameter, Unseen
from deros.models.common import Interval, Value
from deros.models.node import BUILT_IN_PARAMETERS, ParameterType
from deros.names.graph_names import resolve_name

_TYPES = tuple(ParameterType)
"""In the order of the numbers of ``rcl_interfaces/msg/ParameterType``, which begin with 1."""

_DESCRIBE = "describe_parameters"
_AGAIN = "get_parameters (those with values)"

_LIST_NODES = "_container/list_nodes"

_SERVICE_TYPES = {
    "list_parameters": ("rcl_interfaces.srv", "ListParameters"),
    "get_parameters": ("rcl_interfaces.srv", "GetParameters"),
    "get_parameter_types": ("rcl_interfaces.srv", "GetParameterTypes"),
    _DESCRIBE: ("rcl_interfaces.srv", "DescribeParameters"),
    "get_state": ("lifecycle_msgs.srv", "GetState"),
    _LIST_NODES: ("composition_interfaces.srv", "ListNodes"),
}
"""Module and name of the types of services below a node, which are imported with the first call."""


def _service_type(service: str) -> Any:
    module, name = _SERVICE_TYPES[service]
    return getattr(importlib.import_module(module), name)


class Inquiry:
    """Asks one node, without waiting: :meth:`is_done` takes the next step each time."""

    def __init__(
        self,
        node: Any,
        asked: NodeEnds,
        *,
        described: bool = True,
        names: Collection[str] = (),
    ) -> None:
        """Prepare the questions to a node.

        Each service that is called takes all processes of a graph some milliseconds, for the ends
        that come and go. Ends that come together take half of that: the clients of all questions
        are made with the first step.

        Args:
            node: of rclpy, that asks.
            asked: the node to ask.
            described: ask what parameters are for, too.
            names: those of the parameters, if they are known: only the values are asked for then.
        """
        self._node = node
        self._asked = asked
        self._is_described = described
        self._clients: dict[str, Any] = {}
        self._futures: dict[str, Any] = {}
        self._names = sorted(names)
        self._own: list[str] = []
        self._set: list[str] = []
        self._problems: list[str] = []
        self._is_done = False
        self._is_waiting = True
        self._answered = 0
        self._has_parameters = asked.offers("~/list_parameters", PARAMETER_LIST)
        self._questions: list[str] = []
        self._is_listed = self._are_known = bool(names)
        if self._has_parameters and not names:
            self._questions.append("list_parameters")
        if self._has_parameters:
            self._questions.append("get_parameters")
        if self._has_parameters and described:
            self._questions.append(_DESCRIBE)
        if asked.is_managed:
            self._questions.append("get_state")
        if asked.is_container and self._can_list_nodes():
            self._questions.append(_LIST_NODES)

    def _can_list_nodes(self) -> bool:
        """Return whether the service of containers is known here: it comes with ROS 2 alone."""
        try:
            import composition_interfaces.srv  # noqa: F401
        except ImportError:
            self._problems.append(
                f"{self._asked.full_name} was not asked which nodes are in it: the package "
                "composition_interfaces of ROS 2 cannot be imported"
            )
            return False
        return True

    def is_done(self) -> bool:
        """Ask what can be asked by now; return whether all answers are there."""
        if self._is_done:
            return True
        answered = sum(each.done() for each in self._futures.values())
        if self._is_waiting or answered != self._answered:  # else there is nothing new
            self._answered, self._is_waiting = answered, False
            self._ask()
            self._is_done = all(self._got(question) is not None for question in self._questions)
        return self._is_done

    def _ask(self) -> None:
        for service in self._questions:
            if service != _AGAIN:
                self._client(service)
        if self._asked.is_managed:
            self._answer("get_state")
        if _LIST_NODES in self._questions:
            self._answer(_LIST_NODES)
        if not self._has_parameters:
            return
        if not self._is_listed:
            listed = self._answer("list_parameters")
            if listed is None:
                return
            self._take_names(sorted(listed.result.names))
        if self._is_described:
            self._answer(_DESCRIBE, self._own)
        values = self._answer("get_parameters", self._names)
        if values is None or len(values.values) == len(self._names):
            return
        if not self._are_known:
            self._ask_for_some()

    def _take_names(self, names: list[str]) -> None:
        """Take the names of the parameters; nobody needs to be told what all nodes have."""
        self._names, self._is_listed = names, True
        self._own = [name for name in names if name not in BUILT_IN_PARAMETERS]
        if self._is_described and not self._own:
            self._is_described = False
            self._questions.remove(_DESCRIBE)

    def _ask_for_some(self) -> None:
        """Ask for the parameters that have values: for all, a node without one of them has none."""
        if _AGAIN not in self._questions:
            self._questions += ["get_parameter_types", _AGAIN]
        found = self._answer("get_parameter_types", self._names)
        if found is not None:
            pairs = zip(self._names, found.types, strict=False)
            self._set = [name for name, number in pairs if number]
            self._answer("get_parameters", self._set, _AGAIN)

    def has_other_names(self) -> bool:
        """Return whether the node has other parameters than those whose names were known."""
        answer = self._got("get_parameters")
        return self._are_known and answer is not None and len(answer.values) != len(self._names)

    def parameters(self) -> tuple[SeenParameter, ...] | None:
        """Return the parameters; ``None`` if they are not known."""
        some = _AGAIN in self._questions
        names = self._set if some else self._names
        answer = self._got(_AGAIN if some else "get_parameters")
        described = self._got(_DESCRIBE)
        if answer is None or (self._is_described and described is None):
            return None
        own = self._own if self._is_described else []
        descriptors = described.descriptors if self._is_described else []
        if len(answer.values) != len(names) or len(descriptors) != len(own):
            self._problems.append(f"the parameters of {self._asked.full_name} changed meanwhile")
            return None
        values = {
            name: value for name, value in zip(names, answer.values, strict=True) if value.type
        }
        for name in self._names:
            if name not in values:
                self._problems.append(
                    f"{self._asked.full_name}: parameter {printable(name)} is left out: it has no "
                    "value"
                )
        described_as = dict(zip(own, descriptors, strict=True))
        return tuple(
            _parameter(name, values[name], described_as.get(name))
            for name in self._names
            if name in values
        )

    def state(self) -> str | None:
        """Return the state of a managed node, ``unknown`` if it did not say; else ``None``."""
        if not self._asked.is_managed:
            return None
        answer = self._got("get_state")
        return "unknown" if answer is None else printable(answer.current_state.label)

    def components(self) -> tuple[str, ...] | None:
        """Return the full names of the nodes in a container; ``None`` if they are not known."""
        answer = self._got(_LIST_NODES)
        return None if answer is None else tuple(sorted(map(printable, answer.full_node_names)))

    def problems(self, timeout: float) -> Iterator[Unseen]:
        """Yield what the node did not say, to be called last."""
        name = self._asked.full_name
        said = [*self._problems]
        if not self._has_parameters:
            what = f"{name} has no parameter services: its parameters are not known"
            yield Unseen(what, name, self._asked.is_container)
        silent = [each for each in self._questions if self._got(each) is None]
        if silent:
            said.append(f"{name} did not answer within {timeout:g} s: {', '.join(silent)}")
        yield from (Unseen(each, name) for each in said)

    def close(self) -> None:
        """Remove what the questions have added to the graph."""
        for client in self._clients.values():
            self._node.destroy_client(client)

    def _client(self, service: str) -> Any:
        """Return the client of a service, whose name is that below the name of the node."""
        if service not in self._clients:
            name = resolve_name(f"~/{service}", "/", self._asked.full_name)
            self._clients[service] = self._node.create_client(_service_type(service), name)
        return self._clients[service]

    def _answer(self, service: str, names: list[str] | None = None, question: str = "") -> Any:
        """Return the answer of a service, which is called once it is there.

        Args:
            service: its name below that of the node.
            names: those of the request, if it has any.
            question: its name among the questions, if it is not that of the service.
        """
        question = question or service
        if question in self._futures:
            return self._got(question)
        client = self._client(service)
        if client.service_is_ready():
            of_type = _service_type(service)
            request = of_type.Request() if names is None else of_type.Request(names=names)
            self._futures[question] = client.call_async(request)
        else:
            self._is_waiting = True
        return self._got(question)

    def _got(self, question: str) -> Any:
        future = self._futures.get(question)
        return future.result() if future is not None and future.done() else None


def _parameter(name: str, value: Any, descriptor: Any) -> SeenParameter:
    number = int(value.type) - 1
    if descriptor is None:
        return SeenParameter(name, _TYPES[number], _plain(getattr(value, VALUE_FIELDS[number])))
    ranges = [*descriptor.integer_range, *descriptor.floating_point_range]
    interval = Interval(ranges[0].from_value, ranges[0].to_value) if ranges else None
    return SeenParameter(
        name,
        _TYPES[number],
        _plain(getattr(value, VALUE_FIELDS[number])),
        descriptor.description,
        descriptor.additional_constraints,
        descriptor.read_only,
        interval,
        ranges[0].step if ranges else 0,
    )


def _plain(value: Any) -> Value:
    """Return a value of a message as one of the models."""
    if isinstance(value, bool | int | float | str):
        return value
    return tuple(each[0] if isinstance(each, bytes) else each for each in value)
