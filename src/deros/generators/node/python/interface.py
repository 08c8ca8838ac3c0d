"""The interface of packages in Python for other generators."""

from deros.generators.node.python.generate import package_files
from deros.generators.node.python.view import NodeView, PortView, interface_imports, node_view

__all__ = ["NodeView", "PortView", "interface_imports", "node_view", "package_files"]
