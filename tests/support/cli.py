"""Runs the command line in this process, as the shell would."""

from __future__ import annotations

import contextlib
import io
from dataclasses import dataclass

from deros.cli.main import run


@dataclass(frozen=True)
class Outcome:
    """What a run of ``deros`` did."""

    code: int
    out: str
    err: str


def deros(*arguments: object) -> Outcome:
    """Run ``deros`` with the given arguments."""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        code = run([str(argument) for argument in arguments])
    return Outcome(code, out.getvalue(), err.getvalue())
