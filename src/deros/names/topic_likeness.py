"""Similarity of topic names: whether two of them probably mean the same topic."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Callable, Iterable
from functools import lru_cache

LIKELY = 0.6
"""The likeness from which on two names probably mean the same topic."""

_FEW = 200
"""The number of names up to which all are compared; that takes some ten microseconds each."""

_WORD = re.compile(r"\d+|[A-Z]+(?![a-z])|[A-Z]?[a-z]+")
_SYNONYMS = {
    "command": "cmd",
    "velocity": "vel",
    "odometry": "odom",
    "img": "image",
    "laser": "scan",
    "laserscan": "scan",
    "lidar": "scan",
    "pointcloud": "point",
    "cloud": "point",
    "pcl": "point",
    "position": "pose",
    "joints": "joint",
    "batt": "battery",
    "gnss": "gps",
}
"""Words that different drivers use for the same thing."""

_NAMES_OF_THINGS = (
    "accel back base battery bias bottom camera center cmd color confidence cost covariance "
    "data delta depth down enable error far feedback filtered fix front global goal gps "
    "heading height imu info initial input jog joint joy left level limit local lock log "
    "low lower mag map master max min mode motor near odom out output over pan path pitch "
    "plan pose post pressure range rate raw rear rect reset rgb right roll safe scan set "
    "slave slow start state status stop target temp tilt time top torque track under up "
    "upper vel wall wheel width yaw "
)
_KNOWN = frozenset(_NAMES_OF_THINGS.split())
"""Words of topic names: one of them is not another one mistyped (rear, near)."""


def likeness(first: str, second: str) -> float:
    """Return the likeness of two graph names as names of one topic, from 0 to 1.

    A name is its last part and the namespace before it, each a list of words: split at ``_``,
    ``/``, capitals and digits, without plural ends, and with synonyms (``command``, ``cmd``) made
    equal.

    * Two lists are as alike as the share of words that they have in common. A word matches one that
      is mistyped (one letter more, less or wrong, or two swapped; two such slips from seven letters
      on), unless both are words of their own: ``rear`` is not a mistyped ``near``.
    * Two lists that *each* have a word that the other lacks are not alike at all: ``data_compass``
      and ``data_bias``, ``left`` and ``right``, ``camera_1`` and ``camera_2`` are two things. One
      that has all words of the other, and more, may be meant: ``scan`` and ``scan_filtered``.
    * Two names that read the same when joined are equal: ``scanFront``, ``scan_front``.
    * The last part, which says what is sent, counts for seven tenths. The namespace, which says who
      sends it, counts for three, and half of that where only one name has one.

    Two names are probably one topic from a likeness of 0.6 on.
    """
    (first_space, first_last), (second_space, second_last) = _parts(first), _parts(second)
    if "".join(first_space + first_last) == "".join(second_space + second_last):
        return 1.0
    last = _alike(first_last, second_last)
    if not last:
        return 0.0
    space = _alike(first_space, second_space)
    if not space:
        if first_space and second_space:
            return 0.0
        space = 0.5
    return 0.7 * last + 0.3 * space


def words_of(name: str) -> frozenset[str]:
    """Return the words of a name, its namespace included, with synonyms made equal."""
    space, last = _parts(name)
    return frozenset((*space, *last))


def likely_topics(name: str, candidates: Iterable[str]) -> list[str]:
    """Return up to three of the candidates that a topic was probably meant to be, best first."""
    return LikelyTopics(candidates).best(name)


class LikelyTopics:
    """Finds, among very many names, those that one was probably meant to be.

    Few candidates are all compared. Of many, those are that share a word of their last part, or
    whose last part differs in one place; a word that too many share does not count.
    """

    def __init__(self, candidates: Iterable[str]) -> None:
        """Hold the candidates."""
        self._candidates = list(candidates)
        self._index: dict[str, list[str]] | None = None

    def best(
        self, name: str, rank: Callable[[str], float | None] = lambda _: 0.0, n: int = 3
    ) -> list[str]:
        """Return up to ``n`` candidates that ``name`` was probably meant to be, best first.

        Args:
            name: the name that lacks a partner.
            rank: returns the weight of a candidate besides its name, ``None`` if it is out of the
                question.
            n: how many are wanted at most.
        """
        found = []
        for candidate in self._near(name):
            score = likeness(name, candidate) if candidate != name else 0.0
            bonus = rank(candidate) if score >= LIKELY else None
            if bonus is not None:
                found.append((-score - bonus, len(candidate), candidate))
        return [candidate for _, _, candidate in sorted(found)[:n]]

    def _near(self, name: str) -> Iterable[str]:
        if len(self._candidates) <= _FEW:
            return self._candidates
        if self._index is None:
            self._index = defaultdict(list)
            for candidate in self._candidates:
                for key in _keys(candidate):
                    self._index[key].append(candidate)
        found: dict[str, None] = {}
        for key in _keys(name):
            sharing = self._index.get(key, ())
            if len(sharing) <= _FEW:
                found.update(dict.fromkeys(sharing))
        return found


def _keys(name: str) -> set[str]:
    """Return the index keys of a name: similar names share at least one of them."""
    space, last = _parts(name)
    joined, place = "".join(last), "/".join(space)
    keys = {joined[:i] + joined[i + 1 :] for i in range(len(joined))} | {joined, *last}
    # Where thousands of subsystems have topics of one name, those of the own namespace count.
    return keys | {f"{place}/{word}" for word in last} | {f"{place}/"}


@lru_cache(maxsize=1 << 16)
def _parts(name: str) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return the words of the namespace and of the last part of a name."""
    space, _, last = name.rpartition("/")
    return _words(space), _words(last)


