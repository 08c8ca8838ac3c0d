"""What other parts of the generators use of packages in Python."""

from deros.generators.node.python.generate import package_files
from deros.generators.node.python.view import NodeView, PortView, interface_imports, node_view

__all__ = ["NodeView", "PortView", "interface_imports", "node_view", "package_files"]
