"""The tokens and comments of a text in one row, and which of them a line may not part."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Sequence
from dataclasses import dataclass

from deros.diagnostics import SourceFile, Span
from deros.metamodels.languages import Language
from deros.metamodels.reading import DIRECTIVE, comments
from deros.metamodels.tokens import SyntaxToken, syntax_tokens

_TAB = 8


@dataclass(frozen=True, slots=True)
class Piece:
    """A token or a comment, where it was written.

    Attributes:
        text: its characters; a comment has neither blanks at the ends of its lines nor carriage
            returns.
        token: the token, or ``None`` for a comment.
        line: the line in which it begins, from 1.
        end_line: the line in which it ends.
        column: how many columns are before it in its line.
    """

    text: str
    token: SyntaxToken | None
    line: int
    end_line: int
    column: int

    @property
    def is_line_comment(self) -> bool:
        """Whether it goes on to the end of its line."""
        return self.token is None and self.text.startswith("//")


def pieces_of(source: SourceFile, language: Language) -> list[Piece]:
    """Return the tokens and comments of a text in their order.

    Raises:
        HasSyntaxErrors: the text does not parse.
        Unreadable: it is not even split into tokens.
    """
    tokens = {each.start: each for each in syntax_tokens(source, language)}
    spans = [Span(source, each.start, each.end) for each in tokens.values()]
    spans += comments(source)
    spans.sort(key=lambda span: span.start)
    return [_piece(span, tokens.get(span.start)) for span in spans]


def _piece(span: Span, token: SyntaxToken | None) -> Piece:
    text = span.text if token is None else token.text
    if token is None:
        text = "\n".join(line.rstrip() for line in text.split("\n"))
    source = span.source
    begin = source.text.rfind("\n", 0, span.start) + 1
    column = len(source.text[begin : span.start].expandtabs(_TAB))
    line = span.line
    return Piece(text, token, line, line + text.count("\n"), column)


def bound_lines(pieces: Sequence[Piece]) -> frozenset[int]:
    """Return the lines of tokens that comments such as ``// deros: allow DRS210`` are about.

    Such a comment is about findings in its line, or the next one if it stands alone: what is in
    these lines has to stay together.
    """
    code = [piece.line for piece in pieces if piece.token is not None]
    directives = [piece.line for piece in pieces if _is_directive(piece)]
    following = (bisect_left(code, line) for line in directives)
    return frozenset(code[place] for place in following if place < len(code))


def _is_directive(piece: Piece) -> bool:
    return piece.token is None and DIRECTIVE.match(piece.text) is not None
