"""Which differences are reported while a graph is watched: those that last longer than their grace.

All times are nanoseconds of one steady clock, given from outside.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from deros.live.verify.differences import Comparison, Difference, Key, Kind


@dataclass(frozen=True, slots=True)
class Event:
    """A difference that has lasted its grace, or the end of one that was reported.

    Attributes:
        is_over: whether it is the end.
        lasted_ns: since the difference was seen first.
    """

    difference: Difference
    is_over: bool
    lasted_ns: int


@dataclass(frozen=True, slots=True)
class _Lasting:
    difference: Difference
    since_ns: int
    is_reported: bool = False


class Graces:
    """Follows the differences from look to look."""

    def __init__(self, graces_ns: Mapping[Kind, int] | None = None) -> None:
        """Start without any difference.

        Args:
            graces_ns: how long a difference of a kind has to last to be reported; for other kinds
                it is the usual time.
        """
        self._graces_ns = {kind: kind.grace_ns for kind in Kind} | dict(graces_ns or {})
        self._lasting: dict[Key, _Lasting] = {}

    @property
    def reported(self) -> tuple[Difference, ...]:
        """The differences that were reported and are not over, in the order of their reports."""
        return tuple(each.difference for each in self._lasting.values() if each.is_reported)

    def look(self, now_ns: int, seen: Comparison) -> list[Event]:
        """Return what is to be reported after one more look.

        Of a node that is gone, or does not answer, it is unknown whether its values are still
        wrong: what was reported stays so, and what was not begins anew when it is seen again.
        """
        current = {each.key: each for each in seen.differences}
        events = []
        for key, lasting in [*self._lasting.items()]:
            if key in current:
                self._lasting[key] = replace(lasting, difference=current[key])
            elif not lasting.is_reported:
                del self._lasting[key]
            elif (lasting.difference.node, lasting.difference.kind.about) not in seen.unknown:
                del self._lasting[key]
                events.append(Event(lasting.difference, True, now_ns - lasting.since_ns))
        for key, difference in current.items():
            lasting = self._lasting.setdefault(key, _Lasting(difference, now_ns))
            lasted = now_ns - lasting.since_ns
            if not lasting.is_reported and lasted >= self._graces_ns[difference.kind]:
                # As the last one: what is reported later comes later.
                del self._lasting[key]
                self._lasting[key] = replace(lasting, is_reported=True)
                events.append(Event(difference, False, lasted))
        return events
