"""What other parts of the generators use of packages in C++."""

from deros.generators.node.cpp.generate import package_files
from deros.generators.node.cpp.qos import qos_expression
from deros.generators.node.cpp.view import Provided, client_member

__all__ = ["Provided", "client_member", "package_files", "qos_expression"]
