"""The interface of gates in C++ for safety packages."""

from deros.generators.gate.cpp.generate import Gates, gate_files
from deros.generators.gate.cpp.node import gate_nodes

__all__ = ["Gates", "gate_files", "gate_nodes"]
