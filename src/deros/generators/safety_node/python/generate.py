"""The files of the safety node in Python, besides those of every node."""

from __future__ import annotations

from deros.generators.api.protocol import File, Owner
from deros.generators.safety_node.python.view import SafetyView
from deros.generators.text.notice import licensed_python
from deros.generators.text.python import Text, call, expression, mark_long_lines
from deros.generators.text.templates import environment


def node_files(view: SafetyView, copyright_line: str) -> dict[str, File]:
    """Return the node's class, the metadata of its rules, and the classes of the user's actions."""
    root = f"{view.package}/{view.package}"
    files = {
        f"{root}/{view.node.module}.py": File(_render("node.py", view, copyright_line)),
        f"{root}/rule_metadata.py": File(_render("rule_metadata.py", view, copyright_line)),
    }
    if view.actions:
        base = _render("actions_base.py", view, copyright_line)
        user = _render("actions.py", view, copyright_line)
        files[f"{root}/{view.actions_module}_base.py"] = File(base)
        files[f"{root}/{view.actions_module}.py"] = File(user, Owner.USER)
    return files


def _render(template: str, view: SafetyView, copyright_line: str) -> str:
    loaded = environment("deros.generators.safety_node.python").get_template(f"{template}.j2")
    text = loaded.render(safety=view, node=view.node, Text=Text, call=call, expression=expression)
    return mark_long_lines(licensed_python(text, copyright_line))
