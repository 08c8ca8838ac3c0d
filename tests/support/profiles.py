"""How much a run tests: profiles of Hypothesis, and parameters with which a test is slow.

======== ======== ======================== =====================================
profile  examples drawn                    used by
======== ======== ======================== =====================================
local          50 the same in every run    ``make test``, and pytest by default
drawn         200 the same in every run    ``make test-rest``
ci            500 the same in every run    ``make test-all``
nightly      5000 new ones in every run    ``make property``
======== ======== ======================== =====================================

``pytest --hypothesis-profile NAME`` selects one. Tests that take more time per example, or less,
scale their number with :func:`scaled`.
"""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import settings

EXAMPLES = {"local": 50, "drawn": 200, "ci": 500, "nightly": 5000}
"""Examples of each property by profile."""

LEAST = 5
"""The fewest examples that :func:`scaled` returns."""


def register() -> None:
    """Register the profiles and load the local one.

    None has a deadline: the time of one example depends on the load of the machine.
    """
    for name, examples in EXAMPLES.items():
        repeatable = name != "nightly"
        settings.register_profile(
            name, max_examples=examples, deadline=None, derandomize=repeatable, print_blob=True
        )
    settings.load_profile("local")


def scaled(in_ci: int, least: int = LEAST) -> int:
    """Return the number of examples for a property that draws ``in_ci`` of them in CI."""
    return max(least, in_ci * settings().max_examples // EXAMPLES["ci"])


def thinned(in_ci: int) -> int:
    """Return N where one of N cases is tested, and one of ``in_ci`` in CI."""
    return max(1, in_ci * EXAMPLES["ci"] // settings().max_examples)


def draws_new_examples() -> bool:
    """Return whether the loaded profile draws other examples in every run."""
    return not settings().derandomize


def slow(*values: Any) -> Any:
    """Return a parameter of a test, or one value of each, with which the test is slow."""
    return pytest.param(*values, marks=pytest.mark.slow)
