"""The program ``deros``: from its first instruction, Ctrl-C ends it without a traceback."""

from __future__ import annotations

import signal
from typing import NoReturn


def main() -> NoReturn:
    """Run ``deros`` and exit.

    Python's own handler of SIGINT would raise an exception in the middle of an import. The command
    line brings one that does not; until that is imported, SIGINT ends the process.
    """
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    from deros.cli.main import main as run

    run()
