"""Where a thing is declared and used, and its renaming in all files that are known."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path

from lsprotocol import types

from deros.diagnostics import Span
from deros.lsp.analysis import Analysis
from deros.lsp.places import Places, uri_of
from deros.names.names import check_identifier, check_topic_name
from deros.systems.known_topics import KnownTopic
from deros.words.words import Word, WordKind, place_of

_RENAMED = frozenset(
    {
        WordKind.NODE_TYPE,
        WordKind.SYSTEM,
        WordKind.NODE,
        WordKind.SUBSYSTEM,
        WordKind.PROCESS,
        WordKind.HOST,
        WordKind.ARGUMENT,
        WordKind.PARAMETER,
        WordKind.PORT,
        WordKind.TIMER,
        WordKind.CONSTANT,
        WordKind.INPUT,
        WordKind.ZONE,
        WordKind.ENTITY,
        WordKind.RULE,
        WordKind.ACTION,
        WordKind.BEHAVIOUR,
        WordKind.UNIT,
    }
)


class NotRenamed(Exception):  # noqa: N818 - it is an answer
    """Why a word cannot be renamed."""


def definitions(places: Places, word: Word) -> Iterator[types.Location]:
    """Yield where a thing is declared: of a topic, where the system mentions it first."""
    if word.declared is not None:
        yield places.location(word.declared)
    elif word.kind is WordKind.FILE and isinstance(word.meaning, tuple):
        for path in word.meaning:
            start = types.Position(0, 0)
            yield types.Location(uri_of(path), types.Range(start, start))
    elif isinstance(word.meaning, KnownTopic):
        yield places.location(word.meaning.place)


def uses(analyses: Iterable[Analysis], word: Word) -> list[Span]:
    """Return all places of a thing in the files that the analyses know, each once."""
    found: dict[tuple[str, int], Span] = {}
    for analysis in analyses:
        for index in analysis.indexes:
            for each in index.of(word.key):
                found.setdefault(place_of(each.span), each.span)
    return [found[key] for key in sorted(found)]


def may_be_renamed(word: Word) -> bool:
    """Return whether a word is the name of something that a model declares."""
    return word.kind in _RENAMED and word.declared is not None


def renamed(
    places: Places, analyses: Iterable[Analysis], word: Word, name: str
) -> types.WorkspaceEdit:
    """Return the edits that give a thing another name, in all files that are known.

    Raises:
        NotRenamed: the name is none, or the thing cannot be renamed.
    """
    if not may_be_renamed(word):
        raise NotRenamed(f"a {word.kind.value} cannot be renamed here")
    is_in_graph = word.kind in (WordKind.PORT, WordKind.PARAMETER)
    fault = check_topic_name(name.replace(".", "/")) if is_in_graph else check_identifier(name)
    if fault is not None:
        raise NotRenamed(f"'{name}' {fault}")
    changes: dict[str, list[types.TextEdit]] = {}
    for span in uses(analyses, word):
        if span.text.removeprefix("/") != word.span.text.removeprefix("/"):
            raise NotRenamed(
                f"'{span.text}' in {Path(span.file).name} means it, too, and is written otherwise"
            )
        changes.setdefault(uri_of(span.file), []).append(types.TextEdit(places.range(span), name))
    return types.WorkspaceEdit(changes)


def word_at(analysis: Analysis, places: Places, position: types.Position) -> Word | None:
    """Return the word at a position."""
    return analysis.index.at(places.offset(analysis.source, position))
