"""Names and texts in emitted YAML that need no quotes."""

from __future__ import annotations

import re

_PLAIN_KEY = re.compile(r"/?[A-Za-z_][\w./-]*", re.ASCII)
_PLAIN_TEXT = re.compile(r"[A-Za-z_/$](?:[\w./()$=+'-]|:(?=[^ ])| (?=[^#]))*", re.ASCII)
_VALUES = frozenset(("true", "false", "yes", "no", "on", "off", "y", "n", "null"))


def is_plain_key(name: str) -> bool:
    """Return whether a name needs no quotes: YAML could not read it as anything else."""
    return _PLAIN_KEY.fullmatch(name) is not None and name.lower() not in _VALUES


def is_plain_text(text: str) -> bool:
    """Return whether a text is read as it is written, and as nothing else."""
    is_ended = not text.endswith((" ", ":"))
    return is_ended and _PLAIN_TEXT.fullmatch(text) is not None and text.lower() not in _VALUES
