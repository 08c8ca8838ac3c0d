"""The tunable constants of a program as its rules use them, for every target."""

from __future__ import annotations

from deros.rules.program import walk
from deros.rules.program.ir import Program, Tuned


def tuned_values(program: Program) -> tuple[Tuned, ...]:
    """Return the values that rules read, each once: as written, then as they are compared."""
    conditions = tuple(walk.conditions(program))
    used = [each for each in walk.values(conditions) if isinstance(each, Tuned)]
    written = {each.as_written: None for each in used}
    plain = sorted(written, key=lambda each: (each.constant, each.negated))
    return tuple(dict.fromkeys([*plain, *used]))


def tuned_words(program: Program, value: Tuned) -> tuple[str, ...]:
    """Return the words of which the name of a value is made in generated code."""
    name = program.tunables[value.constant].name
    sign = ("negative",) if value.negated else ()
    return (*sign, name) if value == value.as_written else (*sign, name, "compared")
