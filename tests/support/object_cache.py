"""Objects of C and C++ sources, compiled once for all tests that compile the same text.

An object is named after a digest of the compiler's version, its options and the preprocessed text,
so that a change of any header, source, option or compiler gives another name. Objects are kept for
a day, in a folder of the user; a lock for each name lets test processes wait for one another.
"""

from __future__ import annotations

import contextlib
import fcntl
import functools
import hashlib
import os
import shutil
import subprocess
import tempfile
import time
from collections.abc import Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

LIMIT = 1800.0
"""Seconds that the compiler may take for one source."""

_DAY = 24 * 3600.0
_JOBS = 2


def compile_objects(
    compiler: str, options: Sequence[str], includes: Sequence[str], sources: Iterable[Path]
) -> list[Path]:
    """Compile each source, unless its object is there already, and return the objects.

    Args:
        compiler: the program.
        options: what else than the search path of headers decides the object.
        includes: the options for that search path; of these only what is found there counts.
        sources: the sources.

    Raises:
        AssertionError: with what the compiler printed, if a source does not compile.
    """
    with ThreadPoolExecutor(_JOBS) as pool:
        compiling = [
            pool.submit(_object, compiler, tuple(options), tuple(includes), source)
            for source in sources
        ]
        return [each.result() for each in compiling]


def _object(
    compiler: str, options: tuple[str, ...], includes: tuple[str, ...], source: Path
) -> Path:
    command = [compiler, *options, *includes]
    text = _run([*command, "-E", "-P", str(source)], source.parent)
    identity = "\0".join((_version(compiler), *options, source.suffix, text))
    name = hashlib.sha256(identity.encode()).hexdigest()[:32]
    store = _store()
    path = store / f"{name}.o"
    with (store / f"{name}.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if path.exists():
            os.utime(path)
        else:
            partial = path.with_suffix(".part")
            _run([*command, "-c", str(source), "-o", str(partial)], source.parent)
            partial.replace(path)
    return path


@functools.cache
def _version(compiler: str) -> str:
    return _run([shutil.which(compiler) or compiler, "--version"], Path.cwd())


@functools.cache
def _store() -> Path:
    """Return the folder of the objects, without those that have not been used for a day."""
    store = Path(tempfile.gettempdir()) / f"deros-test-objects-{os.getuid()}"
    store.mkdir(mode=0o700, exist_ok=True)
    for path in store.iterdir():
        with contextlib.suppress(FileNotFoundError):  # another process may remove it, too
            if time.time() - path.stat().st_mtime > _DAY:
                path.unlink()
    return store


def _run(command: Sequence[str], folder: Path) -> str:
    done = subprocess.run(
        command,
        cwd=folder,
        capture_output=True,
        text=True,
        errors="replace",
        timeout=LIMIT,
        check=False,
    )
    assert done.returncode == 0, done.stderr[:20_000]
    return done.stdout
