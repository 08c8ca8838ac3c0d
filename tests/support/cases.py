"""Models under ``tests/cases`` that carry their expected findings inline.

A finding is expected on a line by a comment at its end, several by several::

    connect odmo to /odom  //! error[DRS204]: node type 'base' has no port 'odmo' (hint: did …)

What stands after the colon is the message, or a part of it, and the hint. A case that cannot hold a
comment (it is no text, or no file) has its expectations beside it in ``NAME.expected``, one a line,
the line's number in front: ``1 //! error[DRS001]: …``. Everything that a case imports stands in
``support/`` and carries expectations of its own.

A folder below ``robots/`` is one case, checked as a whole: a small robot with the fault that a
public report is about (``docs/reports.md``), or, with ``_corrected`` at its end, without it.
"""

from __future__ import annotations

import contextlib
import os
import re
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from deros.diagnostics import Diagnostic
from deros.interfaces.store import InterfaceStore
from deros.metamodels.imports import shown_path
from deros.metamodels.load import Repository
from deros.pipeline.workspace import Workspace
from deros.rules.compiler.build_cache import BuildCache

DIRECTORY = Path(__file__).resolve().parents[1] / "cases"
MARK = "//!"
_EXPECTATION = re.compile(r"(error|warning|info)\[(DRS\d{3})\](?:: (.*))?")
_NO_CASES = {".py", ".md", ".expected"}
_FOLDERS = {"support", "robots", "__pycache__"}
_MODELS = {".rnd", ".system", ".deros"}


@dataclass(frozen=True, order=True)
class Expectation:
    """One expected finding: where, how bad, which, and a part of what it says."""

    file: str
    line: int
    severity: str
    code: str
    text: str = ""

    def met_by(self, finding: Diagnostic) -> bool:
        """Tell whether ``finding`` is the one expected."""
        place = (finding.span.file, finding.span.line, finding.severity.value, finding.code.name)
        expected = (self.file, self.line, self.severity, self.code)
        return place == expected and self.text in words(finding)


def words(finding: Diagnostic) -> str:
    """Return the message and, in brackets, the hint of a finding."""
    return finding.message + (f" (hint: {finding.hint})" if finding.hint else "")


def all_cases() -> list[str]:
    """Return the names of all cases in order."""
    return sorted(p.name for p in DIRECTORY.iterdir() if _is_case(p))


def robots() -> list[str]:
    """Return the names of the folders that are a case each, in order."""
    folders = (DIRECTORY / "robots").iterdir()
    return sorted(p.relative_to(DIRECTORY).as_posix() for p in folders)


def _is_case(path: Path) -> bool:
    return path.suffix not in _NO_CASES and path.name not in _FOLDERS


def run(name: str, directory: Path = DIRECTORY) -> tuple[list[Diagnostic], list[str]]:
    """Check one case as ``deros check`` does; return its findings and the files that it read.

    Args:
        name: of the case.
        directory: where it is, with what it imports.
    """
    with _in_directory(directory):
        repository = Repository()
        inside = sorted(p for p in Path(name).glob("*") if p.suffix in _MODELS)
        named = [repository.load(each.as_posix()) for each in inside or [Path(name)]]
        # No environment: a case must read the same on every machine.
        store = InterfaceStore([interfaces(name)], prefixes=())
        workspace = Workspace(tuple(named), (), repository, store, BuildCache(store))
        findings = workspace.check().findings
        paths = *repository.parameter_files.paths, *repository.launch_files.paths
        read = [shown_path(str(each)) for each in paths]
        return findings, [*(each.path for each in repository.files), *read]


def interfaces(name: str) -> Path:
    """Return the folder with the message definitions of a case, below :data:`DIRECTORY`."""
    own = Path(name, "msgs")
    return own if Path(DIRECTORY, own).exists() else Path("support/interfaces")


def expectations(file: str) -> list[Expectation]:
    """Return what the case or support file ``file`` expects."""
    path = DIRECTORY / file
    beside = path.with_name(f"{path.name}.expected")
    if beside.exists():
        numbered = [line.split(" ", 1) for line in beside.read_text().splitlines()]
        lines = {int(number): text for number, text in numbered}
    else:
        text = path.read_bytes().decode(errors="replace")
        lines = dict(enumerate(text.split("\n"), start=1))
    found: list[Expectation] = []
    for number, line in lines.items():
        for part in line.split(MARK)[1:]:
            match = _EXPECTATION.fullmatch(part.strip())
            assert match, f"{file}:{number}: not an expectation: {part.strip()}"
            found.append(Expectation(file, number, match[1], match[2], match[3] or ""))
    return found


def refresh(name: str) -> None:
    """Rewrite the expectations of a case, and of what it imports, to what is found now."""
    findings, files = run(name)
    by_place: dict[str, dict[int, list[str]]] = defaultdict(lambda: defaultdict(list))
    for finding in findings:
        text = f"{MARK} {finding.severity.value}[{finding.code.name}]: {words(finding)}"
        by_place[finding.span.file][finding.span.line].append(text)
    for file in files:
        path = DIRECTORY / file
        beside = path.with_name(f"{path.name}.expected")
        if beside.exists():
            lines = [f"{n} {' '.join(t)}\n" for n, t in sorted(by_place[file].items())]
            beside.write_text("".join(lines))
            continue
        before = f"# {MARK}" if path.suffix == ".yaml" else MARK
        old = path.read_text(encoding="utf-8").split("\n")
        new = [
            "  ".join([line.split(before)[0].rstrip(), *by_place[file][number]]).rstrip()
            for number, line in enumerate(old, start=1)
        ]
        new = [line.replace(MARK, before, 1) for line in new]
        path.write_text("\n".join(new), encoding="utf-8")


@contextlib.contextmanager
def _in_directory(path: Path) -> Iterator[None]:
    before = Path.cwd()
    os.chdir(path)
    try:
        yield
    finally:
        os.chdir(before)
