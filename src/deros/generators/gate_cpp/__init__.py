"""The gates of safety rules as rclcpp nodes, each beside the safety node in the same package."""

from deros.generators.gate_cpp.generate import Gates, gate_files
from deros.generators.gate_cpp.node import gate_nodes

__all__ = ["Gates", "gate_files", "gate_nodes"]
