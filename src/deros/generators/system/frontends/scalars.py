"""Texts that YAML reads as they are, without quotes."""

from __future__ import annotations

import re

_PLAIN = re.compile(r"[A-Za-z_/$](?:[\w./()$=+'-]|:(?=[^ ])| (?=[^#]))*", re.ASCII)
_VALUES = frozenset(("true", "false", "yes", "no", "on", "off", "y", "n", "null"))


def is_plain(text: str) -> bool:
    """Return whether a text needs no quotes: YAML could not read it as anything else."""
    is_ended = not text.endswith((" ", ":"))
    return is_ended and _PLAIN.fullmatch(text) is not None and text.lower() not in _VALUES
