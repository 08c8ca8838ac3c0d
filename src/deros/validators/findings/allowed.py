"""What allows a finding: a comment in a model, or an entry in the project's file."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from deros.diagnostics import Diagnostic, Span
from deros.interfaces.files import real_path
from deros.metamodels.globbing import path_matches


@dataclass(frozen=True, slots=True)
class Allowance:
    """One code that a comment allows on one line.

    Attributes:
        code: the name of the code.
        line: the line whose findings it silences, from 1.
        reason: why, as the comment says.
        span: the code in the comment.
    """

    code: str
    line: int
    reason: str
    span: Span


@dataclass(frozen=True, slots=True)
class ProjectAllowance:
    """One code that a project allows in all files of a pattern.

    Attributes:
        code: the name of the code.
        pattern: the files, relative to ``root``: ``vendor/**`` or ``models/arm.system``.
        reason: why.
        root: the folder of the project's file, absolute.
        span: the entry in the project's file.
    """

    code: str
    pattern: str
    reason: str
    root: Path
    span: Span

    def covers(self, finding: Diagnostic) -> bool:
        """Return whether a finding is of this code and in a file of the pattern."""
        return finding.code.name == self.code and self.names(finding.span.file)

    def names(self, file: str) -> bool:
        """Return whether a file is one of the pattern."""
        path = Path(file).absolute()
        root = self.root
        if not path.is_relative_to(root):
            path, root = Path(real_path(path)), Path(real_path(root))
        return path.is_relative_to(root) and path_matches(path.relative_to(root), self.pattern)


@dataclass(frozen=True, slots=True)
class Allowed:
    """A finding that is allowed, and by what."""

    finding: Diagnostic
    by: Allowance | ProjectAllowance
