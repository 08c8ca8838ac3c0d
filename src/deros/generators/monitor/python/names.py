"""Names of the emitted modules that are reserved, and the name of a program in their first line.

No name from a model is one of those that are reserved.
"""

from __future__ import annotations

import re

from deros.generators.monitor.python.formulas import function_name
from deros.generators.text.identifiers import PYTHON_WORDS
from deros.rules.functions.functions import FUNCTIONS
from deros.rules.program.formulas import SHARED

MODULE_NAMES = frozenset(
    {
        *("Callable", "Collection", "Sequence", "NamedTuple", "copy", "functools", "math", "np"),
        *("Event", "ExplainedMonitor", "Explanation", "Monitor", "RuleState", "explained"),
        *(
            "RateWindow",
            "because",
            "beams_text",
            "blind_beams",
            "cell",
            "per_second",
            "scan_beams",
            "shown",
            "stamp_of",
            "unknown_of",
            "verdict_on",
            "without_value",
        ),
        *("all_of", "any_of", "given"),
        *("NAN", "NEVER", "OPTIONAL", "RULES_OF"),
    }
)
METHOD_NAMES = frozenset(
    {
        *(
            "act",
            "advance",
            "catch_up",
            "earliest",
            "enable",
            "evaluate",
            "explain",
            "hold",
            "is_reset",
        ),
        *("disabled", "reset", "restart", "rules_of", "told_apart", "trigger", "verdicts"),
        "waiting",
    }
)
LOCAL_NAMES = frozenset(
    {
        *("changed", "due", "emit", "fresh", "now", "self", "started", "t", "verdict"),
        *("causes", "found", "rules"),
        *("cosine", "length", "sine", "ux", "uy", "uz", "uw"),
    }
)

_FUNCTION_NAMES = {
    *(function_name(row) for row in FUNCTIONS.values()),
    *(row.guard.python_call for row in FUNCTIONS.values() if row.guard),
    *SHARED,
}
RESERVED = MODULE_NAMES | METHOD_NAMES | LOCAL_NAMES | _FUNCTION_NAMES | PYTHON_WORDS

_LONGEST_TITLE = 31


def title(name: str) -> str:
    """Return the name of a program, short enough for the first line, and without odd characters."""
    printed = re.sub(r"[^\w .-]", "_", name)
    return printed if len(printed) <= _LONGEST_TITLE else f"{printed[: _LONGEST_TITLE - 3]}..."
