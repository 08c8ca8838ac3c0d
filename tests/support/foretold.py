"""What becomes of verdicts as time goes on without news, played by the reference engine."""

from __future__ import annotations

import copy
from typing import Any

from deros.generators.runtime.python.deros_runtime.look_ahead import SILENT, STAYING, NextVerdict
from deros.rules.engine.engine import Engine
from deros.rules.program import walk
from deros.rules.program.ir import Program

NEVER = 1 << 63

Foretold = dict[int, dict[str, NextVerdict]]
"""The next verdict of each rule, by its place, in each case in which it changes."""


def foretold(engine: Engine, rules: Program) -> Foretold:
    """Return what copies of an engine become, which play all deadlines that there are."""
    found: Foretold = {}
    for case in (STAYING, SILENT):
        for place, verdict in _played(engine, rules, keeps=case == STAYING).items():
            found.setdefault(place, {})[case] = verdict
    return found


def _played(engine: Engine, rules: Program, *, keeps: bool) -> dict[int, NextVerdict]:
    ahead: Any = copy.deepcopy(engine)
    if keeps:
        for each in walk.holdable_inputs(rules):
            ahead._state.inputs[each.index].base_ns = NEVER
    before = [each.value for each in ahead.explain().rules]
    found: dict[int, NextVerdict] = {}
    while (due := ahead.next_deadline) is not None and due < NEVER:  # that of one that is held
        ahead.advance(due)
        for place, rule in enumerate(ahead.explain().rules):
            if rule.value is not before[place]:
                found.setdefault(place, NextVerdict(rule.value, due))
    return found
