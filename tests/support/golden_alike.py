"""Golden files that differ in little from another one: kept as the difference."""

from __future__ import annotations

import difflib
from collections.abc import Mapping, Sequence

from deros.generators.api.protocol import File, Files, Owner


def differences(files: Files, others: Files, names: Mapping[str, str]) -> Files:
    """Return files with the difference in place of each that is much like another one.

    A difference of more than half the lines of a file is harder to read than the file.

    Args:
        files: what is generated.
        others: what is compared with golden files as it is.
        names: what is to be replaced in the paths and texts of the others.
    """
    kept: dict[str, File] = dict(files)
    for path, other in others.items():
        like = _renamed(path, names)
        if like in kept:
            difference = _difference(kept[like], other, path, names)
            if 2 * difference.text.count("\n") <= kept[like].text.count("\n"):
                del kept[like]
                kept[f"{like}.diff"] = difference
    return kept


def unlike_the_first(files: Files, names: Sequence[str]) -> Files:
    """Return files of some nodes, those of all but the first one as differences from that one's."""
    first, *rest = names
    others = {path: file for path, file in files.items() if first in path}
    for name in rest:
        files = differences(files, others, forms(first, name))
    return files


def forms(old: str, new: str) -> dict[str, str]:
    """Return what takes the place of what where a name takes that of another one."""
    spelled = ((each, each.title().replace("_", ""), each.upper()) for each in (old, new))
    return dict(zip(*spelled, strict=True))


def _difference(file: File, other: File, path: str, names: Mapping[str, str]) -> File:
    """Return how a file differs from another one that has other names; places are left out."""
    assert (file.owner, file.executable) == (other.owner, other.executable), path
    old, new = (text.split("\n") for text in (_renamed(other.text, names), file.text))
    lines = list(difflib.unified_diff(old, new, n=1, lineterm=""))[2:]
    shown = ["@@" if line.startswith("@@") else line for line in lines]
    changes = ", ".join(f"{old} → {new}" for old, new in names.items())
    return File("\n".join([f"like {path} ({changes})", *shown, ""]), Owner.USER)


def _renamed(text: str, names: Mapping[str, str]) -> str:
    for old, new in names.items():
        text = text.replace(old, new)
    return text
