"""Where deros keeps what it need not find out, or make, again."""

from __future__ import annotations

import os
from pathlib import Path


def caches() -> Path | None:
    """Return the folder of our caches; ``None`` without a place for that."""
    given = os.environ.get("XDG_CACHE_HOME", "")
    try:
        return (Path(given) if given.startswith("/") else Path.home() / ".cache") / "deros"
    except RuntimeError:  # no home
        return None
