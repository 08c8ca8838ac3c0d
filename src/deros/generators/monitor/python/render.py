"""The texts of the Python monitor."""

from __future__ import annotations

from deros.generators.monitor.python.view import laid_out, view_of
from deros.generators.monitor.python.whys import explanation_view
from deros.generators.text.python import LINE_LENGTH
from deros.generators.text.templates import environment
from deros.rules.program.ir import Program

MONITOR = "monitor.py"
EXPLANATION = "explanation.py"


def render_monitor(program: Program) -> dict[str, str]:
    """Return the texts of two modules of one package that monitor a program, by their file names.

    They need the standard library alone, and numpy if rules read arrays: no ROS, nothing of deros.
    The class ``Monitor`` of the first is driven as :class:`~deros.rules.engine.engine.Engine` is,
    with one method per topic, and decides everything. ``ExplainedMonitor`` of the second adds
    ``explain()``.
    """
    running, layout = laid_out(program)
    views = {
        MONITOR: view_of(program, running, layout),
        EXPLANATION: explanation_view(program, running, layout),
    }
    templates = environment("deros.generators.monitor.python")
    return {
        name: _with_exemptions(templates.get_template(f"{name}.j2").render(view=view))
        for name, view in views.items()
    }


def _with_exemptions(text: str) -> str:
    return "".join(f"{_exempt(line)}\n" for line in text.rstrip("\n").split("\n"))


def _exempt(line: str) -> str:
    """Excuse a line that cannot be broken, such as a long text, from the linter's limit."""
    return line if len(line) <= LINE_LENGTH else f"{line}  # noqa: E501"
