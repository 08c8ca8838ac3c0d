"""The rules built in one run, so that checks and generators share one result."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from deros.interfaces.store import InterfaceStore
    from deros.models.rules import Rules
    from deros.rules.compiler.build import BuildResult


class BuildCache:
    """The results of building the rules of one run: each model of rules is built once."""

    def __init__(self, store: InterfaceStore) -> None:
        """Build with the message definitions of ``store``."""
        self._store = store
        self._results: dict[int, tuple[Rules, BuildResult]] = {}

    def of(self, rules: Rules) -> BuildResult:
        """Return the result for one model, which is built at the first call."""
        known = self._results.get(id(rules))
        if known is None:
            from deros.rules.compiler.build import build

            # The model is kept with its result: its identity must not pass to another one.
            known = self._results[id(rules)] = rules, build(rules, self._store)
        return known[1]
