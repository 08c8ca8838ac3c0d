"""The tokens of a text as its grammar reads them, with what the layout of a text is made from.

A token here is a leaf of the parse tree, so a sign is what the parser took it for: the ``/`` of a
division is another token than that of a topic's name.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from arpeggio import OneOrMore, Optional, ParsingExpression, Sequence, ZeroOrMore

from deros.diagnostics import Diagnostic, SourceFile
from deros.metamodels.grammar import is_statement, literal_of
from deros.metamodels.languages import Language
from deros.metamodels.matching import DoesNotParse
from deros.metamodels.parsers import parse_tree
from deros.metamodels.reading import prepare, room_to_parse

_WRITTEN_TOGETHER = re.compile(r"\S+")
_PART_OF_PATH = re.compile(r'"(?:[^"\\]|\\.)*"|==?|[.\[\]]|[\w-]+')


@dataclass(frozen=True, slots=True)
class SyntaxToken:
    """A token, or a part of one that has blanks in it, as ``scan . ranges`` may have.

    Attributes:
        text: its characters, without blanks around them.
        start: the offset of its first character.
        end: the offset just past its last character.
        rule: the rule of the grammar that it matches by itself, ``Path``; empty for signs and words
            that the grammar quotes.
        within: the closest rule around it.
        level: how many blocks and sections it stands in.
        starts: whether a statement, or an entry of a block, begins with it.
        goes_on: whether it continues the token before it.
    """

    text: str
    start: int
    end: int
    rule: str
    within: str
    level: int
    starts: bool
    goes_on: bool = False


class HasSyntaxErrors(Exception):  # noqa: N818 - it is the answer to a question about a text
    """A text does not parse; ``diagnostics`` say where and why."""

    def __init__(self, diagnostics: tuple[Diagnostic, ...]) -> None:
        super().__init__(*(each.message for each in diagnostics))
        self.diagnostics = diagnostics


def syntax_tokens(source: SourceFile, language: Language) -> list[SyntaxToken]:
    """Return the tokens of a text in their order; comments are none of them.

    Raises:
        HasSyntaxErrors: the text does not parse.
        Unreadable: it is not even split into tokens, see :func:`~deros.metamodels.reading.prepare`.
    """
    text = prepare(source)
    with room_to_parse():
        try:
            tree = parse_tree(language, text)
        except DoesNotParse:
            raise HasSyntaxErrors(_syntax_errors(source, text, language)) from None
        return list(_Reading(text).tokens(tree))


def _syntax_errors(source: SourceFile, text: str, language: Language) -> tuple[Diagnostic, ...]:
    from deros.metamodels.recovery.recovery import recover

    return tuple(recover(source, text, language).diagnostics)


class _Reading:
    """Walks a parse tree; positions are offsets in ``text``, whose comments are blank."""

    def __init__(self, text: str) -> None:
        self._text = text

    def tokens(self, tree: Any) -> Iterator[SyntaxToken]:
        for branch in tree:
            if _is_branch(branch):  # the other one is the end of the file
                yield from self._branch(branch, 0, branch.rule_name, starts=True)

    def _branch(
        self, branch: Any, level: int, within: str, *, starts: bool
    ) -> Iterator[SyntaxToken]:
        """Yield the tokens of a branch; the first of them is where a line ``starts`` or not."""
        rule = branch.rule
        starts = starts or is_statement(rule)
        within = within if _is_assignment(rule) else rule.rule_name
        inside = level
        for node in branch:
            if not _is_branch(node):
                inside = level if node.value == "}" else inside
                yield from self._leaf(node, inside, within, starts=starts)
                inside = level + 1 if node.value == "{" else inside
            elif _is_assignment(node.rule):
                below = inside + (_is_section(rule) and node is branch[-1])
                yield from self._entries(node, below, within, starts=starts, block=inside > level)
            else:
                yield from self._branch(node, inside, within, starts=starts)
            starts = False

    def _entries(
        self, assigned: Any, level: int, within: str, *, starts: bool, block: bool
    ) -> Iterator[SyntaxToken]:
        """Yield the tokens of what is assigned to an attribute: each entry of a block starts."""
        for node in assigned:
            if _is_branch(node):
                yield from self._branch(node, level, within, starts=starts or block)
            else:
                yield from self._leaf(node, level, within, starts=starts)
            starts = False

    def _leaf(self, leaf: Any, level: int, within: str, *, starts: bool) -> Iterator[SyntaxToken]:
        start, text = leaf.position, str(leaf.value)
        rule = "" if leaf.rule_name == "sep" else leaf.rule_name
        if text.startswith('"'):
            yield SyntaxToken(text, start, start + len(text), rule, within, level, starts)
            return
        goes_on = False
        parts = _PART_OF_PATH if rule == "Path" else _WRITTEN_TOGETHER
        for part in parts.finditer(text):
            begin, end = start + part.start(), start + part.end()
            yield SyntaxToken(part[0], begin, end, rule, within, level, starts, goes_on)
            starts, goes_on = False, True


def _is_branch(node: Any) -> bool:
    return isinstance(node, list)


def _is_assignment(rule: ParsingExpression) -> bool:
    """Return whether an expression stands for an attribute, ``ports*=TopicPort``, in a rule."""
    return bool(rule.rule_name.startswith("__asgn"))


def _is_section(rule: ParsingExpression) -> bool:
    """Return whether a rule is a word with the statements that belong to it, without braces.

    After the statement of a node, which may end in ``;``, its sections follow; they are not in it.
    """
    if type(rule) is not Sequence or len(rule.nodes) < 2:
        return False
    *_, before, last = rule.nodes
    is_ended = type(before) is Optional and literal_of(before.nodes[0]) == ";"
    repeats = type(last) in (ZeroOrMore, OneOrMore) and is_statement(last.nodes[0])
    return repeats and not is_ended
