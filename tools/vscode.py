"""Package the extension for Visual Studio Code into ``dist/``, as one file that VS Code installs.

It is built in a temporary folder from ``editors/vscode`` with what ``package-lock.json`` names, and
has the version of deros. Exit code 1 says that there is no file; the reason is printed.
"""

from __future__ import annotations

import argparse
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

from deros import __version__

REPOSITORY = Path(__file__).resolve().parents[1]
SOURCE = REPOSITORY / "editors/vscode"
_LIMIT = 600.0
_OPTIONS = (
    "--no-dependencies",  # all that is needed is in the bundle
    "--no-git-tag-version",
    "--no-update-package-json",
    "--allow-missing-repository",
)


class Failure(Exception):  # noqa: N818 - the program did its work, and there is no extension
    """The extension cannot be packaged; the text says why."""


def package(output: Path) -> Path:
    """Write the extension into a folder; return its file.

    Raises:
        Failure: npm is missing, or one of its steps failed.
    """
    npm = shutil.which("npm")
    if npm is None:
        raise Failure("there is no npm; install Node.js 20 or later")
    output.mkdir(parents=True, exist_ok=True)
    path = output.resolve() / f"deros-{__version__}.vsix"
    with tempfile.TemporaryDirectory(prefix="deros-vscode-") as temporary:
        folder = Path(temporary, "extension")
        shutil.copytree(SOURCE, folder, ignore=shutil.ignore_patterns("node_modules", "dist"))
        shutil.copy(REPOSITORY / "LICENSE", folder)
        packed = folder / "packed.vsix"
        # Nothing that comes with the tools is run but the tools.
        _run([npm, "ci", "--ignore-scripts", "--no-audit", "--no-fund"], folder)
        vsce = [npm, "exec", "--", "vsce", "package", __version__]
        _run([*vsce, *_OPTIONS, "--out", packed.name], folder)
        shutil.move(packed, path)
    return path


def _run(command: Sequence[str], folder: Path) -> None:
    shown = " ".join(["npm", *command[1:]])
    try:
        done = subprocess.run(
            command, cwd=folder, capture_output=True, text=True, timeout=_LIMIT, check=False
        )
    except subprocess.TimeoutExpired:
        raise Failure(f"{shown} did not end within {_LIMIT:.0f} s") from None
    if done.returncode:
        raise Failure(f"{shown} failed:\n{done.stdout}{done.stderr}".rstrip())


def main(arguments: list[str] | None = None) -> int:
    """Package the extension, and name the file."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--output", type=Path, default=REPOSITORY / "dist")
    options = parser.parse_args(arguments)
    try:
        path = package(options.output)
    except Failure as failure:
        print(f"no extension for VS Code: {failure}", file=sys.stderr)
        return 1
    print(path)
    return 0


if __name__ == "__main__":
    sys.exit(main())
