"""The questions that the server answers: a row for each, with what answers it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from lsprotocol import types
from pygls.exceptions import JsonRpcInvalidParams

from deros.diagnostics import Span
from deros.formatting.format import Fault, formatted
from deros.lsp.analysis import Analysis
from deros.lsp.features import findings, hover, lenses, navigation, symbols, values
from deros.lsp.features.navigation import word_at
from deros.lsp.server import Server

Answer = Callable[[Server, Analysis, Any], Any]
"""Answers a question about an open file."""


def _hover(ls: Server, analysis: Analysis, given: types.HoverParams) -> types.Hover | None:
    places = ls.places
    word = word_at(analysis, places, given.position)
    offset = places.offset(analysis.source, given.position)
    pages = [
        hover.page_of(each)
        for each in analysis.findings
        if each.span.source is analysis.source and each.span.start <= offset <= each.span.end
    ]
    texts = [hover.hover(analysis, word)] if word is not None else []
    if not texts and not pages:
        return None
    text = "\n\n---\n\n".join([*texts, *dict.fromkeys(pages)])
    contents = types.MarkupContent(types.MarkupKind.Markdown, text)
    return types.Hover(contents, places.range(word.span) if word is not None else None)


def _definition(
    ls: Server, analysis: Analysis, given: types.DefinitionParams
) -> list[types.Location]:
    word = word_at(analysis, ls.places, given.position)
    return [] if word is None else list(navigation.definitions(ls.places, word))


def _references(
    ls: Server, analysis: Analysis, given: types.ReferenceParams
) -> list[types.Location]:
    word = word_at(analysis, ls.places, given.position)
    spans = [] if word is None else navigation.uses(ls.related(analysis), word)
    return [ls.places.location(each) for each in spans]


def _highlight(
    ls: Server, analysis: Analysis, given: types.DocumentHighlightParams
) -> list[types.DocumentHighlight]:
    word = word_at(analysis, ls.places, given.position)
    same = [] if word is None else analysis.index.of(word.key)
    return [types.DocumentHighlight(ls.places.range(each.span)) for each in same]


def _prepare_rename(
    ls: Server, analysis: Analysis, given: types.PrepareRenameParams
) -> types.Range | None:
    word = word_at(analysis, ls.places, given.position)
    if word is None or not navigation.may_be_renamed(word):
        return None
    return ls.places.range(word.span)


def _rename(
    ls: Server, analysis: Analysis, given: types.RenameParams
) -> types.WorkspaceEdit | None:
    word = word_at(analysis, ls.places, given.position)
    if word is None:
        return None
    try:
        return navigation.renamed(ls.places, ls.related(analysis), word, given.new_name)
    except navigation.NotRenamed as refused:
        raise JsonRpcInvalidParams(str(refused)) from refused


def _symbols(
    ls: Server, analysis: Analysis, given: types.DocumentSymbolParams
) -> list[types.DocumentSymbol]:
    del given
    return symbols.outline(ls.places, analysis)


def _foldings(
    ls: Server, analysis: Analysis, given: types.FoldingRangeParams
) -> list[types.FoldingRange]:
    del given
    return list(symbols.foldings(symbols.outline(ls.places, analysis)))


def _tokens(
    ls: Server, analysis: Analysis, given: types.SemanticTokensParams
) -> types.SemanticTokens:
    del given
    return types.SemanticTokens(symbols.colours(ls.places, analysis.index))


def _hints(ls: Server, analysis: Analysis, given: types.InlayHintParams) -> list[types.InlayHint]:
    return list(values.hints(ls.places, analysis, given.range))


def _actions(
    ls: Server, analysis: Analysis, given: types.CodeActionParams
) -> list[types.CodeAction]:
    return list(findings.quick_fixes(ls.places, analysis, given.range))


def _format(
    ls: Server, analysis: Analysis, given: types.DocumentFormattingParams
) -> list[types.TextEdit] | None:
    del given  # there is one layout
    source, language = analysis.source, analysis.language
    if language is None:
        return None
    laid_out = formatted(source.text, language, source.path)
    if isinstance(laid_out, Fault):
        return None  # its findings are shown already
    whole = Span(source, 0, len(source.text))
    return [] if laid_out == source.text else [types.TextEdit(ls.places.range(whole), laid_out)]


def _lenses(ls: Server, analysis: Analysis, given: types.CodeLensParams) -> list[types.CodeLens]:
    del given
    return list(lenses.lenses(ls.places, analysis))


ANSWERS: tuple[tuple[str, Any, Answer], ...] = (
    (types.TEXT_DOCUMENT_HOVER, None, _hover),
    (types.TEXT_DOCUMENT_DEFINITION, None, _definition),
    (types.TEXT_DOCUMENT_REFERENCES, None, _references),
    (types.TEXT_DOCUMENT_DOCUMENT_HIGHLIGHT, None, _highlight),
    (types.TEXT_DOCUMENT_PREPARE_RENAME, None, _prepare_rename),
    (types.TEXT_DOCUMENT_RENAME, types.RenameOptions(prepare_provider=True), _rename),
    (types.TEXT_DOCUMENT_DOCUMENT_SYMBOL, None, _symbols),
    (types.TEXT_DOCUMENT_FOLDING_RANGE, None, _foldings),
    (types.TEXT_DOCUMENT_SEMANTIC_TOKENS_FULL, symbols.LEGEND, _tokens),
    (types.TEXT_DOCUMENT_INLAY_HINT, None, _hints),
    (
        types.TEXT_DOCUMENT_CODE_ACTION,
        types.CodeActionOptions([types.CodeActionKind.QuickFix]),
        _actions,
    ),
    (types.TEXT_DOCUMENT_CODE_LENS, None, _lenses),
    (types.TEXT_DOCUMENT_FORMATTING, None, _format),
)
"""The method, what the server says of it when a client asks, and the answer."""
