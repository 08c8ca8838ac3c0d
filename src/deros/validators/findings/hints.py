"""Hints that all checks share."""

from __future__ import annotations

import re
from collections.abc import Iterable

from deros import codes
from deros.names import names

SHOWN = 3
"""The number of names, or of places, that a finding lists."""


def did_you_mean(name: str, candidates: Iterable[str], otherwise: str = "") -> str:
    """Return the hint that names the candidates nearly spelt as ``name``, or ``otherwise``."""
    return names.did_you_mean(names.near(name, candidates), name) or otherwise


def one_of(candidates: Iterable[str], what: str) -> str:
    """Return the hint that lists the candidates, if they are few."""
    listed = sorted(set(candidates))
    return f"{what}: {', '.join(listed)}" if 0 < len(listed) <= 8 else ""


def unknown_code(word: str) -> str:
    """Return the hint for a word that is neither the name nor the slug of a diagnostic."""
    known = codes.ALL_CODES if re.search(r"\d", word) else codes.SLUGS
    spelled = word.upper() if known is codes.ALL_CODES else word.lower().replace("_", "-")
    if spelled in known:
        return f"write '{spelled}'"
    meant = names.near(spelled, known)
    return names.did_you_mean(meant, word) or "'deros explain' lists all diagnostics"
