"""What an export makes: a text, and what that cannot say."""

from __future__ import annotations

from dataclasses import dataclass

from deros.diagnostics import Span


@dataclass(frozen=True, slots=True)
class Exported:
    """A model in another format.

    Attributes:
        text: the file.
        missing: what is in the model and not in the file, a line each with file and line.
    """

    text: str
    missing: tuple[str, ...]


def missing(span: Span, what: str, why: str) -> str:
    """Return the line for something that the file cannot say."""
    return f"{span.file}:{span.line}: {what} {why}"
