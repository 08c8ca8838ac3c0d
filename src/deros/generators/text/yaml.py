"""Names in emitted YAML."""

from __future__ import annotations

import re

_PLAIN_KEY = re.compile(r"/?[A-Za-z_][\w./-]*", re.ASCII)
_VALUES = frozenset(("true", "false", "yes", "no", "on", "off", "y", "n", "null"))


def is_plain_key(name: str) -> bool:
    """Return whether a name needs no quotes: YAML could not read it as anything else."""
    return _PLAIN_KEY.fullmatch(name) is not None and name.lower() not in _VALUES
