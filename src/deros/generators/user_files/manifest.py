"""Checks the user's package.xml."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterator

from deros import codes
from deros.diagnostics import Diagnostic, SourceFile, Span, report

DEPENDENCIES = ("depend", "build_depend", "build_export_depend", "exec_depend")
"""The elements that name what a package needs to be built or to run."""

_BUILD_TYPE = "export/build_type"


def lacking(generated: str, present: SourceFile) -> Iterator[Diagnostic]:
    """Yield findings about what a manifest lacks of the one that would be generated.

    A dependency that it has besides is the user's business.
    """
    try:
        root = ElementTree.fromstring(present.text)
    except (ElementTree.ParseError, ValueError) as error:
        yield _finding(present, f"cannot be read: {error}", "", "")
        return
    wanted = ElementTree.fromstring(generated)
    for tag, what in (("name", "is of the package"), (_BUILD_TYPE, "has the build type")):
        ours, theirs = (each.findtext(tag, "").strip() for each in (wanted, root))
        if ours != theirs:
            message = f"{what} '{theirs}', and what is generated needs '{ours}'"
            yield _finding(present, message, tag.rpartition("/")[2], "")
    missing = sorted(named(wanted) - named(root))
    if missing:
        tag = next(t for t in DEPENDENCIES if any(_texts(wanted, t) & {*missing}))
        lines = " ".join(f"<{tag}>{each}</{tag}>" for each in missing)
        message = f"lacks what the generated code needs: {', '.join(missing)}"
        yield _finding(present, message, "package", f"add {lines}")


def named(manifest: ElementTree.Element) -> set[str]:
    """Return the packages that a manifest depends on."""
    return {name for tag in DEPENDENCIES for name in _texts(manifest, tag)}


def _texts(manifest: ElementTree.Element, tag: str) -> set[str]:
    return {(each.text or "").strip() for each in manifest.findall(tag)}


def _finding(source: SourceFile, message: str, tag: str, hint: str) -> Diagnostic:
    found = re.search(rf"<({tag})\b", source.text) if tag else None
    span = Span(source, *(found.span(1) if found else (0, 0)))
    return report(codes.INCOMPLETE_MANIFEST, f"package.xml {message}", span, hint)
