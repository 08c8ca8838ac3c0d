"""Failures of the server itself: what editors tell of a fault of ours."""

from __future__ import annotations

import traceback
from dataclasses import dataclass, field
from pathlib import Path

from lsprotocol import types
from pygls.lsp.server import LanguageServer

from deros import __version__


@dataclass
class Failures:
    """What has failed so far, and been told.

    The traceback goes to the editor's log of the server each time. A message is shown once for each
    place and kind of error: while somebody types, the same fault fails again with each letter.
    """

    server: LanguageServer
    _shown: set[str] = field(default_factory=set)

    def tell(self, path: str, error: BaseException) -> None:
        """Tell of an error that nothing in a text may cause, and that a text has caused.

        Args:
            path: the file that it is about.
            error: what has been raised.
        """
        told = "".join(traceback.format_exception(type(error), error, error.__traceback__))
        self.server.window_log_message(
            types.LogMessageParams(types.MessageType.Error, f"deros {__version__}, {path}:\n{told}")
        )
        kind = _kind(error)
        if kind in self._shown:
            return
        self._shown.add(kind)
        self.server.window_show_message(
            types.ShowMessageParams(
                types.MessageType.Error,
                f"this is a bug in deros, not in '{Path(path).name}': {kind}. The server goes on,"
                " but what it shows of the file may be out of date. Please report it with the"
                " traceback in the log of the language server (in Visual Studio Code: View, Output,"
                " deros)",
            )
        )


def _kind(error: BaseException) -> str:
    """Return the type of an error and the line that raised it."""
    *_, last = traceback.extract_tb(error.__traceback__)
    return f"{type(error).__name__} in {Path(last.filename).name}, line {last.lineno}"
