"""The interface of the monitor in C for other generators: its struct, and what reads it."""

from deros.generators.monitor.c.code.expressions import SYMBOLS, Conditions, known_of
from deros.generators.monitor.c.code.handlers import Parameter
from deros.generators.monitor.c.code.layout import Layout, Term, lay_out
from deros.generators.monitor.c.code.literals import integer
from deros.generators.monitor.c.code.rule_functions import Site
from deros.generators.monitor.c.code.value_types import compared
from deros.generators.monitor.c.code.view import MonitorView, monitor_view
from deros.generators.monitor.c.render import render_monitor

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
