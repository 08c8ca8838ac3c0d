"""Suppression of findings that only follow from others.

Two things are known to be wrong before anything else is judged: statements that could not be read,
and names that mean nothing. A finding that says that something is missing is silent where a lost
statement mentions it: it may well be there. A finding that quotes a name which is unknown, and
reported as such, says nothing new; nor does one that misses a name that cannot be.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence

from deros import codes
from deros.diagnostics import ANY_NAME, Diagnostic, Span, last_word
from deros.metamodels.languages import DEROS, ROSSYSTEM
from deros.metamodels.load import LoadedFile
from deros.models.node import NodeType
from deros.names.names import near_any

_WORD = re.compile(r"\w+")
_TYPE = re.compile(r"\w+[./](?:\w+[./])?\w+")
_ADDING = frozenset({"import", "use", "safety"})
"""Statements that may add anything: a file, or the node and the gates of some rules."""

_UNKNOWN_IMPORT = frozenset({codes.UNKNOWN_IMPORT, codes.CYCLIC_IMPORT})
_REFUSED_NAME = frozenset(
    {codes.INVALID_ROS_NAME, codes.INVALID_SYSTEM_NAME, codes.INVALID_RULES_NAME}
)
_UNKNOWN_NAME = frozenset(
    {
        codes.UNKNOWN_NODE_TYPE,
        codes.UNKNOWN_PORT,
        codes.UNKNOWN_TOPIC,
        codes.UNKNOWN_PARAMETER,
        codes.UNKNOWN_SYSTEM,
        codes.UNKNOWN_NAME,
        codes.UNKNOWN_RESET,
        codes.UNKNOWN_USED_SYSTEM,
        codes.RULE_TOPIC_NOT_IN_SYSTEM,
    }
)
_UNKNOWN_SYSTEM = frozenset({codes.UNKNOWN_SYSTEM, codes.UNKNOWN_USED_SYSTEM})
_UNKNOWN_TYPE = frozenset({codes.UNKNOWN_PACKAGE, codes.UNKNOWN_TYPE, codes.UNUSABLE_DEFINITION})


def without_consequences(
    findings: Iterable[Diagnostic], causes: Sequence[Diagnostic], files: Iterable[LoadedFile]
) -> Iterator[Diagnostic]:
    """Yield the findings that are not mere consequences of one of ``causes``.

    Args:
        findings: the findings to filter.
        causes: all findings, reported or not.
        files: all files of the run.
    """
    lost = _lost_words(list(files))
    if any(each.code in _UNKNOWN_IMPORT for each in causes):
        lost.add(ANY_NAME)
    unlinked = any(each.code in _UNKNOWN_SYSTEM for each in causes)
    types = {_type_words(each.span.text) for each in causes if each.code in _UNKNOWN_TYPE}
    told = set(types)
    refused = {each.span for each in causes if each.code in _REFUSED_NAME}
    unknown = [each for each in causes if each.code in _UNKNOWN_NAME]
    kept = list(findings)
    absences = (each for each in kept if each.code.reports_absence)
    meant = _meant(unknown, (each for each in absences if each.code not in _UNKNOWN_NAME))
    differing = (
        each for cause in causes if cause.code is codes.UNITS_DIFFER for each in cause.related
    )
    compared = {each.span for each in differing}
    unfed = {_topic_of(each) for each in causes if each.code is codes.RULE_TOPIC_NOT_PUBLISHED}
    for each in kept:
        if lost and each.code is codes.UNUSED_ALLOWANCE:
            continue
        if each.code is codes.RULE_TYPE_UNKNOWN and _topic_of(each) in unfed:
            continue  # its publisher would tell the type
        if each.code is codes.SHARE_IN_ANOTHER_UNIT and each.span in compared:
            continue  # the error names this unit, and the other end
        if each.code.reports_absence:
            words = _words(each)
            if ANY_NAME in lost or not lost.isdisjoint(words) or each.span in refused:
                continue
            if each.code not in _UNKNOWN_NAME and (unlinked or not meant.isdisjoint(words)):
                continue
        if types and each.code not in _UNKNOWN_TYPE and _shows_type(each, types):
            continue
        if each.code is codes.UNUSABLE_DEFINITION and each.subjects:  # at a topic of this type
            if _shows_type(each, told):
                continue
            told.update(map(_type_words, each.subjects))
        yield each


def _meant(unknown: Sequence[Diagnostic], findings: Iterable[Diagnostic]) -> set[str]:
    """Return the words of findings that unknown names probably mean; these are not unused."""
    if not unknown:
        return set()  # as in most runs, which need no comparison of names
    words = {word for each in findings for word in _words(each)}
    meant = {last_word(name) for each in unknown for name in each.subjects}
    return meant | near_any((last_word(each.span.text) for each in unknown), words)


def _lost_words(files: list[LoadedFile]) -> set[str]:
    """Return the words of all statements that could not be read.

    Where a system, or rules, could not be read at all, anything may be lost. With a lost node
    instance, the ports of its type are lost, too.
    """
    lost = {word for each in files if each.source is not None for word in each.source.lost}
    if any(each.model is None and each.language in (ROSSYSTEM, DEROS) for each in files):
        lost.add(ANY_NAME)
    if not lost.isdisjoint(_ADDING):
        lost.add(ANY_NAME)  # it may have anything that is missing
    if lost:
        for each in files:
            if isinstance(each.model, NodeType) and each.model.name in lost:
                lost.update(last_word(port.name) for port in each.model.ports)
    return lost


def _words(finding: Diagnostic) -> set[str]:
    return {word for text in _texts(finding) for word in _WORD.findall(text)}


def _texts(finding: Diagnostic) -> Iterator[str]:
    """Yield the texts with the names that a finding is about."""
    yield from finding.subjects
    yield finding.span.text
    yield from (each.span.text for each in finding.related)


def _topic_of(finding: Diagnostic) -> Span | None:
    """Return where the topic that a finding is about is declared."""
    return finding.related[0].span if finding.related else None


def _type_words(text: str) -> tuple[str, ...]:
    words = _WORD.findall(text)
    return (words[0], words[-1]) if words else ()


def _shows_type(finding: Diagnostic, types: set[tuple[str, ...]]) -> bool:
    """Return whether what a finding is about has one of some types."""
    found = (each for text in _texts(finding) for each in _TYPE.findall(text))
    return any(_type_words(each) in types for each in found)
