"""The interface of the monitor in C for other generators: its struct, and what reads it."""

from deros.generators.monitor.c.expressions import SYMBOLS, Conditions, known_of
from deros.generators.monitor.c.handlers import Parameter
from deros.generators.monitor.c.layout import Layout, Term, lay_out
from deros.generators.monitor.c.literals import integer
from deros.generators.monitor.c.render import render_monitor
from deros.generators.monitor.c.rule_functions import Site
from deros.generators.monitor.c.value_types import compared
from deros.generators.monitor.c.view import MonitorView, monitor_view

__all__ = [
    "SYMBOLS",
    "Conditions",
    "Layout",
    "MonitorView",
    "Parameter",
    "Site",
    "Term",
    "compared",
    "integer",
    "known_of",
    "lay_out",
    "monitor_view",
    "render_monitor",
]
