"""Fetch elkjs from npm, which lays out the page of ``deros graph --format html``.

The file is verified by its digest and put beside the page's own scripts, with its licence; it is
not part of the repository, but of what is built from it. Exit code 1 says that it is not there.
With ``--if-possible``, that is only printed: all else works without it.
"""

from __future__ import annotations

import argparse
import hashlib
import io
import shutil
import subprocess
import sys
import tarfile
import tempfile
from pathlib import Path

from deros.report.page.elkjs import DIGEST, FILE, VERSION

FOLDER = Path(__file__).resolve().parents[1] / "src/deros/report/page/assets/elkjs"
_LIMIT = 120.0


class Failure(Exception):  # noqa: N818 - the program did its work, and there is no elkjs
    """elkjs cannot be had; the text says why."""


def is_there(folder: Path = FOLDER) -> bool:
    """Return whether a folder has elkjs in the right version."""
    path = folder / FILE
    return path.is_file() and _digest(path.read_bytes()) == DIGEST


def fetch() -> bytes:
    """Return npm's archive of the package.

    Raises:
        Failure: npm is missing, or does not get it.
    """
    npm = shutil.which("npm")
    if npm is None:
        raise Failure("there is no npm")
    with tempfile.TemporaryDirectory(prefix="deros-elkjs-") as folder:
        command = [npm, "pack", "--silent", "--pack-destination", folder, f"elkjs@{VERSION}"]
        try:
            done = subprocess.run(
                command, cwd=folder, capture_output=True, text=True, timeout=_LIMIT, check=False
            )
        except subprocess.TimeoutExpired:
            raise Failure(f"npm did not get elkjs@{VERSION} in {_LIMIT:.0f} s") from None
        archives = list(Path(folder).glob("*.tgz"))
        if done.returncode or len(archives) != 1:
            raise Failure(f"npm did not get elkjs@{VERSION}: {done.stderr.strip()}")
        return archives[0].read_bytes()


def unpack(archive: bytes, folder: Path = FOLDER) -> None:
    """Put elkjs and its licence into a folder.

    Raises:
        Failure: the archive lacks one of them, or it is not the elkjs that was tested.
    """
    with tarfile.open(fileobj=io.BytesIO(archive)) as package:
        script, licence = (_member(package, name) for name in (f"lib/{FILE}", "LICENSE.md"))
    if _digest(script) != DIGEST:
        raise Failure(f"npm's elkjs@{VERSION} has another digest than the one that was tested")
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "LICENSE.md").write_bytes(licence)
    (folder / FILE).write_bytes(script)


def _member(package: tarfile.TarFile, name: str) -> bytes:
    try:
        found = package.extractfile(f"package/{name}")
    except KeyError:
        found = None
    if found is None:
        raise Failure(f"npm's elkjs@{VERSION} has no {name}")
    return found.read()


def _digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


def main(arguments: list[str] | None = None) -> int:
    """Fetch elkjs unless it is there."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--if-possible", action="store_true", help="fail in no case")
    options = parser.parse_args(arguments)
    if is_there():
        return 0
    try:
        unpack(fetch())
    except Failure as failure:
        print(f"no elkjs, so no 'deros graph --format html': {failure}", file=sys.stderr)
        return 0 if options.if_possible else 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
