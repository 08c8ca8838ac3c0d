"""The files of a node that do not depend on its language."""

from __future__ import annotations

from deros.generators.api.protocol import File
from deros.generators.node.parameter_file import file_parameters
from deros.generators.text.notice import licensed_python
from deros.generators.text.python import mark_long_lines
from deros.generators.text.templates import environment
from deros.models.node import NodeType


def shared_files(node: NodeType, notice: str) -> dict[str, File]:
    """Return the launch file of a node and, if it has parameters, their file."""
    templates = environment("deros.generators.node")
    launch = templates.get_template("launch.py.j2").render(node=node)
    text = mark_long_lines(licensed_python(launch, notice))
    files = {f"{node.package}/launch/{node.name}.launch.py": File(text)}
    if node.parameters:
        entries = file_parameters(node)
        config = templates.get_template("config.yaml.j2").render(
            node=node,
            parameters=entries,
            configured=any(each.value is not None for each in entries),
        )
        files[f"{node.package}/config/{node.name}.yaml"] = File(config)
    return files
