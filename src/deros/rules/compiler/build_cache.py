"""The rules built and the systems expanded in one run, so that all share one result."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from deros.interfaces.store import InterfaceStore
    from deros.models.rules import Rules
    from deros.models.system import System
    from deros.rules.compiler.build import BuildResult
    from deros.systems.flat import FlatSystem


class BuildCache:
    """What is made of the models of one run, once of each: rules built, systems expanded."""

    def __init__(self, store: InterfaceStore) -> None:
        """Build with the message definitions of ``store``."""
        self._store = store
        self._results: dict[int, tuple[Rules, BuildResult]] = {}
        self._flat: dict[int, tuple[System, FlatSystem]] = {}

    def of(self, rules: Rules) -> BuildResult:
        """Return the result for one model, which is built at the first call."""
        known = self._results.get(id(rules))
        if known is None:
            from deros.rules.compiler.build import build

            # The model is kept with its result: its identity must not pass to another one.
            known = self._results[id(rules)] = rules, build(rules, self._store)
        return known[1]

    def flat(self, system: System) -> FlatSystem:
        """Return a system in its usual values, expanded; it is expanded at the first call."""
        known = self._flat.get(id(system))
        if known is None:
            from deros.systems.flatten import flatten

            known = self._flat[id(system)] = system, flatten(system)
        return known[1]
