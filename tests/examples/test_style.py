"""Hand-written code in the packages of the examples passes the ROS linters."""

from __future__ import annotations

import pytest

from tests.support.examples import EXAMPLES
from tests.support.lint import assert_lint_clean


@pytest.mark.parametrize(
    "example", ["feeding_robot", "frobit", "intelligent_one", "kobuki", "physics"]
)
def test_node_bodies_pass_the_ament_linters(example: str) -> None:
    """The linter tests of every generated package pass with filled-in code too."""
    assert_lint_clean(EXAMPLES / example / "src")
