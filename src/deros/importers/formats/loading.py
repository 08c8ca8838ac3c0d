"""Files of other tools, read as trees of YAML; JSON is YAML, too."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from deros.diagnostics import SourceFile, Span
from deros.importers.readers import UnreadableError, source_of
from deros.importers.results import Missing
from deros.live.observer import printable
from deros.metamodels.yaml_trees.tree import Mapping, NotATreeError, Sequence, Tree, tree_of


def mapping_of(source: SourceFile) -> Mapping:
    """Return the keys at the top of a text.

    Raises:
        UnreadableError: if it is not YAML, or has no keys at its top.
    """
    try:
        tree = tree_of(source)
    except NotATreeError as error:
        raise unreadable_at(error.fault.span, error.fault.message) from error
    if not isinstance(tree, Mapping):
        raise UnreadableError(f"{source.path}: this file has no keys at its top, as in 'name: …'")
    return tree


def unreadable_at(span: Span, why: str) -> UnreadableError:
    """Return the error for a place of a file."""
    return UnreadableError(f"{span.file}:{span.line}: {why}")


def top_of(path: Path) -> Mapping | None:
    """Return the keys at the top of a file; ``None`` where it has none, or cannot be read."""
    try:
        return mapping_of(source_of(path))
    except UnreadableError:
        return None


def unused_keys(tree: Tree) -> Iterator[Missing]:
    """Yield the keys of a tree that no reader gets to see: repeated ones, and those without text.

    What stands in several places with an alias is looked at once.
    """
    waiting, seen = [tree], set()
    while waiting:
        each = waiting.pop()
        if id(each) in seen:
            continue
        seen.add(id(each))
        if isinstance(each, Sequence):
            waiting += reversed(each.items)
        elif isinstance(each, Mapping):
            for span in each.repeated:
                yield missing("a key", "comes again below, and the last one counts", span)
            for span in each.unnamed:
                yield missing("a key", "is left out: it is not a text", span)
            waiting += reversed(each.entries.values())


def missing(what: str, why: str, span: Span) -> Missing:
    """Return what is missing of a place, in characters that can be shown."""
    return Missing(shown(what), shown(why), span.file, span.line)


def shown(text: str) -> str:
    """Return a text in one line, with a question mark for what cannot be shown."""
    return printable(" ".join(text.split()))
