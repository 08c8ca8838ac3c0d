"""The sources of gates in C++, for the package of their safety node."""

from __future__ import annotations

from importlib import resources

from deros.generators.cpp_source import call, comment, mark_long_lines
from deros.generators.gate_cpp.source import condition, string_lines
from deros.generators.gate_cpp.view import GateView
from deros.generators.templates import environment


def render(template: str, view: GateView) -> str:
    """Return the text of one file of a gate: ``logic.hpp`` or ``logic.cpp``."""
    loaded = environment("deros.generators.gate_cpp").get_template(f"{template}.j2")
    text = loaded.render(
        gate=view, call=call, comment=comment, condition=condition, string_lines=string_lines
    )
    return mark_long_lines(text)


def runtime_text(name: str, package: str) -> str:
    """Return a file that is the same for all gates, in the namespace of a package."""
    folder = resources.files("deros.generators.gate_cpp.runtime")
    text = (folder / name).read_text(encoding="utf-8")
    return text.replace("DEROS_RUNTIME", package.upper()).replace("deros_runtime", package)
