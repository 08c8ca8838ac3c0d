"""The interface of the safety node in C++ for the safety package."""

from deros.generators.safety_node.cpp.generate import RUNTIME, node_files, provided, runtime_parts
from deros.generators.safety_node.cpp.node import twin_options
from deros.generators.safety_node.cpp.view import SafetyView, safety_view

__all__ = [
    "RUNTIME",
    "SafetyView",
    "node_files",
    "provided",
    "runtime_parts",
    "safety_view",
    "twin_options",
]
