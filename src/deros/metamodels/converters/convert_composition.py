"""Containers, and the nodes that are loaded into them."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from deros import codes
from deros.metamodels.converters.convert_arguments import ArgumentConverter
from deros.models.arguments import Condition, Joined
from deros.models.common import Name
from deros.models.composition import CONTAINER, Into, container_type
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
        if what in ("intra_process", "own_name"):
            return {what: self.span(modifier)}
        if what == "into":
            container, container_from = self.computed_name(modifier.container)
            when = None if modifier.when is None else self.condition(modifier.when.condition)
            place = self.token_span(modifier.container)
            return {"into": Into(container, self.span(modifier), place, container_from, when)}
        return {_KIND: str(modifier.kind)}

    def container(self, found: Any, settings: dict[str, Any]) -> NodeInstance:
        """Return a container, given what its modifiers set: a node, without those in it."""
        span = self.token_span(found.name)
        node_type = container_type(settings.pop(_KIND, "single_threaded"), self.source, span)
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
        place = node.name_span
        into = Into(container.name, place, place, braces=container.name_span)
        return replace(node, into=into, when=both(container.when, node.when))


def both(outer: Condition | None, inner: Condition | None) -> Condition | None:
    """Return the condition that two others hold; ``None``: always."""
    if outer is None or inner is None:
        return outer or inner
    return Joined("and", (outer, inner), inner.span)
