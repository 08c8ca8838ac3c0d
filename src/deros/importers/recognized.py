"""Which files are launch files, and which hold parameters."""

from __future__ import annotations

import re
from pathlib import Path

_XML = re.compile(r"(?:[._]launch\.xml|\.launch)$")
_YAML = re.compile(r"[._]launch\.ya?ml$")
_ROOTS = {
    ".xml": re.compile(rb"<launch\b"),
    ".yaml": re.compile(rb"^launch\s*:", re.MULTILINE),
    ".yml": re.compile(rb"^launch\s*:", re.MULTILINE),
    ".py": re.compile(rb"^def generate_launch_description\b", re.MULTILINE),
}
_PARAMETERS = re.compile(rb"^\s+[\"']?ros__parameters[\"']?\s*:", re.MULTILINE)
_LOOKED_AT = 1 << 16
"""Bytes of a file whose name says too little."""


def is_launch_xml(path: Path) -> bool:
    """Return whether a file is a launch file in XML."""
    return _XML.search(path.name) is not None or (path.suffix == ".xml" and _begins(path))


def is_launch_yaml(path: Path) -> bool:
    """Return whether a file is a launch file in YAML."""
    is_one = path.suffix in (".yaml", ".yml") and _begins(path)
    return _YAML.search(path.name) is not None or is_one


def is_launch_python(path: Path) -> bool:
    """Return whether a file is a launch file in Python."""
    return path.suffix == ".py" and (path.stem.endswith((".launch", "_launch")) or _begins(path))


def is_parameter_file(path: Path) -> bool:
    """Return whether a file has parameters of nodes."""
    return path.suffix in (".yaml", ".yml") and _has(path, _PARAMETERS)


def _begins(path: Path) -> bool:
    return _has(path, _ROOTS[path.suffix])


def _has(path: Path, mark: re.Pattern[bytes]) -> bool:
    try:
        if not path.is_file():
            return False
        with path.open("rb") as file:
            return mark.search(file.read(_LOOKED_AT)) is not None
    except OSError:
        return False
