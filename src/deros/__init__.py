"""deros: describe, check and generate ROS 2 nodes, systems and safety monitors."""

__version__ = "0.1.0"
