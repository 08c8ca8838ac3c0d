"""What other parts of the generators use of node descriptions, whatever the language."""

from deros.generators.node.description import node_description

__all__ = ["node_description"]
