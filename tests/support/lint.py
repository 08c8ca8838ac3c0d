"""The linters of ament on generated Python."""

from __future__ import annotations

import os
from pathlib import Path


def assert_lint_clean(folder: Path) -> None:
    """Run flake8 and pep257 over a folder as ament sets them.

    Raises:
        AssertionError: with what they find, or if one of them fails.
    """
    import flake8_class_newline
    from ament_flake8.main import main_with_errors as ament_flake8
    from ament_pep257.main import main as ament_pep257

    before = Path.cwd()
    os.chdir(folder)
    try:
        # It remembers the lines of files with the same names, those of other folders, too.
        flake8_class_newline.new_lines_on.clear()
        assert ament_flake8(argv=[]) == (0, [])
        assert ament_pep257(argv=["."]) == 0
    finally:
        os.chdir(before)
