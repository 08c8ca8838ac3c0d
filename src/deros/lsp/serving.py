"""The server with all that it answers."""

from __future__ import annotations

import gc
from collections.abc import Callable, Coroutine
from contextlib import suppress
from pathlib import Path
from typing import Any, TypeVar

from lsprotocol import types
from pygls.exceptions import JsonRpcException

from deros.lsp.answers import ANSWERS, Answer
from deros.lsp.completion.complete import complete
from deros.lsp.places import path_of
from deros.lsp.server import Server
from deros.metamodels.languages import LANGUAGES, entry_point, language_of
from deros.metamodels.matching import DoesNotParse
from deros.metamodels.parsers import parse_tree
from deros.metamodels.recovery.recovery import recogniser

_T = TypeVar("_T")


def prepare() -> None:
    """Load what every analysis needs, for a process that only serves.

    The garbage collector does not walk it any more: that would hold up an answer now and then by
    some 70 ms.
    """
    for language in LANGUAGES:
        entry_point(language.loader)
        entry_point(language.checks)
        recogniser(language)
        with suppress(DoesNotParse):
            parse_tree(language, "")
    gc.collect()
    gc.freeze()


def make_server(interfaces: tuple[Path, ...] = ()) -> Server:
    """Return a server with all features; it serves nobody yet."""
    server = Server(interfaces)

    @server.feature(types.TEXT_DOCUMENT_DID_OPEN)
    def _(ls: Server, given: types.DidOpenTextDocumentParams) -> None:
        path = path_of(given.text_document.uri)
        if path is not None and language_of(path) is not None:
            ls.opened(path, given.text_document.text)

    @server.feature(types.TEXT_DOCUMENT_DID_CHANGE)
    def _(ls: Server, given: types.DidChangeTextDocumentParams) -> None:
        path = path_of(given.text_document.uri)
        if path in ls.open_files:
            ls.opened(path, ls.workspace.get_text_document(given.text_document.uri).source)

    @server.feature(types.TEXT_DOCUMENT_DID_CLOSE)
    def _(ls: Server, given: types.DidCloseTextDocumentParams) -> None:
        path = path_of(given.text_document.uri)
        if path in ls.open_files:
            ls.closed(path)

    @server.feature(types.TEXT_DOCUMENT_DID_SAVE)
    def _(ls: Server, given: types.DidSaveTextDocumentParams) -> None:
        del given
        ls.saved()

    @server.feature(types.WORKSPACE_DID_CHANGE_WATCHED_FILES)
    def _(ls: Server, given: types.DidChangeWatchedFilesParams) -> None:
        del given
        ls.saved()

    @server.feature(
        types.TEXT_DOCUMENT_COMPLETION,
        types.CompletionOptions(trigger_characters=[".", "/", "$", '"', "["]),
    )
    async def _(ls: Server, given: types.CompletionParams) -> list[types.CompletionItem] | None:
        path = path_of(given.text_document.uri)
        language = None if path is None else language_of(path)
        if path is None or language is None or path not in ls.open_files:
            return None
        # An older analysis will do: the next letter is typed before the present one is there.
        analysis = ls.analyses.last(path) or await ls.analysis(path)
        if analysis is None:
            return None
        slots, text = ls.slots_of(path, language), ls.text_of(path)
        offers = _told(ls, path, lambda: complete(ls.places, analysis, slots, text, given.position))
        ls.answered()
        return offers

    for method, options, answer in ANSWERS:
        server.feature(method, options)(_answering(answer))
    return server


def _answering(answer: Answer) -> Callable[[Server, Any], Coroutine[Any, Any, Any]]:
    async def answered(ls: Server, given: Any) -> Any:
        path = path_of(given.text_document.uri)
        analysis = await ls.analysis(path) if path is not None else None
        if path is None or analysis is None:
            return None
        return _told(ls, path, lambda: answer(ls, analysis, given))

    return answered


def _told(ls: Server, path: str, answer: Callable[[], _T]) -> _T | None:
    """Return an answer; of one that fails by a fault of ours, tell, and give none."""
    try:
        return answer()
    except JsonRpcException:
        raise  # a refusal, which says why
    except Exception as error:  # whatever it is, other questions may do without it
        ls.failures.tell(path, error)
        return None
