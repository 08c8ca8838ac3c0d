"""The Python safety node as safety packages use it."""

from deros.generators.safety_node.python.generate import node_files
from deros.generators.safety_node.python.view import SafetyView, safety_view

__all__ = ["SafetyView", "node_files", "safety_view"]
