"""Output that never blocks on its reader."""

from __future__ import annotations

import os
import select
import selectors


class Output:
    """
    Passes text on to a file descriptor without ever waiting for whoever reads there.

    A pager that nobody scrolls must not keep the system from being stopped.
    """

    LIMIT = 1 << 20  # bytes held back before the nodes have to wait, too

    def __init__(self, descriptor: int, selector: selectors.BaseSelector) -> None:
        """Write to the descriptor whenever the selector reports that it is writable."""
        self._descriptor = descriptor
        self._selector = selector
        self._held = bytearray()
        self.broken = False

    @property
    def full(self) -> bool:
        """Whether the buffer is full."""
        return len(self._held) >= self.LIMIT

    @property
    def is_empty(self) -> bool:
        """Whether all has been written."""
        return not self._held

    def write(self, data: bytes) -> None:
        """Queue bytes; they are written in order, as fast as the reader takes them."""
        if self.broken or not data:
            return
        if not self._held:
            self._selector.register(self._descriptor, selectors.EVENT_WRITE, self._flush)
        self._held += data

    def drain(self, patience: float) -> None:
        """Write the buffer; give up if the reader takes nothing for so long."""
        while self._held and select.select([], [self._descriptor], [], patience)[1]:
            self._flush()

    def _flush(self) -> None:
        # A descriptor that is ready takes PIPE_BUF bytes without blocking (POSIX).
        try:
            written = os.write(self._descriptor, self._held[: select.PIPE_BUF])
        except BlockingIOError:
            written = 0
        except OSError:
            self.broken = True
            written = len(self._held)
        del self._held[:written]
        if not self._held:
            self._selector.unregister(self._descriptor)
