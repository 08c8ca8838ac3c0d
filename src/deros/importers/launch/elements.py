"""The elements of a launch file that is imported."""

from __future__ import annotations

from pathlib import Path

from deros.importers.readers import UnreadableError, source_of
from deros.metamodels.launch_files.elements import Element, NotALaunchFile, NotRead
from deros.metamodels.launch_files.xml_elements import xml_elements
from deros.metamodels.launch_files.yaml_elements import yaml_elements


def element_of(path: Path, *, is_yaml: bool | None = None) -> Element:
    """Return the root of a launch file.

    Args:
        path: of the file.
        is_yaml: whether it is YAML; ``None``: its name tells.

    Raises:
        UnreadableError: it cannot be read, or is no launch file.
    """
    if is_yaml is None:
        is_yaml = path.suffix in (".yaml", ".yml")
    try:
        source = source_of(path)
        root = yaml_elements(source) if is_yaml else xml_elements(source)
    except NotALaunchFile as refused:
        span, message = refused.fault.span, refused.fault.message
        raise UnreadableError(f"{path}:{span.line}:{span.column}: {message}") from refused
    except NotRead as refused:
        message = f"{path} declares entities, is nested too deep or has too many elements"
        raise UnreadableError(message) from refused
    if root.tag != "launch":
        message = f"a launch file begins with 'launch', and this one with '{root.tag}'"
        raise UnreadableError(f"{path}:{root.span.line}: {message}")
    return root
