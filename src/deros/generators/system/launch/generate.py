"""The launch file: one ``Node`` action for each node, grouped as the model groups them."""

from __future__ import annotations

from collections.abc import Iterator

from deros.generators.api.protocol import Context, File, Files, Options
from deros.generators.system.literals import comment, python_literal
from deros.generators.system.view import SystemView, system_view
from deros.generators.text.python import mark_long_lines
from deros.generators.text.templates import environment
from deros.models.system import System


def generate(model: System, context: Context, options: Options) -> Files:  # noqa: ARG001
    """Return the one launch file.

    Raises:
        GenerationError: if a node cannot be started as the model says.
    """
    view = system_view(model)
    return {f"{view.stem}.launch.py": File(render(view))}


def render(view: SystemView) -> str:
    """Return the launch file's text."""
    made = environment("deros.generators.system.launch")
    made.filters["python"] = python_literal
    made.filters["comment"] = comment
    text = made.get_template("launch.py.j2").render(system=view, imports="\n".join(_imports(view)))
    return mark_long_lines(text)


def _imports(view: SystemView) -> Iterator[str]:
    actions = {"LifecycleNode" if node.lifecycle else "Node" for node in view.nodes}
    yield "from launch import LaunchDescription"
    if actions:
        yield f"from launch_ros.actions import {', '.join(sorted(actions))}"
