"""Configuration of all tests; it adds the repository's root to the path for ``tests.support``."""

from __future__ import annotations

import signal
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent

if str(ROOT) not in sys.path:
    sys.path.insert(0, str(ROOT))

# A shell starts background jobs with SIGINT ignored; the nodes of the tests would inherit this.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)

from tests.support import profiles  # noqa: E402  (after the root is on the path)

profiles.register()

pytest_plugins = ("tests.support.golden", "tests.support.killing_pairs", "tests.support.ros")

collect_ignore = ["golden"]
"""Generated packages have their own tests, which run where they are built."""
