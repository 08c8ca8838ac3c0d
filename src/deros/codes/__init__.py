"""The diagnostic codes, each declared once.

The hundreds name the family: 0 reading and syntax, 1 node descriptions, 2 system descriptions,
3 safety rules, 4 generation, 5 traces, 6 zones of safety rules, and what monitors of load and of
transforms watch. Every code has a page of its name under ``docs/diagnostics/`` and a case under
``tests/cases/`` (generation and traces: a test). The meaning of a code never changes.
"""

from __future__ import annotations

from deros.diagnostics import ALL_CODES as ALL_CODES
from deros.diagnostics import SLUGS as SLUGS
from deros.diagnostics import find as find

# Declared in the order of their numbers.
# isort: off
from deros.codes.reading import *  # noqa: F403
from deros.codes.nodes import *  # noqa: F403
from deros.codes.systems import *  # noqa: F403
from deros.codes.rules import *  # noqa: F403
from deros.codes.rules import (
    GATE_BYPASSED,
    GATE_NOT_IN_SYSTEM,
    SAFETY_DESCRIPTION_DIFFERS,
    SAFETY_NOT_GENERATED,
)
from deros.codes.outcomes import *  # noqa: F403
from deros.codes.zones import *  # noqa: F403
from deros.codes.monitors import *  # noqa: F403
# isort: on

CORRECTED_BY_GENERATING = frozenset(
    {GATE_BYPASSED, GATE_NOT_IN_SYSTEM, SAFETY_DESCRIPTION_DIFFERS, SAFETY_NOT_GENERATED}
)
"""Errors of a system whose safety nodes have to be generated, or generated again, before."""

OF_MODELS = frozenset(
    code
    for code in ALL_CODES.values()
    if not code.name.startswith(("DRS4", "DRS5")) and not "DRS020" <= code.name <= "DRS027"
)
"""Codes of findings about the content of models, not about generated files or traces."""
