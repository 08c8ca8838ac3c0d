"""Nodes in the processes of others, in a launch file: the words that a program gets for them."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from deros import codes
from deros.diagnostics import Diagnostic, report
from deros.generators.system.computed import joined
from deros.generators.system.expanded import programs_in
from deros.generators.system.files import FileView
from deros.generators.system.programs import (
    InsideView,
    NodeView,
    ProcessView,
    elsewhere,
    names_inside,
    remappings_of,
)
from deros.generators.system.view import SystemView
from deros.models.system import System
from deros.systems.flat import FlatNode

IMPORTS = (
    *("Substitution", "evaluate_parameters", "make_namespace_absolute", "normalize_parameters"),
    *("normalize_to_list_of_substitutions", "perform_substitutions", "prefix_namespace"),
)
"""What the classes need that write names and parameters of one node among several."""

Python = Callable[[object], str]
"""Returns a text, or what it is computed from, as Python."""


def is_addressed(program: NodeView | ProcessView) -> bool:
    """Return whether parameters go under the full name of their node.

    launch itself does that for nodes that it gives a name, and gives those of others to all nodes
    of the process; a file that names the node would then count before.
    """
    if isinstance(program, ProcessView):
        return bool(program.inside)
    return bool(program.inside) or (program.own_name and bool(program.files))


def addresses(view: SystemView) -> bool:
    """Return whether a launch file needs the classes for names and parameters of single nodes."""
    programs = (each for each in view.programs if isinstance(each, NodeView | ProcessView))
    return any(
        is_addressed(each) and (with_parameters(each) or elsewhere(each)) for each in programs
    )


def name_rules(program: NodeView | ProcessView, python: Python) -> Iterator[str]:
    """Yield the words, as Python, that keep nodes from the name and namespace of their process."""
    for name in names_inside(program):
        yield python("-r")
        yield python(f"{name}:__node:={name}")
    for node in elsewhere(program):
        yield python("-r")
        yield f"[{python(f'{node.name}:__ns:=')}, FullName({python(node.namespace)})]"


def process_words(
    process: ProcessView, python: Python, path: Callable[[FileView], str]
) -> Iterator[str]:
    """Yield the words, as Python, that a process is given for nodes in it, but for parameters."""
    yield from name_rules(process, python)
    for name, target in remappings_of(process):
        yield python("-r")
        texts = (python(joined(name, ":=")), python(target))
        yield f"[{', '.join(each.removeprefix('[').removesuffix(']') for each in texts)}]"
    for file in process.files:
        yield python("--params-file")
        yield path(file)


def unwatched(model: System, view: SystemView) -> Iterator[Diagnostic]:
    """Yield the nodes that launch cannot bring to active, since it does not give them their names.

    It watches, and asks, managed nodes by the names that it starts them with.
    """
    if not any(node.own_name and node.autostart is not None for node in view.nodes):
        return
    reported = set()
    for node in (each for each in programs_in(model) if isinstance(each, FlatNode)):
        place = node.instance.own_name
        if place is not None and node.autostart is not None and place not in reported:
            reported.add(place)
            yield report(
                codes.UNSUPPORTED_BY_TARGET,
                f"launch brings only nodes to active that it names, and '{node.instance.name}' has"
                " its own name",
                place,
                "remove 'own_name' if its process has no other node, or start the system with"
                " 'deros up' or the script",
            )


def with_parameters(program: NodeView | ProcessView) -> tuple[InsideView | NodeView, ...]:
    """Return the nodes of a process that are given parameters."""
    own = (program,) if isinstance(program, NodeView) else ()
    nodes: tuple[InsideView | NodeView, ...] = (*own, *program.inside)
    return tuple(node for node in nodes if node.parameters or node.described)
