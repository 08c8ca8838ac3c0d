"""Libraries of many C monitors, which the processes of a test run compile but once."""

from __future__ import annotations

import subprocess
from collections.abc import Sequence
from pathlib import Path

from tests.support.c_harness import DRIVER, Unit, library_text
from tests.support.c_library import COMPILER, LIMIT, STRICT, Loaded
from tests.support.object_cache import compile_objects


class Shared(Loaded):
    """A library like any other one, whose object is there already."""

    def __init__(self, units: Sequence[Unit], built: Path, path: Path) -> None:
        """Link the object of the monitors, and load the library."""
        command = [COMPILER, "-shared", "-Wl,-Bsymbolic", str(built), "-o", str(path), "-lm"]
        subprocess.run(command, check=True, capture_output=True, timeout=LIMIT)
        self._load(units, path)


def shared(libraries: Sequence[Sequence[Unit]], folder: Path, *flags: str) -> list[Shared]:
    """Return libraries of monitors; they are compiled at the same time unless they are stored.

    Raises:
        AssertionError: with what the compiler printed, if one does not compile.
    """
    sources = []
    for number, units in enumerate(libraries):
        place = folder / str(number)
        place.mkdir()
        for each in units:
            for file, text in each.texts.items():
                (place / file).write_text(text, encoding="utf-8")
        sources.append(place / "library.c")
        sources[-1].write_text(library_text(units), encoding="utf-8")
    options = [*STRICT, "-fPIC", *flags]
    objects = compile_objects(COMPILER, options, ["-I", str(DRIVER)], sources)
    return [
        Shared(units, built, source.with_name("monitors.so"))
        for units, built, source in zip(libraries, objects, sources, strict=True)
    ]
