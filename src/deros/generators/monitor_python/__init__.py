"""The monitor in Python: one pure module, straight-line code with one-shot deadlines."""

from deros.generators.monitor_python.handlers import Handler, Parameter
from deros.generators.monitor_python.render import render_monitor
from deros.generators.monitor_python.view import MonitorView, monitor_view

__all__ = ["Handler", "MonitorView", "Parameter", "monitor_view", "render_monitor"]
