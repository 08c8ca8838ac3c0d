"""Hints that all checks share, and near matches among very many names."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from functools import cached_property

from deros import codes
from deros.interfaces import names

SHOWN = 3
"""The number of names, or of places, that a finding lists."""

_FEW = 300
"""The number of names up to which all are compared; that takes microseconds each."""


def did_you_mean(name: str, candidates: Iterable[str], otherwise: str = "") -> str:
    """Return the hint that names the candidates nearly spelt as ``name``, or ``otherwise``."""
    return names.did_you_mean(names.near(name, candidates)) or otherwise


def one_of(candidates: Iterable[str], what: str) -> str:
    """Return the hint that lists the candidates, if they are few."""
    listed = sorted(set(candidates))
    return f"{what}: {', '.join(listed)}" if 0 < len(listed) <= 8 else ""


def unknown_code(word: str) -> str:
    """Return the hint for a word that is neither the name nor the slug of a diagnostic."""
    names = codes.ALL_CODES if re.search(r"\d", word) else codes.SLUGS
    spelled = word.upper() if names is codes.ALL_CODES else word.lower().replace("_", "-")
    if spelled in names:
        return f"write '{spelled}'"
    return did_you_mean(spelled, names, "'deros explain' lists all diagnostics")


class NameIndex:
    """Near matches of one name among very many, in time that does not grow with their number.

    Few candidates are compared one by one. Of many, those are found that differ in one place (a
    character too many, too few, wrong, or two swapped), or only before their last ``/``.
    """

    def __init__(self, candidates: Mapping[str, object]) -> None:
        """Store the candidates, which are indexed at the first query."""
        self._candidates = candidates

    def did_you_mean(self, name: str, otherwise: str = "") -> str:
        """Return the hint for ``name``, or ``otherwise`` without a near match."""
        return names.did_you_mean(self.near(name)) or otherwise

    def near(self, name: str, n: int = 3) -> list[str]:
        """Return up to ``n`` candidates that ``name`` was probably meant to be, best first."""
        if len(self._candidates) <= _FEW:
            return names.near(name, self._candidates, n)
        found: dict[str, None] = {}
        for variant in _variants(name):
            found.update(dict.fromkeys(self._by_variant.get(variant, ())))
        found.update(dict.fromkeys(self._by_last_part.get(_last_part(name), ())[:n]))
        found.pop(name, None)
        return names.near(name, list(found)[:_FEW], n) or list(found)[:n]

    @cached_property
    def _by_variant(self) -> dict[str, list[str]]:
        index: dict[str, list[str]] = defaultdict(list)
        for candidate in self._candidates:
            for variant in _variants(candidate):
                index[variant].append(candidate)
        return index

    @cached_property
    def _by_last_part(self) -> dict[str, list[str]]:
        index: dict[str, list[str]] = defaultdict(list)
        for candidate in self._candidates:
            index[_last_part(candidate)].append(candidate)
        return index


def _variants(name: str) -> Iterator[str]:
    """Yield the name, and each variant without one character: near names share a variant."""
    yield name
    for position in range(len(name)):
        yield name[:position] + name[position + 1 :]


def _last_part(name: str) -> str:
    return name.rpartition("/")[2]
