"""Golden files that differ in little from those of another package: kept as the difference.

Such a file says which one it is like, and what takes the place of which name. Unless that is all,
the number of lines that both have follows, the number of lines that only the other one has, and the
lines that only this one has. So both together have all that the file has, and what they share is
read once. Lines of templates count as the line that names them.
"""

from __future__ import annotations

import difflib
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from deros.generators.api.protocol import File, Files, Owner
from tests.support.golden import with_copies_listed
from tests.support.golden_templates import shortened


class Part(NamedTuple):
    """Files of one node.

    Attributes:
        folder: where they are kept, below ``tests/golden``.
        package: its name, which the paths and texts have.
        node: its name, likewise.
        files: by path, the list of the runtime's copies in place of these.
    """

    folder: str
    package: str
    node: str
    files: Files

    def replaced(self, other: Part) -> dict[str, str]:
        """Return what takes the place of what where those of another node are like these."""
        return forms(other.package, self.package) | forms(other.node, self.node)


def parts_of(folder: str, package: str, nodes: Sequence[str], files: Files) -> list[Part]:
    """Return the files of each node; the first one has those that do not belong to another."""
    listed = with_copies_listed(files)
    owners = {path: next((n for n in nodes if n in path), nodes[0]) for path in listed}
    return [
        Part(folder, package, node, {path: listed[path] for path in listed if owners[path] == node})
        for node in nodes
    ]


def unlike_those_before(folder: str, parts: Sequence[Part]) -> Files:
    """Return what is kept in a folder, each file as its difference from the most similar one.

    A file of whose lines more than half are its own is easier to read than its difference, and
    stays whole.

    Args:
        folder: where some of the parts are kept.
        parts: in the order in which they are read; one is like those before it.
    """
    kept: dict[str, File] = {}
    for number, part in enumerate(parts):
        for path, file in part.files.items() if part.folder == folder else ():
            found = [each for other in parts[:number] for each in _differences(path, part, other)]
            short = [each for each in found if _is_short(each, file.text)]
            if short:
                text = min(short, key=lambda each: each.count("\n"))
                kept[f"{path}.diff"] = File(text, Owner.USER)
            else:
                kept[path] = file
    return kept


def forms(old: str, new: str) -> dict[str, str]:
    """Return what takes the place of what where a name takes that of another one."""
    spelled = ((each, each.title().replace("_", ""), each.upper()) for each in (old, new))
    return {one: another for one, another in zip(*spelled, strict=True) if one != another}


def difference(text: str, other: str) -> Iterator[str]:
    """Yield how a text differs from another one, line by line."""
    old, new = other.split("\n"), text.split("\n")
    matcher = difflib.SequenceMatcher(None, old, new, autojunk=False)
    for kind, i, j, start, end in matcher.get_opcodes():
        if kind == "equal":
            yield f" {j - i} lines"
        elif j > i:
            yield f"-{j - i} lines"
        if kind != "equal":
            yield from (f"+{line}" for line in new[start:end])


def _differences(path: str, part: Part, other: Part) -> Iterator[str]:
    """Yield how a file differs from each that has its path, owner and mode in another part."""
    file, names = part.files[path], part.replaced(other)
    for like, one in other.files.items():
        same = (one.owner, one.executable) == (file.owner, file.executable)
        if same and _renamed(like, names) == path:
            changes = ", ".join(f"{old} → {new}" for old, new in list(names.items())[::3])
            changed = f" ({changes})" if changes else ""
            text, own = shortened(_renamed(one.text, names)), shortened(file.text)
            lines = difference(own, text) if own != text else ()
            yield "\n".join([f"like {other.folder}/{like}{changed}", *lines, ""])


def _is_short(found: str, text: str) -> bool:
    own = found.count("\n+")
    return found.count("\n") < shortened(text).count("\n") and 2 * own <= text.count("\n")


def _renamed(text: str, names: dict[str, str]) -> str:
    for old, new in names.items():
        text = text.replace(old, new)
    return text
