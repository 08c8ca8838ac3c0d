"""The safety node as safety packages use it, in every language."""

from deros.generators.safety_node.node import package_options, safety_node
from deros.generators.safety_node.view import shared_topics

__all__ = ["package_options", "safety_node", "shared_topics"]
