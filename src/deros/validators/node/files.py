"""Existence of files that parameters name, where it can be determined.

A path on the robot says nothing about this machine, and a file that a node writes need not exist.
So only two kinds of text count: ``package://PACKAGE/PATH`` (or ``share:PACKAGE/PATH``) of a package
that is installed here, and a relative path with a folder that lies beside the system's file and a
suffix that files of configuration, maps or models have.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from deros import codes
from deros.diagnostics import Diagnostic, Span, report
from deros.interfaces.files import entries, is_folder, status
from deros.interfaces.store import InterfaceStore
from deros.models.common import Value
from deros.models.node import NodeType
from deros.names.names import did_you_mean, near
from deros.systems.flat import FlatSystem

_IN_PACKAGE = re.compile(r"(?:package://|share:)(?P<package>[A-Za-z]\w*)/(?P<path>[^\0]+)")
_RELATIVE = re.compile(
    r"(?:\.{1,2}/)*(?P<top>\w[\w.+-]*)/(?:[\w.+ -]+/)*[\w.+ -]*\.(?P<suffix>\w{1,8})"
)
_SUFFIXES = re.compile(
    "bag|bt|cfg|conf|csv|dae|db3|engine|geojson|ini|jpg|json|lua|mcap|obj|onnx|osm|pbstream|pcd|pgm|"
    "ply|png|pt|pth|rviz|sdf|so|srdf|stl|tflite|toml|txt|urdf|world|xacro|xml|ya?ml",
    re.IGNORECASE,
)
_WRITTEN = re.compile(r"log|out|save|write|record|dump|store|dest|export", re.IGNORECASE)
"""Names of parameters whose files a node usually writes."""


def check_files(flat: FlatSystem, store: InterfaceStore) -> Iterator[Diagnostic]:
    """Yield findings for files that parameters set in ``flat``'s own file name."""
    folder = Path(flat.system.source.path).parent
    for node in flat.nodes:
        if node.instance.span.source is flat.system.source:
            for setting in node.instance.parameters:
                # What a relative path in a parameter file starts from is the node's business.
                beside = folder if setting.origin is None else None
                yield from _named(setting.name, setting.value, setting.value_span, beside, store)


def check_defaults(node: NodeType, store: InterfaceStore) -> Iterator[Diagnostic]:
    """Yield findings for files of packages that the defaults of a node name."""
    for parameter in node.parameters:
        if parameter.default is not None:
            span = parameter.default_span or parameter.name_span
            yield from _named(parameter.name, parameter.default, span, None, store)


def _named(
    parameter: str, value: Value, span: Span, folder: Path | None, store: InterfaceStore
) -> Iterator[Diagnostic]:
    for text in value if isinstance(value, tuple) else (value,):
        if not isinstance(text, str) or "/" not in text:
            continue
        if found := _IN_PACKAGE.fullmatch(text):
            share = store.share(found["package"])
            if share is not None and not _exists(share / found["path"]):
                where = f"package '{found['package']}' has no"
                yield _missing(parameter, where, found["path"], share, span)
        elif folder is not None and _is_missing(text, folder) and not _WRITTEN.search(parameter):
            yield _missing(parameter, "there is no", text, folder, span)


def _is_missing(text: str, folder: Path) -> bool:
    """Return whether a text looks like a path in an existing folder, but no such file exists."""
    found = _RELATIVE.fullmatch(text)
    if found is None or _SUFFIXES.fullmatch(found["suffix"]) is None:
        return False
    return is_folder(folder / text[: found.end("top")]) and not _exists(folder / text)


def _missing(parameter: str, where: str, path: str, root: Path, span: Span) -> Diagnostic:
    message = f"{where} file '{path}', which parameter '{parameter}' names"
    return report(codes.NO_SUCH_FILE, message, span, _hint(root / path))


def _hint(path: Path) -> str:
    if not is_folder(path.parent):
        return "its folder does not exist either"
    names = [each.name for each in entries(path.parent)]
    alike = near(path.name, (each for each in names if each.endswith(path.suffix)))
    return did_you_mean(alike, path.name)


def _exists(path: Path) -> bool:
    """Return whether there is a file, or it cannot be known."""
    return status(path) != ""
