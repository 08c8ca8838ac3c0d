"""Output and messages that several commands share."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from collections.abc import Sequence

    from deros.diagnostics import Diagnostic
    from deros.metamodels.languages import Language


def show(diagnostics: Sequence[Diagnostic]) -> None:
    """Write findings to standard error."""
    from deros.report.text import print_text

    print_text(diagnostics, sys.stderr)


def wrong_language(file: str, expected: Language) -> click.UsageError:
    """Return the error for a model of another language than a command works on."""
    return click.UsageError(f"it takes {expected.title} ({expected.pattern}), not '{file}'")
