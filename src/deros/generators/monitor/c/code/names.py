"""Identifiers of the emitted C: never a keyword of C or C++, never the same twice."""

from __future__ import annotations

import re
from collections.abc import Iterable

from deros.generators.text.identifiers import python_identifier
from deros.generators.text.unique_names import UniqueNames
from deros.names.keywords import CPP_20, C
from deros.rules.program.formulas import SHARED

_STANDARD = """assert errno main NULL NAN INFINITY INT64_MAX INT64_C abs fabs hypot sqrt sin cos
tan atan2 asin fmod remainder fmin fmax index time signal"""
_OURS = """m t now due owner started count verdict condition held rises changed done grace
enabled value both either negated truth_of failsafe heard begun counted lasting earlier ahead
is_number bounded arrive step_back reach_deadline catch_up earliest judge_all evaluate act restart
clear pass move_to rate emitted after follows same"""

RESERVED = C | CPP_20 | frozenset(f"{_STANDARD} {_OURS}".split()) | frozenset(SHARED)
"""Names that nothing made from a model gets."""
_VERBS = {
    *("after", "behave", "compute", "expire", "forget", "judge", "observe", "settle", "take"),
    "which",
}
"""What the names of functions that stand for parts of a model begin with; no prefix does."""


def new_names(taken: Iterable[str] = ()) -> UniqueNames:
    """Return what hands out the identifiers of a program or a function, none of those taken."""
    return UniqueNames(RESERVED.union(taken))


def prefix_of(program_name: str) -> str:
    """Return what every public name begins with: the program's name as a C identifier."""
    words = re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", python_identifier(program_name)).lower()
    prefix = words.strip("_") or "rules"
    taken = prefix in RESERVED or prefix.split("_")[0] in _VERBS
    return f"rules_{prefix}" if prefix[0].isdigit() or taken else prefix
