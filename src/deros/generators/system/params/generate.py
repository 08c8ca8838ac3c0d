"""The parameter file: the parameters of a system by the full names of its nodes."""

from __future__ import annotations

from collections.abc import Iterator

from deros import codes
from deros.diagnostics import Diagnostic, report
from deros.generators.api.protocol import Context, File, Files, GenerationError, Options
from deros.generators.system.described import not_made
from deros.generators.system.launched import LaunchView
from deros.generators.system.literals import comment
from deros.generators.system.programs import InsideView
from deros.generators.system.script.standalone.command_line import yaml
from deros.generators.system.unsupported import unread_by_container as unread
from deros.generators.system.view import NodeView, SystemView, system_view
from deros.generators.text.yaml import is_plain_key
from deros.models.common import Value
from deros.models.parameter_files import Document, ParameterFile
from deros.models.system import System
from deros.systems.flatten import flatten

Tree = dict[str, "Tree | _Leaf"]
_INDENT = "  "


class _Leaf:
    """The text of a value, as opposed to the mappings of names."""

    def __init__(self, value: Value) -> None:
        self.text = yaml(value)


def generate(model: System, context: Context, options: Options) -> Files:  # noqa: ARG001
    """Return the one parameter file.

    Raises:
        GenerationError: if a parameter has a value that the file cannot say.
    """
    if model.is_computed:
        raise GenerationError([_computed(model)])
    view = system_view(model, with_files=True)
    why = "a parameter file has values"
    flat = flatten(model)
    faults = [fault for node in flat.nodes for fault in (*not_made(node, why), *unread(node))]
    faults += map(_looked_up, (each for each in flat.files if _looks_up(each)))
    if faults:
        raise GenerationError(faults)
    return {f"{view.stem}.params.yaml": File(render(view))}


def _looks_up(file: ParameterFile) -> bool:
    return isinstance(file.load(), Document) and not file.is_known


def _looked_up(file: ParameterFile) -> Diagnostic:
    return report(
        codes.UNSUPPORTED_BY_TARGET,
        f"a parameter file has values, and '{file.path}' takes some from where it is started",
        file.path_span,
        "start the system with 'deros up', the script or the launch file",
    )


def _computed(model: System) -> Diagnostic:
    return report(
        codes.UNSUPPORTED_BY_TARGET,
        "a parameter file has values, and this system computes its own from arguments",
        model.name_span,
        "start it with 'deros up', the script or the launch file",
    )


def render(view: SystemView) -> str:
    """Return the file's text; nodes that the system gives no parameters are not in it."""
    lines = [comment(f"Parameters of the system {view.name}")]
    for node in _nodes(view):
        if node.parameters:
            lines += ["", *_node(node)]
    return "\n".join(lines) + "\n"


def _nodes(view: SystemView) -> Iterator[NodeView | InsideView]:
    """Yield all nodes, each program's own before the others in its process."""
    for program in view.programs:
        if isinstance(program, NodeView):
            yield program
        if not isinstance(program, LaunchView):
            yield from program.inside


def _node(node: NodeView | InsideView) -> Iterator[str]:
    yield f"{_key(node.full_name)}:"
    yield f"{_INDENT}ros__parameters:"
    yield from _lines(_tree(tuple(node.plain_parameters)), 2)


def _tree(parameters: tuple[tuple[str, Value], ...]) -> Tree:
    """Nest ``a.b`` under ``a``, unless ``a`` is a parameter itself: ROS 2 reads either form."""
    names = {name for name, _ in parameters}
    root: Tree = {}
    for name, value in parameters:
        words = name.split(".")
        depth = len(words) - 1
        if any(".".join(words[:end]) in names for end in range(1, depth + 1)):
            depth = 0
        tree = root
        for word in words[:depth]:
            branch = tree.setdefault(word, {})
            assert isinstance(branch, dict)
            tree = branch
        tree[".".join(words[depth:])] = _Leaf(value)
    return root


def _lines(tree: Tree, depth: int) -> Iterator[str]:
    for name, below in tree.items():
        head = f"{_INDENT * depth}{_key(name)}:"
        if isinstance(below, _Leaf):
            yield f"{head} {below.text}"
        else:
            yield head
            yield from _lines(below, depth + 1)


def _key(name: str) -> str:
    return name if is_plain_key(name) else yaml(name)
