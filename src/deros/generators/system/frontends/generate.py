"""The launch file in XML or YAML: the same actions as those of the one in Python."""

from __future__ import annotations

from collections.abc import Callable

from deros.generators.api.protocol import File, Files, GenerationError
from deros.generators.system.empty_parts import without_empty_parts
from deros.generators.system.files import copies
from deros.generators.system.frontends.actions import Actions
from deros.generators.system.frontends.checked import (
    argument,
    checked_arguments,
    checked_files,
    checked_integers,
    checked_texts,
)
from deros.generators.system.frontends.elements import Element
from deros.generators.system.frontends.texts import Texts
from deros.generators.system.frontends.unsupported import unsupported_in_frontends
from deros.generators.system.frontends.xml import print_xml
from deros.generators.system.frontends.yaml import print_yaml
from deros.generators.system.launch.refilled import refilled
from deros.generators.system.launch.relative import relative
from deros.generators.system.view import SystemView, system_view
from deros.models.system import System
from deros.names.graph_names import ANY_ROOT
from deros.systems.running.placement import placed

_PRINTERS: dict[str, Callable[[Element, str], str]] = {"xml": print_xml, "yaml": print_yaml}


def generate(model: System, language: str) -> Files:
    """Return the launch file, and copies of the files that it names.

    Args:
        model: the system.
        language: ``xml`` or ``yaml``.

    Raises:
        GenerationError: if a program cannot be started as the model says; each of its reasons is
            named.
    """
    system = placed(model)
    view = without_empty_parts(relative(system_view(system, root=ANY_ROOT)))
    faults = [*unsupported_in_frontends(system, view), *refilled(system, view)]
    if faults:
        raise GenerationError(faults)
    said = f": {view.description}" if view.description else ""
    text = _PRINTERS[language](launch_element(view), f"Start the system {view.name}{said}")
    return {f"{view.stem}.launch.{language}": File(text), **copies(model, view)}


def launch_element(view: SystemView) -> Element:
    """Return the whole of a launch file."""
    texts = Texts(view)
    declarations = [argument(each, texts) for each in view.arguments]
    files = list(checked_files(view, texts))
    actions = list(Actions(view, texts).all())
    checks = list(checked_arguments(view, texts))  # which values stand between quotes, is now known
    checks += [*checked_integers(view, texts), *checked_texts(view, texts)]
    return Element("launch", children=(*texts.folder, *declarations, *checks, *files, *actions))
