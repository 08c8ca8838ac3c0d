"""What people write for a thing that is imported, too, takes its place."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from deros.diff.changes import matched
from deros.importers.kept.otherwise import one_line, otherwise
from deros.importers.kept.removal import without
from deros.importers.kept.statements import Statement, statements
from deros.importers.results import Missing, Parts
from deros.metamodels.load import Repository
from deros.models.node import NodeType
from deros.models.system import Subsystem, System


def amended(parts: Parts, head: str, path: Path) -> tuple[str, list[Missing]]:
    """Return the imported part without what stands in the upper one, and how that differs.

    Args:
        parts: of the file, as the import writes it.
        head: the upper part that people have written.
        path: of the file; what its imports find decides about the types of nodes.
    """
    if head.strip() == parts.head.strip():
        return parts.body, []
    beginning = f"{parts.head}\n"
    mine = _statements(head, path)
    theirs = [
        each
        for each in _statements(beginning + parts.body, path)
        if each.span.start >= len(beginning)
    ]
    pairs, _, rest = matched((lambda s: s.keys[0], lambda s: s.keys[-1]), mine, theirs)
    replaced = [imported for _, imported in pairs]
    found = [
        Missing(f"{own.what}:", text, str(path), own.span.line)
        for own, imported in pairs
        for text in otherwise(own, imported)
    ]
    found += _lost(pairs, rest, path)
    places = [
        (each.span.start - len(beginning), each.span.end - len(beginning))
        for each in (*replaced, *_emptied(rest, replaced))
    ]
    return without(parts.body, places), sorted(found, key=lambda each: each.line)


def _statements(text: str, path: Path) -> list[Statement]:
    """Return the statements of a text; none if not even its head can be read."""
    model = Repository().load_text(path, text).model
    return statements(model) if isinstance(model, NodeType | System) else []


def _lost(
    pairs: Sequence[tuple[Statement, Statement]], rest: Sequence[Statement], path: Path
) -> Iterator[Missing]:
    """Yield what goes with the group around it, and is not in the group of the user."""
    for each in rest:
        around = [(own, group) for own, group in pairs if _is_in(each, group)]
        if around:
            own, _ = around[-1]
            yield Missing(f"{own.what}:", one_line(each.span), str(path), own.span.line)


def _emptied(rest: Sequence[Statement], replaced: Sequence[Statement]) -> Iterator[Statement]:
    """Yield the subsystems in which nothing is left, the innermost first."""
    gone = list(replaced)
    for group in reversed(rest):
        part = group.part
        if isinstance(part, Subsystem) and part.launch is None and part.system_name is None:
            inside = [each for each in gone if _is_in(each, group)]
            if inside and not any(_is_in(e, group) and e not in gone for e in rest):
                gone.append(group)
                yield group


def _is_in(inner: Statement, outer: Statement) -> bool:
    return outer.span.start < inner.span.start and inner.span.end <= outer.span.end
