"""Containers, and the nodes that are loaded into them."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from deros import codes
from deros.metamodels.converters.convert_arguments import ArgumentConverter
from deros.models.arguments import both
from deros.models.common import Name
from deros.models.composition import (
    CONTAINER,
    ContainerKind,
    Into,
    IntraProcess,
    OtherType,
    container_type,
)
from deros.models.system import NodeInstance

COMPOSITION_WORDS = {
    "ContainerThreads": "the threads of a container",
    "Plugin": "plugin",
    "Into": "into",
    "IntraProcess": "intra_process",
    "OwnName": "own_name",
}
"""The modifiers of containers, and of nodes that share a process, by their rules."""

_KIND = "kind"


class CompositionConverter(ArgumentConverter):
    """Converts what has to do with containers."""

    def composition_modifier(self, what: str, modifier: Any) -> dict[str, Any]:
        """Return the field that a modifier sets."""
        if what == "plugin":
            name = Name(self.text(modifier.class_name), self.token_span(modifier.class_name))
            return {"plugin": name}
        if what == "intra_process":
            return {"intra_process": IntraProcess(self.span(modifier), self.only_if(modifier))}
        if what == "own_name":
            return {"own_name": self.span(modifier)}
        if what == "into":
            container, container_from = self.computed_name(modifier.container)
            when = None if modifier.when is None else self.condition(modifier.when.condition)
            place = self.token_span(modifier.container)
            return {"into": Into(container, self.span(modifier), place, container_from, when)}
        return {_KIND: modifier}

    def container(self, found: Any, settings: dict[str, Any]) -> NodeInstance:
        """Return a container, given what its modifiers set: a node, without those in it."""
        span = self.token_span(found.name)
        threads = settings.pop(_KIND, None)
        when = None if threads is None else self.only_if(threads)
        kind: ContainerKind = "single_threaded" if threads is None else threads.kind
        node_type = container_type(kind, self.source, span)
        if when is not None:
            settings["other_type"] = OtherType(node_type, when)
            node_type = container_type("single_threaded", self.source, span)
        return NodeInstance(
            str(found.name),
            CONTAINER,
            node_type,
            self.span(found),
            span,
            span,
            is_container=True,
            **settings,
        )

    def in_container(self, node: NodeInstance, container: NodeInstance) -> NodeInstance:
        """Return a node that stands in the braces of a container: it is there where that is."""
        if node.into is not None:
            self.report(
                codes.SYNTAX_ERROR,
                f"'{node.name}' stands in container '{container.name}', and is loaded there",
                node.into.span,
                "remove 'into', or take the node out of the container",
            )
        if node.host is not None:
            self.report(
                codes.SYNTAX_ERROR,
                f"'{node.name}' is loaded into container '{container.name}', and is where that is",
                node.host.span,
                "write 'on' behind the name of the container",
            )
        place = node.name_span
        into = Into(container.name, place, place, braces=container.name_span)
        when = both(container.when, node.when)
        return replace(node, into=into, when=when, host=container.host)
