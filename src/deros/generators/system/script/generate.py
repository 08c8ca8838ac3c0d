"""The script: the table of a system's nodes, and the code that runs them."""

from __future__ import annotations

from deros.generators.api.protocol import Context, File, Files, Options
from deros.generators.system.literals import comment, python_literal
from deros.generators.system.script.assemble import runtime
from deros.generators.system.script.standalone.node import Node
from deros.generators.system.view import SystemView, system_view
from deros.generators.text.python import LINE_LENGTH, mark_long_lines
from deros.generators.text.templates import environment
from deros.models.system import System


def generate(model: System, context: Context, options: Options) -> Files:  # noqa: ARG001
    """Return the one file of the script.

    Raises:
        GenerationError: if a node cannot be started as the model says.
    """
    view = system_view(model)
    return {f"{view.stem}.py": File(render(view), executable=True)}


def render(view: SystemView) -> str:
    """Return the script's text."""
    made = environment("deros.generators.system.script")
    made.filters["python"] = python_literal
    made.filters["comment"] = comment
    made.filters["rule"] = rule
    text = made.get_template("script.py.j2").render(system=view, runtime=runtime())
    return mark_long_lines(text)


def table(view: SystemView) -> tuple[Node, ...]:
    """Return the rows that the script's table holds, for running them without the script."""
    return tuple(
        Node(
            name=node.name,
            namespace=node.namespace,
            package=node.package,
            executable=node.executable,
            subsystem="/".join(group.path),
            parameters=dict(node.parameters),
            remappings=dict(node.remappings),
            log_level=node.log_level,
            respawn_delay=node.respawn_delay,
            respawn_max=node.respawn_max,
        )
        for group in view.groups
        for node in group.nodes
    )


def rule(title: str) -> str:
    """Return the comment line above a part of a file."""
    return f"# {title} ".ljust(LINE_LENGTH, "-")
