"""What cppcheck's MISRA addon finds in emitted C, sorted by how binding the rules are.

The texts of the rules are not free; their numbers and categories are.
"""

from __future__ import annotations

import re
import shutil
import subprocess
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

from deros.generators.monitor.c.deviations import DEVIATIONS

CPPCHECK = "cppcheck"

MANDATORY = frozenset(
    [
        "9.1",
        "12.5",
        "13.6",
        "17.3",
        "17.4",
        "17.6",
        "19.1",
        "21.13",
        "21.17",
        "21.18",
        "21.19",
        "21.20",
        "22.2",
        "22.4",
        "22.5",
        "22.6",
    ]
)
"""Rules of MISRA C:2012, with its first amendments, from which no deviation is allowed."""

ADVISORY = frozenset(
    [
        "1.2",
        "2.3",
        "2.4",
        "2.5",
        "2.6",
        "2.7",
        "4.2",
        "5.9",
        "8.7",
        "8.9",
        "8.11",
        "8.13",
        "10.5",
        "11.4",
        "11.5",
        "12.1",
        "12.3",
        "12.4",
        "13.3",
        "13.4",
        "15.1",
        "15.4",
        "15.5",
        "17.5",
        "17.8",
        "18.4",
        "18.5",
        "19.2",
        "20.1",
        "20.5",
        "21.12",
    ]
)
"""Rules that are recommended. All others are required."""

ALLOWED = frozenset(
    each.guideline.removeprefix("Rule ")
    for each in DEVIATIONS
    if each.guideline.startswith("Rule ")
)
"""Advisory rules that the emitted text says it does not follow."""


@dataclass(frozen=True)
class Violation:
    """A place in a file where a rule is not followed."""

    file: str
    line: int
    rule: str

    @property
    def category(self) -> str:
        """How binding the rule is."""
        if self.rule in MANDATORY:
            return "mandatory"
        return "advisory" if self.rule in ADVISORY else "required"

    @property
    def is_allowed(self) -> bool:
        """Whether the emitted text says so itself."""
        return self.category == "advisory" and self.rule in ALLOWED

    def __str__(self) -> str:
        """Return the line that a developer reads."""
        return f"{self.file}:{self.line}: rule {self.rule} ({self.category})"


def has_cppcheck() -> bool:
    """Tell whether cppcheck is there."""
    return shutil.which(CPPCHECK) is not None


def violations(texts: Iterable[Mapping[str, str]], folder: Path) -> list[Violation]:
    """Return what the addon finds in the files of monitors.

    Raises:
        AssertionError: cppcheck or its addon does not run.
    """
    sources = []
    for files in texts:
        for name, text in files.items():
            if name.endswith("_contracts.h"):
                continue  # no compiler reads it
            (folder / name).write_text(text, encoding="utf-8")
            if name.endswith(".c"):
                sources.append(name)
    command = [CPPCHECK, "--addon=misra", "--std=c99", "--platform=unix64", "--enable=style"]
    options = ["--suppress=missingIncludeSystem", "--quiet", "--template={file}:{line}:{id}"]
    done = subprocess.run(
        [*command, *options, *sources],
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=600,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    found = re.findall(r"^(.+?):(\d+):(\S+)$", done.stderr, flags=re.MULTILINE)
    failed = [place for place in found if place[2] in ("internalError", "syntaxError")]
    assert not failed, done.stderr
    places = (
        Violation(file, int(line), kind.removeprefix("misra-c2012-"))
        for file, line, kind in found
        if kind.startswith("misra-c2012-")
    )
    return [each for each in places if not _is_misread(each, folder)]


def _is_misread(violation: Violation, folder: Path) -> bool:
    """Return whether the addon reports parentheses missing which cppcheck has dropped before.

    It drops those around arithmetic that is the second operand of ``?:``.
    """
    lines = (folder / violation.file).read_text(encoding="utf-8").splitlines()
    statement = "\n".join(lines[: violation.line]).rpartition(";\n")[2]
    return violation.rule == "12.1" and "? (" in statement
