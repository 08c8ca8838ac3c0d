"""What was written by hand in the examples' packages is fit for ROS packages."""

from __future__ import annotations

import pytest

from tests.support.examples import EXAMPLES
from tests.support.lint import assert_lint_clean


@pytest.mark.parametrize("example", ["feeding_robot", "intelligent_one"])
def test_the_bodies_of_the_nodes_pass_the_linters_of_ament(example: str) -> None:
    """The tests that come with every generated package hold for the filled-in ones, too."""
    assert_lint_clean(EXAMPLES / example / "src")
