"""The linters of ament on generated C and C++."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

_VENDOR = Path(sys.prefix) / "opt/uncrustify_vendor/bin"
_LIMIT = 300.0


def assert_cpp_lint_clean(folder: Path) -> None:
    """Run uncrustify, cpplint and, where there is one, cppcheck over a folder as ament sets them.

    Raises:
        AssertionError: with what they find, or if one of them fails.
    """
    run_linter("ament_uncrustify", folder)
    run_linter("ament_cpplint", folder)
    if shutil.which("cppcheck"):
        run_linter("ament_cppcheck", folder)


def run_linter(name: str, folder: Path) -> None:
    """Run one of ament's linters over a folder.

    Raises:
        AssertionError: with what it finds, or if it fails.
    """
    search = [str(Path(sys.executable).parent), str(_VENDOR), os.environ.get("PATH", "")]
    env = {
        **os.environ,
        "PATH": os.pathsep.join(search),
        "AMENT_CPPCHECK_ALLOW_SLOW_VERSIONS": "1",  # it does nothing with Debian's else
    }
    done = subprocess.run(
        [name, "."],
        cwd=folder,
        env=env,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=_LIMIT,
        check=False,
    )
    assert done.returncode == 0, done.stdout
