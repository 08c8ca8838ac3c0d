"""The language server: what is asked is answered from the analysis of the present text.

One thread analyses; the loop answers meanwhile. A change starts an analysis as soon as no further
one has come for a moment, and nothing is answered; a question waits for it, unless it can do with
an older one.
"""

from __future__ import annotations

import asyncio
import os
import threading
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path
from typing import Any

from lsprotocol import types
from pygls.lsp.server import LanguageServer
from pygls.protocol import LanguageServerProtocol

from deros import __version__
from deros.diagnostics import Diagnostic
from deros.lsp.analysis import Analyses, Analysis
from deros.lsp.failures import Failures
from deros.lsp.features.findings import by_file, published
from deros.lsp.places import Places, uri_of
from deros.metamodels.languages import Language
from deros.metamodels.recovery.slots import Slots

PAUSE_SECONDS = 0.01
"""So long after a change the analysis begins, so that a question that comes with it goes first."""

_STACK_BYTES = 256 << 20
"""Models nest, and so do the functions that read them; memory is taken when it is used."""


class _Protocol(LanguageServerProtocol):
    """The protocol of pygls, which keeps 2 kB of each notification: they are let go of here."""

    def handle_message(self, message: Any) -> None:
        """Handle a message, and forget what has been handled."""
        super().handle_message(message)
        handled = [key for key, future in self._request_futures.items() if future.done()]
        for key in handled:
            del self._request_futures[key]


class Server(LanguageServer):
    """The language server of the three languages."""

    def __init__(self, interfaces: tuple[Path, ...] = ()) -> None:
        """Start without files; definitions of messages are looked up in ``interfaces`` first."""
        super().__init__(
            "deros", __version__, types.TextDocumentSyncKind.Full, protocol_cls=_Protocol
        )
        self.analyses = Analyses(interfaces)
        self.failures = Failures(self)
        self._worker = _worker()
        self._quiet_at = 0.0
        self._texts: dict[str, str] = {}
        self._slots: dict[str, Slots] = {}
        self._running: dict[str, asyncio.Task[Analysis | None]] = {}
        self._findings: dict[str, dict[str, list[Diagnostic]]] = {}
        self._shown: dict[str, list[types.Diagnostic]] = {}

    # Files --------------------------------------------------------------------------------------

    @property
    def places(self) -> Places:
        """How positions are counted, as agreed with the editor."""
        return Places(self.workspace.position_codec.client_num_units)

    def text_of(self, path: str) -> str:
        """Return the present text of an open file."""
        return self._texts[path]

    @property
    def open_files(self) -> list[str]:
        """The paths of the open files."""
        return list(self._texts)

    def slots_of(self, path: str, language: Language) -> Slots:
        """Return what finds the slots in the texts of an open file."""
        if path not in self._slots:
            self._slots[path] = Slots(language)
        return self._slots[path]

    def opened(self, path: str, text: str) -> None:
        """Take the present text of a file, and have it analysed, and then what rests on it."""
        self._texts[path] = text
        self._analyse(path)

    def saved(self) -> None:
        """Have all files analysed anew that rest on what has changed on the disk."""
        for path in self._texts:
            self._analyse(path)

    def closed(self, path: str) -> None:
        """Forget a file that is no longer open, and its findings."""
        self._texts.pop(path, None)
        self._slots.pop(path, None)
        running = self._running.pop(path, None)
        if running is not None:
            running.cancel()
        self.analyses.close(path)
        self._publish(path, ())
        for other in self._texts:  # its text is that of the disk again
            self._analyse(other)

    def prepare(self, work: Callable[[], None]) -> None:
        """Have something done before the first analysis; questions need not wait for it."""
        self._worker.submit(work)

    def answered(self) -> None:
        """Let the answer that has just been found leave before the next analysis begins."""
        self._quiet_at = asyncio.get_running_loop().time() + PAUSE_SECONDS

    # Analyses -----------------------------------------------------------------------------------

    async def analysis(self, path: str) -> Analysis | None:
        """Return the analysis of the present text of a file.

        ``None`` of one that is not open, and if it has failed: of an older text, places are wrong.
        """
        while (running := self._running.get(path)) is not None:
            await asyncio.wait([running])
            if running is self._running.get(path):
                return running.result()
        return None

    def related(self, analysis: Analysis) -> list[Analysis]:
        """Return an analysis, and those of other open files that rest on a file of it.

        A topic has its name in one robot only: files that have nothing in common do not share it.
        """
        files = analysis.paths
        found = (self.analyses.last(each) for each in self._texts)
        others = (each for each in found if each is not None and each is not analysis)
        return [analysis, *(each for each in others if files & each.paths)]

    def _analyse(self, path: str) -> None:
        before = self._running.get(path)
        if before is not None and not before.done():
            before.cancel()
        self._running[path] = asyncio.create_task(self._analysed(path))

    async def _analysed(self, path: str) -> Analysis | None:
        loop = asyncio.get_running_loop()
        self._quiet_at = max(self._quiet_at, loop.time() + PAUSE_SECONDS)
        while (left := self._quiet_at - loop.time()) > 0:
            await asyncio.sleep(left)
        try:
            return await self._analysed_now(path)
        except Exception as error:  # whatever it is, the next text may do without it
            self.failures.tell(path, error)
            return None

    async def _analysed_now(self, path: str) -> Analysis:
        loop = asyncio.get_running_loop()
        texts = dict(self._texts)
        known = self.analyses.last(path)
        analysis = await loop.run_in_executor(self._worker, self.analyses.of, path, texts)
        if self._texts.get(path) == texts[path]:
            self._publish(path, analysis.findings)
        if analysis is not known:
            self._analyse_users(path)
        return analysis

    def _analyse_users(self, changed: str) -> None:
        """Have the open files analysed that rest on one that has changed."""
        for path in self._texts:
            last = self.analyses.last(path)
            if path != changed and last is not None and os.path.realpath(changed) in last.paths:
                self._analyse(path)

    def _publish(self, path: str, findings: tuple[Diagnostic, ...]) -> None:
        """Show the findings of a check; a file shows those of all checks that concern it."""
        before = self._findings.pop(path, {})
        if findings:
            self._findings[path] = by_file(findings)
        for file in {path, *before, *self._findings.get(path, ())}:
            found = dict.fromkeys(
                each for of_check in self._findings.values() for each in of_check.get(file, ())
            )
            shown = [published(self.places, each) for each in found]
            shown = list({str(each): each for each in shown}.values())
            if shown != self._shown.get(file, []) or file == path:
                self._shown[file] = shown
                self.text_document_publish_diagnostics(
                    types.PublishDiagnosticsParams(uri_of(file), shown)
                )


def _worker() -> ThreadPoolExecutor:
    """Return an executor with one thread, whose stack takes deeply nested models."""
    before = threading.stack_size(_STACK_BYTES)
    try:
        worker = ThreadPoolExecutor(1, "deros-analysis")
        started: Future[None] = worker.submit(lambda: None)
        started.result()
    finally:
        threading.stack_size(before)
    return worker
