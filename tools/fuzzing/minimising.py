"""Making a mutant that fails as small as it goes, while it fails in the same way."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import replace

from tools.fuzzing.mutants import Mutant

Fails = Callable[[Mutant], bool]


def minimise(mutant: Mutant, fails: Fails, seconds: float) -> Mutant:
    """Return a smaller mutant for which ``fails`` is still true.

    Whole files go first, then lines, then characters of the files that were changed. What is left
    when the time is up is returned.
    """
    until = time.monotonic() + seconds
    for path in [each for each in mutant.files if each != mutant.entry]:
        fewer = {name: content for name, content in mutant.files.items() if name != path}
        smaller = replace(mutant, files=fewer)
        if time.monotonic() < until and fails(smaller):
            mutant = smaller
    for separator in (b"\n", b" ", b""):
        for path in sorted(mutant.files):
            mutant = _file(mutant, path, separator, fails, until)
    return mutant


def _file(mutant: Mutant, path: str, separator: bytes, fails: Fails, until: float) -> Mutant:
    content = mutant.files[path]
    pieces = content.split(separator) if separator else [bytes([each]) for each in content]

    def still(kept: Sequence[bytes]) -> bool:
        return fails(mutant.with_file(path, separator.join(kept)))

    return mutant.with_file(path, separator.join(_reduced(pieces, still, until)))


def _reduced(
    pieces: list[bytes], still: Callable[[Sequence[bytes]], bool], until: float
) -> list[bytes]:
    """Return the pieces without those that can go: halves first, then ever smaller runs."""
    run = max(1, len(pieces) // 2)
    while pieces:
        start = 0
        while start < len(pieces):
            if time.monotonic() >= until:
                return pieces
            without = pieces[:start] + pieces[start + run :]
            if still(without):
                pieces = without
            else:
                start += run
        if run == 1:
            break
        run //= 2
    return pieces
