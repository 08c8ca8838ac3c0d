"""The text of the Python monitor."""

from __future__ import annotations

from deros.generators.monitor.python.view import monitor_view
from deros.generators.text.python import LINE_LENGTH
from deros.generators.text.templates import environment
from deros.rules.program.ir import Program


def render_monitor(program: Program) -> str:
    """Return the text of a module that monitors a program.

    The module needs the standard library alone: no ROS, nothing of this package. Its class
    ``Monitor`` is driven as :class:`~deros.rules.engine.engine.Engine` is: one method per topic.
    """
    template = environment("deros.generators.monitor.python").get_template("monitor.py.j2")
    text: str = template.render(monitor=monitor_view(program))
    return "".join(f"{_exempt(line)}\n" for line in text.rstrip("\n").split("\n"))


def _exempt(line: str) -> str:
    """Excuse a line that cannot be broken, such as a long text, from the linter's limit."""
    return line if len(line) <= LINE_LENGTH else f"{line}  # noqa: E501"
