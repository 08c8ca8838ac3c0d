"""Text without some of its statements, laid out as if they had never been there."""

from __future__ import annotations

from collections.abc import Collection

_SECTIONS = frozenset(
    {
        *("parameters", "publishes", "subscribes", "services", "clients", "actions"),
        *("action_clients", "timers", "topics", "remappings"),
    }
)
"""Words that stand alone in the line above what is in their section."""


def without(text: str, places: Collection[tuple[int, int]]) -> str:
    """Return a text without the statements at some places, and without sections left empty.

    A statement goes with the rest of its lines if nothing but a comment stands there.

    Args:
        text: as imports lay it out.
        places: beginning and end of each; one may lie within another.
    """
    if not places:
        return text
    kept, position = [], 0
    for start, end in sorted(_whole_lines(text, *place) for place in places):
        kept.append(text[position : max(start, position)])
        position = max(end, position)
    return tidy("".join(kept) + text[position:])


def _whole_lines(text: str, start: int, end: int) -> tuple[int, int]:
    """Return the place of a statement with its lines, if it has these for itself."""
    line = text.rfind("\n", 0, start) + 1
    stop = text.find("\n", end)
    rest = text[end:] if stop < 0 else text[end:stop]
    if text[line:start].strip() or (rest.strip() and not rest.lstrip().startswith("//")):
        return start, end
    return line, len(text) if stop < 0 else stop + 1


def tidy(text: str) -> str:
    """Return a text without empty sections, and with no more blank lines than imports write."""
    lines = text.splitlines()
    kept: list[str] = []
    for number, line in enumerate(lines):
        follows = lines[number + 1].strip() if number + 1 < len(lines) else ""
        if line.strip() in _SECTIONS and follows in ("", "}"):
            continue
        if not line.strip() and (not kept or not kept[-1].strip() or kept[-1].endswith("{")):
            continue
        if line.strip() == "}" and kept and not kept[-1].strip():
            kept.pop()
        kept.append(line)
    return "\n".join(kept).strip("\n") + "\n"
