"""One look at a graph, which is compared even if the graph does not come to rest."""

from __future__ import annotations

from dataclasses import replace

from deros.live.looks import UnsteadyGraphError, snapshot
from deros.live.observer import Observer
from deros.live.snapshots import Snapshot, Unseen

_ONCE_MORE_S = 5.0


def settled_or_last(observer: Observer, timeout: float) -> Snapshot:
    """Return what is seen of a graph that stays the same, or as it is when the time is over.

    Args:
        observer: the node that looks.
        timeout: seconds for the graph to stay the same; that it did not is among what is unseen.

    Raises:
        UnsteadyGraphError: if the nodes of some ends stay unknown.
    """
    try:
        return snapshot(observer, timeout=timeout, described=False)
    except UnsteadyGraphError as error:
        last = snapshot(observer, timeout=_ONCE_MORE_S, equal=0, quiet=0, described=False)
        changed = str(error).split(". ")[0]
        return replace(last, unseen=(Unseen(changed), *last.unseen))
