"""The formatted text of a model."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from deros.diagnostics import Diagnostic, SourceFile
from deros.formatting.layout import Line, lines_of
from deros.formatting.pieces import Piece, pieces_of
from deros.formatting.remarks import columns_of_remarks
from deros.metamodels.languages import Language
from deros.metamodels.reading import Unreadable
from deros.metamodels.tokens import HasSyntaxErrors


@dataclass(frozen=True, slots=True)
class Fault:
    """Why a text cannot be formatted.

    Attributes:
        diagnostics: the findings, at least one of which is an error.
    """

    diagnostics: tuple[Diagnostic, ...]


def formatted(text: str, language: Language, path: str = "") -> str | Fault:
    """Return the text of a model as it is formatted; what is formatted stays as it is.

    It has the same tokens and the same comments, so it means the same. Line ends are those of the
    first line.

    Args:
        text: all of a model.
        language: its language.
        path: the name of its file in findings.
    """
    source = SourceFile(path, text)
    try:
        pieces = pieces_of(source, language)
    except Unreadable as unreadable:
        return Fault((unreadable.diagnostic,))
    except HasSyntaxErrors as errors:
        return Fault(errors.diagnostics)
    result = _text(lines_of(pieces))
    if result != text:
        _assert_same(pieces, pieces_of(SourceFile(path, result), language))
    return result.replace("\n", "\r\n") if source.text.partition("\n")[0].endswith("\r") else result


def _text(lines: Sequence[Line]) -> str:
    columns = columns_of_remarks(lines)
    written: list[str] = []
    for place, line in enumerate(lines):
        text = line.code
        if line.remark is not None:
            text = f"{text:{columns[place]}}{line.remark.text}"
        written.append(f"\n{text}" if line.is_spaced else text)
    return "\n".join(written) + "\n"


def _assert_same(before: Sequence[Piece], after: Sequence[Piece]) -> None:
    """Check that the parser reads the same from a formatted text: nothing else may be written."""
    for old, new in zip(before, after, strict=True):
        if _essence(old) != _essence(new):
            raise AssertionError(f"'{old.text}' in line {old.line} became '{new.text}'")


def _essence(piece: Piece) -> tuple[object, ...]:
    """Return what layout must not change of a piece: all of a token, the words of a comment."""
    if piece.token is None:
        return tuple(line.strip() for line in piece.text.split("\n"))
    return (piece.text, piece.token.rule, piece.token.within)
