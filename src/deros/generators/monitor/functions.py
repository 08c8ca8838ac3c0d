"""Rejects, by name, functions that a target cannot emit."""

from __future__ import annotations

from collections.abc import Callable

from deros import codes
from deros.diagnostics import report
from deros.generators.api.protocol import GenerationError
from deros.rules.functions.functions import FUNCTIONS, Function
from deros.rules.program import walk
from deros.rules.program.ir import Apply, Program


def refuse_unknown(program: Program, knows: Callable[[Function], bool], language: str) -> None:
    """Reject each function of the rules that a target cannot emit.

    Args:
        program: the rules.
        knows: whether the target can emit the function of a row.
        language: that of the target, for the message.

    Raises:
        GenerationError: with a finding for each rule and function.
    """
    found = {
        (rule.index, row.name): report(
            codes.UNSUPPORTED_BY_TARGET, f"{row.name}() does not exist in {language}", rule.span
        )
        for rule in program.rules
        for value in walk.values(walk.parts(rule.condition))
        if isinstance(value, Apply)
        and value.entry is None
        and value.zone is None  # which every target prints
        and not knows(row := FUNCTIONS[value.function])
    }
    if found:
        raise GenerationError(list(found.values()))
