"""Stored pairs that kill planted slips, so that a test replays one pair in place of a search.

A file holds a line of JSON for each slip: its name, and a pair (a program, a start and a trace) on
which the monitor with the slip differs from the reference. A pair that no longer kills its slip is
searched for anew; ``make killing-pairs`` searches for all of them and stores what it finds.
"""

from __future__ import annotations

import json
import warnings
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.support import counterexamples
from tests.support.counterexamples import Pair


class KillingPairs:
    """The pairs of one file, by slip.

    Attributes:
        stored: what the file holds.
    """

    def __init__(self, path: Path, refresh: bool) -> None:
        """Read the file, if there is one.

        Args:
            path: the file.
            refresh: whether to search for every pair and store it.
        """
        self._path = path
        self._refresh = refresh
        self.stored: dict[str, Pair] = {}
        if path.exists():
            for line in path.read_text(encoding="utf-8").splitlines():
                entry = json.loads(line)
                self.stored[entry["slip"]] = counterexamples.decoded(entry["pair"])

    def __contains__(self, slip: str) -> bool:
        """Return whether a pair is stored for a slip."""
        return slip in self.stored

    def check(
        self, slip: str, kills: Callable[[Pair], bool], search: Callable[[bool], Pair | None]
    ) -> None:
        """Replay the stored pair of a slip; search for another one if it does not kill.

        Args:
            slip: the name of the slip.
            kills: returns whether the monitor with the slip differs from the reference on a pair.
            search: returns a pair that kills the slip, if it finds one; a small one if asked to.

        Raises:
            AssertionError: no pair kills the slip.
        """
        if not self._refresh:
            pair = self.stored.get(slip)
            if pair is not None and kills(pair):
                return
        found = search(self._refresh)
        assert found is not None, f"no random pair kills the slip '{slip}'"
        assert kills(found), f"the pair found for the slip '{slip}' does not kill it when replayed"
        if self._refresh:
            self._store(slip, found)
        else:
            text = f"the stored pair of '{slip}' no longer kills it; run: make killing-pairs"
            warnings.warn(text, stacklevel=2)

    def _store(self, slip: str, pair: Pair) -> None:
        self.stored[slip] = pair
        lines = [
            json.dumps(
                {"slip": name, "pair": counterexamples.encoded(self.stored[name])},
                separators=(",", ":"),
            )
            for name in sorted(self.stored)
        ]
        self._path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the option that searches for the pairs and stores them."""
    parser.addoption(
        "--refresh-killing-pairs",
        action="store_true",
        help="search again for the pairs that kill the planted slips, and store them",
    )


@pytest.fixture(scope="module")
def killing_pairs(request: pytest.FixtureRequest) -> KillingPairs:
    """Return the pairs in ``killing_pairs.jsonl`` beside the test file."""
    refresh = bool(request.config.getoption("--refresh-killing-pairs"))
    return KillingPairs(request.path.with_name("killing_pairs.jsonl"), refresh)
