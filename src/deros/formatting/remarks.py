"""The comments at the ends of lines: where they begin."""

from __future__ import annotations

from collections.abc import Sequence

from deros.formatting.layout import Line

_DISTANCE = 2
"""Blanks between code and the comment behind it."""


def columns_of_remarks(lines: Sequence[Line]) -> dict[int, int]:
    """Return where the comment at the end of a line begins, by the line's place.

    Comments that were written below one another stay so, up to the next blank line.
    """
    columns: dict[int, int] = {}
    for written, group in _aligned(lines).items():
        least = max(len(lines[place].code) for place in group) + _DISTANCE
        column = max(least, written[1]) if len(group) > 1 else least
        columns.update(dict.fromkeys(group, column))
    return columns


def _aligned(lines: Sequence[Line]) -> dict[tuple[int, int], list[int]]:
    """Return the places of lines with comments by their paragraph and column."""
    paragraph = 0
    groups: dict[tuple[int, int], list[int]] = {}
    for place, line in enumerate(lines):
        paragraph += line.is_spaced
        if line.remark is not None:
            groups.setdefault((paragraph, line.remark.column), []).append(place)
    return groups
