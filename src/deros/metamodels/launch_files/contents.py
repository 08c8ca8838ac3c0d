"""What the elements of a launch file say: the arguments that it takes, and the nodes it starts."""

from __future__ import annotations

import re

from deros.diagnostics import SourceFile
from deros.metamodels.launch_files.elements import Element, NotALaunchFile
from deros.models.launch_files import DeclaredArgument, LaunchDocument

_NODES = frozenset({"node", "lifecycle_node", "node_container", "composable_node"})
_OTHERS = frozenset(
    {
        *("arg", "let", "group", "executable", "param", "remap", "env", "choice", "keep", "log"),
        *("timer", "shutdown", "set_env", "unset_env", "reset", "push_ros_namespace"),
        *("push_environment", "pop_environment", "reset_environment", "append_env"),
        *("set_parameter", "set_parameters_from_file", "set_remap", "set_use_sim_time"),
        *("load_composable_node", "extra_arg", "ros_timer", "log_info", "log_debug", "log_error"),
        *("log_warning", "ros_args"),
    }
)
"""Elements that start no node, and include no file."""
_USED = re.compile(r"\$\(\s*var\s+['\"]?([^\s)'\"]+)")


def document(source: SourceFile, path: str, root: Element) -> LaunchDocument:
    """Return what is known of a launch file.

    Raises:
        NotALaunchFile: its root is not ``launch``.
    """
    if root.tag != "launch":
        message = f"a launch file begins with 'launch', and this one with '{root.tag}'"
        raise NotALaunchFile(message, root.span, "correct the path, or the file")
    elements = list(root.below())
    texts = [text for each in elements for text in _texts(each)]
    conditional = {id(inner) for each in elements if _has_condition(each) for inner in each.below()}
    arguments: dict[str, DeclaredArgument] = {}
    nodes: set[str] = set()
    for each in elements:
        name = each.attributes.get("name", "")
        if each.tag == "arg" and name:
            is_sure = each.is_whole and not _has_condition(each) and id(each) not in conditional
            arguments.setdefault(name, _argument(each, is_sure))
        elif each.tag in _NODES:
            nodes.add(name)
    return LaunchDocument(
        source,
        path,
        arguments,
        frozenset(name for text in texts for name in _USED.findall(text)),
        frozenset(nodes),
        root.is_whole and all(map(_is_complete, elements)),
    )


def _texts(element: Element) -> list[str]:
    found = list(element.attributes.values())
    if element.tag == "include":
        found += (text for each in element.children for text in each.attributes.values())
    return found


def _has_condition(element: Element) -> bool:
    return "if" in element.attributes or "unless" in element.attributes


def _argument(element: Element, is_sure: bool) -> DeclaredArgument:
    choices = tuple(
        each.attributes["value"] for each in element.children if "value" in each.attributes
    )
    is_literal = is_sure and not any("$(" in each for each in choices)
    is_required = is_sure and "default" not in element.attributes
    return DeclaredArgument(element.span, choices if is_literal else (), is_required)


def _is_complete(element: Element) -> bool:
    """Return whether the names of an element are known, and there is nothing behind it."""
    name = element.attributes.get("name", "")
    if element.tag in _NODES and not name:
        return False  # the program itself chooses its name
    is_known = element.tag in _NODES or element.tag in _OTHERS
    return is_known and element.is_whole and "$(" not in name
