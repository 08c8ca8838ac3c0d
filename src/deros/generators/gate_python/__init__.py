"""The gates of safety rules as ROS 2 nodes, each beside the safety node in the same package."""

from deros.generators.gate_python.generate import gate_files
from deros.generators.gate_python.node import gate_nodes

__all__ = ["gate_files", "gate_nodes"]
