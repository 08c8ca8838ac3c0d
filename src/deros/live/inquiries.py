"""What a node says of itself when it is asked: parameters, and the state of a managed node."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from deros.live.ends import PARAMETER_LIST, NodeEnds
from deros.live.observer import printable
from deros.live.snapshots import VALUE_FIELDS, SeenParameter, Unseen
from deros.models.common import Interval, Value
from deros.models.node import ParameterType
from deros.names.graph_names import resolve_name

_TYPES = tuple(ParameterType)
"""In the order of the numbers of ``rcl_interfaces/msg/ParameterType``, which begin with 1."""

_OF_PARAMETERS = (
    "list_parameters",
    "get_parameters",
    "describe_parameters",
)
_AGAIN = "get_parameters (those with values)"


class Inquiry:
    """Asks one node, without waiting: :meth:`is_done` takes the next step each time."""

    def __init__(self, node: Any, asked: NodeEnds) -> None:
        """Prepare the questions to a node."""
        self._node = node
        self._asked = asked
        self._clients: dict[str, Any] = {}
        self._futures: dict[str, Any] = {}
        self._names: list[str] = []
        self._set: list[str] = []
        self._problems: list[str] = []
        self._is_done = False
        self._has_parameters = asked.offers("~/list_parameters", PARAMETER_LIST)
        self._questions: list[str] = []
        if self._has_parameters:
            self._questions += _OF_PARAMETERS
        if asked.is_managed:
            self._questions.append("get_state")

    def is_done(self) -> bool:
        """Ask what can be asked by now; return whether all answers are there."""
        if not self._is_done:
            self._ask()
            self._is_done = all(self._got(question) is not None for question in self._questions)
        return self._is_done

    def _ask(self) -> None:
        from lifecycle_msgs.srv import GetState
        from rcl_interfaces.srv import DescribeParameters, GetParameters, ListParameters

        if self._asked.is_managed:
            self._answer("get_state", GetState, GetState.Request())
        if not self._has_parameters:
            return
        listed = self._answer("list_parameters", ListParameters, ListParameters.Request())
        if listed is None:
            return
        self._names = self._names or sorted(listed.result.names)
        describe = DescribeParameters.Request(names=self._names)
        self._answer("describe_parameters", DescribeParameters, describe)
        get = GetParameters.Request(names=self._names)
        values = self._answer("get_parameters", GetParameters, get)
        if values is not None and len(values.values) != len(self._names):
            self._ask_for_some()

    def _ask_for_some(self) -> None:
        """Ask for the parameters that have values: for all, a node without one of them has none."""
        from rcl_interfaces.srv import GetParameters, GetParameterTypes

        if _AGAIN not in self._questions:
            self._questions += ["get_parameter_types", _AGAIN]
        types = GetParameterTypes.Request(names=self._names)
        found = self._answer("get_parameter_types", GetParameterTypes, types)
        if found is not None:
            pairs = zip(self._names, found.types, strict=False)
            self._set = [name for name, number in pairs if number]
            get = GetParameters.Request(names=self._set)
            self._answer("get_parameters", GetParameters, get, _AGAIN)

    def parameters(self) -> tuple[SeenParameter, ...] | None:
        """Return the parameters; ``None`` if they are not known."""
        some = _AGAIN in self._questions
        names = self._set if some else self._names
        answer = self._got(_AGAIN if some else "get_parameters")
        described = self._got("describe_parameters")
        if answer is None or described is None:
            return None
        descriptors = described.descriptors
        if len(answer.values) != len(names) or len(descriptors) != len(self._names):
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
        return tuple(
            _parameter(name, values[name], descriptor)
            for name, descriptor in zip(self._names, descriptors, strict=True)
            if name in values
        )

    def state(self) -> str | None:
        """Return the state of a managed node, ``unknown`` if it did not say; else ``None``."""
        if not self._asked.is_managed:
            return None
        answer = self._got("get_state")
        return "unknown" if answer is None else printable(answer.current_state.label)

    def problems(self, timeout: float) -> Iterator[Unseen]:
        """Yield what the node did not say, to be called last."""
        name = self._asked.full_name
        said = [*self._problems]
        if not self._has_parameters:
            said.append(f"{name} has no parameter services: its parameters are not known")
        silent = [each for each in self._questions if self._got(each) is None]
        if silent:
            said.append(f"{name} did not answer within {timeout:g} s: {', '.join(silent)}")
        yield from (Unseen(each, name) for each in said)

    def close(self) -> None:
        """Remove what the questions have added to the graph."""
        for client in self._clients.values():
            self._node.destroy_client(client)

    def _answer(self, service: str, of_type: Any, request: Any, question: str = "") -> Any:
        """Return the answer of a service, which is called once it is there."""
        question = question or service
        if service not in self._clients:
            name = resolve_name(f"~/{service}", "/", self._asked.full_name)
            self._clients[service] = self._node.create_client(of_type, name)
        client = self._clients[service]
        if question not in self._futures and client.service_is_ready():
            self._futures[question] = client.call_async(request)
        return self._got(question)

    def _got(self, question: str) -> Any:
        future = self._futures.get(question)
        return future.result() if future is not None and future.done() else None


def _parameter(name: str, value: Any, descriptor: Any) -> SeenParameter:
    number = int(value.type) - 1
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
