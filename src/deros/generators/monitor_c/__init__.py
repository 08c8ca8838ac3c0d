"""The monitor as C99: what a program means, for machines that have neither ROS nor a heap."""

from deros.generators.monitor_c.layout import Layout, lay_out
from deros.generators.monitor_c.render import render_monitor

__all__ = ["Layout", "lay_out", "render_monitor"]