def _words(text: str) -> tuple[str, ...]:
    words = (_canonical(word) for word in _WORD.findall(text))
    return tuple(word for word in words if word)


def _canonical(word: str) -> str:
    word = word.lower()
    if word not in _SYNONYMS and len(word) > 3 and word.endswith("s") and word not in _KNOWN:
        word = word[:-1]
    return _SYNONYMS.get(word, word)


@lru_cache(maxsize=1 << 14)
def _alike(first: tuple[str, ...], second: tuple[str, ...]) -> float:
    """Return the likeness of two lists of words; 0 if each has a word that the other lacks."""
    if first == second:
        return 1.0
    joined, other = "".join(first), "".join(second)
    if joined == other:
        return 1.0
    left, right = list(first), list(second)
    common = 0
    for word in first:
        if word in right:
            right.remove(word)
            left.remove(word)
            common += 1
    slips = 0
    for word in list(left):
        match = next((each for each in right if is_mistyped(word, each)), None)
        if match is not None:
            left.remove(word)
            right.remove(match)
            slips += 1
    if left and right:
        # Words that are written as one may hide a slip: scan_front and scanfornt.
        is_one = len(left) != len(right) and _digits(first) == _digits(second)
        return 0.85 if is_one and is_mistyped(joined, other) else 0.0
    total = common + slips + len(left) + len(right)
    return (common + 0.9 * slips) / total if total else 0.0


def _digits(words: tuple[str, ...]) -> list[str]:
    return [word for word in words if word.isdigit()]


@lru_cache(maxsize=1 << 14)
def is_mistyped(first: str, second: str) -> bool:
    """Return whether two words differ by one typing error, or two in a long word."""
    if first.isdigit() or second.isdigit() or (first in _KNOWN and second in _KNOWN):
        return False
    from rapidfuzz.distance import OSA  # which counts two swapped letters as one slip

    shorter = min(len(first), len(second))
    slips = 2 if shorter >= 7 else 1
    return shorter >= 3 and OSA.distance(first, second, score_cutoff=slips) <= slips
