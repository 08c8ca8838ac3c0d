"""What ROS 2 has no way to say when a node is started."""

from __future__ import annotations

from collections.abc import Iterator

from deros import codes
from deros.diagnostics import Diagnostic, Span, report
from deros.models.common import Value
from deros.models.node import Parameter, ParameterType
from deros.models.parameter_files import Document, ParameterFile
from deros.names.graph_names import from_root
from deros.systems.arguments.symbolic import is_computed
from deros.systems.flat import FlatNode
from deros.systems.parameters.overrides import ALL_NODES, may_match
from deros.systems.remapping import wired_apart


def unsupported(node: FlatNode) -> Iterator[Diagnostic]:
    """Yield why a node cannot be started, or loaded into a container, as the model says."""
    instance = node.instance
    if node.type is None:
        message = f"unknown node type '{instance.type_name}'"
        yield report(codes.UNKNOWN_NODE_TYPE, message, instance.type_span)
        return
    yield from wired_apart(node)
    spans = {setting.name: setting.value_span for setting in instance.parameters}
    of_files = from_files(node)
    for name, value in node.parameters:
        if name in of_files:
            continue
        declared = node.type.parameter_for(name)
        if _has_spelling(declared, value) or is_default_that_has_no_spelling(declared, value):
            continue
        span: Span = spans.get(name, instance.name_span)
        what = "a byte array" if value else "an empty array"
        yield report(
            codes.UNSUPPORTED_BY_TARGET,
            f"parameter '{name}' cannot be set to {what}: ROS 2 has no spelling for it",
            span,
            hint="make it the default in the node description, or set it when the node runs",
        )


def _has_spelling(declared: Parameter | None, value: Value) -> bool:
    """Return whether rcl's YAML can express a value; the type of an empty array it cannot."""
    bytes_wanted = declared is not None and declared.type is ParameterType.BYTE_ARRAY
    return value != () and not bytes_wanted


def is_default_that_has_no_spelling(declared: Parameter | None, value: Value) -> bool:
    """Return whether a value need not be given, and cannot."""
    return declared is not None and declared.default == value and not _has_spelling(declared, value)


def from_files(node: FlatNode) -> frozenset[str]:
    """Return the parameters whose values are those of files that are read at the start."""
    settings = node.instance.parameters
    if node.container is not None and not unread_files(node):
        return frozenset()  # a container is given the values themselves
    return frozenset(each.name for each in settings if each.origin is not None)


def composed_node(node: FlatNode, why: str) -> Diagnostic:
    """Return the finding that a target cannot load a node into its container."""
    into = node.instance.into
    return report(
        codes.UNSUPPORTED_BY_TARGET,
        f"{why}: '{node.container}'",
        node.instance.name_span if into is None else into.span,
        "start it as a process of its own, with 'into NAME when CONDITION' and a condition that"
        " does not hold",
    )


def unread_files(node: FlatNode) -> tuple[ParameterFile, ...]:
    """Return the files of a node in a container whose values are not known before the start."""
    files = node.files if node.container is not None else ()
    return tuple(file for file in files if not file.is_known or _is_for_some_names(file, node))


def _is_for_some_names(file: ParameterFile, node: FlatNode) -> bool:
    """Return whether it depends on arguments what a file sets for a node: its name is computed."""
    full_name, document = from_root(node.full_name), file.load()
    if not is_computed(full_name) or not isinstance(document, Document):
        return False
    return any(
        may_match(each.key, node.instance.name)
        for each in document.sections
        if each.key not in (ALL_NODES, full_name)
    )


def unread_by_container(node: FlatNode) -> Iterator[Diagnostic]:
    """Yield the files of :func:`unread_files`, for a target that holds values."""
    for file in unread_files(node):
        span = file.path_span
        written = span.source.text[span.start : span.end].strip('"')
        yield report(
            codes.UNSUPPORTED_BY_TARGET,
            f"the values in '{written}' are passed to the container of"
            f" '{node.instance.name}', and the file cannot be read now",
            span,
            "source the setup file of its package, or write a path without arguments",
        )
