"""The interface of the monitor in Python for other generators."""

from deros.generators.monitor.python.handlers import Handler, Parameter
from deros.generators.monitor.python.render import EXPLANATION, MONITOR, render_monitor
from deros.generators.monitor.python.view import MonitorView, monitor_view

__all__ = [
    "EXPLANATION",
    "MONITOR",
    "Handler",
    "MonitorView",
    "Parameter",
    "monitor_view",
    "render_monitor",
]
