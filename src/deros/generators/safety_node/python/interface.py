"""What a safety package in Python needs of the safety node."""

from deros.generators.safety_node.python.generate import node_files
from deros.generators.safety_node.python.view import RUNTIME, SafetyView, safety_view

__all__ = ["RUNTIME", "SafetyView", "node_files", "safety_view"]
