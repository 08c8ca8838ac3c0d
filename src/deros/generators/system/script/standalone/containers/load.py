"""Loads nodes into containers: a process of its own, which needs rclpy."""

from __future__ import annotations

from collections.abc import Collection
import json
import os
import socket
import time
from typing import Any

from ..bring_up import ManagedNode, Manager, NotDoneError, PROBE_PERIOD
from .values import complete

LOADING = 60.0  # seconds for one node, whose constructor may take its time


class Loader(Manager):
    """Loads nodes into each container that has been started, perhaps again, in order."""

    _own_name = '_load'
    _what_is_done = 'containers have their nodes'
    _what_fails = 'does not have its nodes'

    def __init__(
        self,
        containers: dict[str, list[dict[str, Any]]],
        timeout: float,
        needed: bool,
        script: socket.socket,
        later: Collection[str] = (),
    ) -> None:
        """
        Load into the containers, in the given order, but for those that start later.

        The timeout is the time in seconds in which a container has to offer its services.
        """
        nodes = [ManagedNode(name, timeout, needed, name in later) for name in containers]
        super().__init__(nodes, 0.0, script)
        self._components = containers

    def _make_clients(self, node: Any) -> None:
        from composition_interfaces.srv import ListNodes, LoadNode

        self._load, self._list = LoadNode.Request, ListNodes.Request
        for each in self._nodes.values():
            # In this order: who answers list_nodes has found our end of load_node before.
            services = f'{each.name}/_container'
            each.change_state = node.create_client(LoadNode, f'{services}/load_node')
            each.get_state = node.create_client(ListNodes, f'{services}/list_nodes')

    def _complete_node(self, node: ManagedNode) -> None:
        service = f'{node.name}/_container/load_node'
        if not self._await(node.change_state.service_is_ready, node.timeout, node):
            raise NotDoneError(f'no service {service} within {node.timeout:g} s')
        present = self._loaded_in(node)
        for component in self._components[node.name]:
            name = component['name']
            if name in present:
                raise NotDoneError(f'it has a node {name} already')
            answer = self._ask(node.change_state, self._request_for(component), LOADING, node)
            if answer is None:
                raise NotDoneError(f'{name} is not loaded within {LOADING:g} s')
            if not answer.success:
                raise NotDoneError(f'{name} cannot be loaded: {answer.error_message}')
            if answer.full_node_name != name:
                raise NotDoneError(f'{name} is called {answer.full_node_name} in there')
            print(f'{name} loaded into {node.name}', flush=True)
            self._tell('loaded', name)

    def _loaded_in(self, node: ManagedNode) -> list[str]:
        """
        Return the names of the nodes in a container.

        It is asked again and again: the service may still be that of one that has been killed.
        """
        end = time.monotonic() + node.timeout
        while (left := end - time.monotonic()) > 0:
            if not self._await(node.get_state.service_is_ready, left, node):
                break
            answer = self._ask(node.get_state, self._list(), min(PROBE_PERIOD, left), node)
            if answer is not None:
                return [*answer.full_node_names]
        raise NotDoneError(f'no answer from {node.name}/_container within {node.timeout:g} s')

    def _request_for(self, component: dict[str, Any]) -> Any:
        from rclpy.parameter import Parameter

        namespace, _, name = component['name'].rpartition('/')
        request = self._load()
        request.package_name, request.plugin_name = component['package'], component['plugin']
        request.node_name, request.node_namespace = name, namespace or '/'
        request.remap_rules = component['remappings']
        values = component['parameters'].items()
        request.parameters = [
            Parameter(each, value=value).to_parameter_msg() for each, value in values
        ]
        if component['intra_process']:
            inside = Parameter('use_intra_process_comms', value=True)
            request.extra_arguments = [inside.to_parameter_msg()]
        return request

    def _bring_all_down(self) -> None:
        """Leave the nodes to their containers."""


def load(timeout: str, needed: str, later: str, *pieces: str) -> int:
    """Load the nodes of a JSON text, told of containers by the script at our standard input."""
    containers = json.loads(''.join(pieces))
    with socket.socket(fileno=os.dup(0)) as script:
        loader = Loader(containers, float(timeout), bool(needed), script, json.loads(later))
        try:
            # Once for all: a container that is started again gets the same values again.
            for name, components in containers.items():
                containers[name] = [complete(each) for each in components]
        except ValueError as fault:
            print(fault, flush=True)
            return 1
        return loader.run()
