"""What a safety package needs of the safety node, whatever the language."""

from deros.generators.safety_node.node import package_options, safety_node
from deros.generators.safety_node.view import shared_topics

__all__ = ["package_options", "safety_node", "shared_topics"]
