"""The interface of node descriptions for other generators."""

from deros.generators.node.description import node_description

__all__ = ["node_description"]
