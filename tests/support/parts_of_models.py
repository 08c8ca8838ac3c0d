"""Parts of models, as documents show them, in a whole that can be parsed and formatted."""

from __future__ import annotations

import itertools
import textwrap

from deros.formatting.format import Fault, formatted
from tests.support.written_models import Written

_NODE = "node shown : shown"
_SYSTEM = "system Shown"
_AROUND: dict[str, tuple[tuple[str, str], ...]] = {
    "rosnode": (
        ("", ""),
        (_NODE, ""),
        *((f"{_NODE}\n{section}", "") for section in ("parameters", "publishes", "subscribes")),
        *((f"{_NODE}\n{section}", "") for section in ("services", "clients", "timers")),
    ),
    "rossystem": (
        ("", ""),
        (_SYSTEM, ""),
        *((f"{_SYSTEM}\n{section}", "") for section in ("imports", "topics")),
        *((f"{_SYSTEM}\n{_NODE}\n{section}", "") for section in ("parameters", "wirings")),
    ),
    "deros": (
        ("", ""),
        ("entity shown {", "}"),
        ("gate /shown -> /to : geometry_msgs.Twist rate 20 Hz {", "}"),
        ("entity shown {\n  shown:", "}"),
    ),
}
"""By the language, what may stand above and below a part, in the order in which it is tried."""


def laid_out(written: Written) -> str | None:
    """Return a part of a model as it is formatted within a whole; None if it fits into none.

    How deep it stands there is left out, as it is of the part: its outermost line begins at the
    left.
    """
    for above, below in _AROUND[written.language.name]:
        whole = "".join(f"{part}\n" for part in (above, written.text.rstrip("\n"), below) if part)
        result = formatted(whole, written.language)
        if not isinstance(result, Fault):
            lines = result.splitlines(keepends=True)
            first, last = len(above.splitlines()), len(lines) - len(below.splitlines())
            return "".join(_dedented(lines[first:last]))
    return None


def _dedented(lines: list[str]) -> list[str]:
    spaced = itertools.dropwhile(lambda line: not line.strip(), lines)
    return textwrap.dedent("".join(spaced)).splitlines(keepends=True)
