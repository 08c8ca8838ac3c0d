"""A program that is no node: it tells what it was started with, and waits for its end.

Its first word is its name. With ``--until-end`` it ends when the FIFO that ``DEROS_TEST_END`` names
is opened, with ``--at-once`` at once, otherwise when it is stopped.
"""

from __future__ import annotations

import contextlib
import os
import signal
import sys
from pathlib import Path

from tests.support.graph_member import tell


def main() -> None:
    """Tell, and wait."""
    name, *words = sys.argv[1:]
    with contextlib.suppress(KeyboardInterrupt):
        tell(name, words)
        if "--until-end" in words:
            Path(os.environ["DEROS_TEST_END"]).read_text(encoding="utf-8")
        elif "--at-once" not in words:
            signal.pause()


if __name__ == "__main__":
    main()
