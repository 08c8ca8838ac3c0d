"""The interface of gates in Python for safety packages."""

from deros.generators.gate.nodes import gate_nodes
from deros.generators.gate.python.generate import gate_files

__all__ = ["gate_files", "gate_nodes"]
