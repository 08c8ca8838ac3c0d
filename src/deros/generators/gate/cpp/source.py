"""Names, conditions and comments of the C++ that is emitted for gates."""

from __future__ import annotations

from collections.abc import Sequence

from deros.diagnostics import Span
from deros.generators.text.c import lay_out_if
from deros.generators.text.cpp import (
    LINE_LENGTH,
    Text,
    expression,
    is_reserved,
    wrapped,
)
from deros.generators.text.provenance import origin
from deros.generators.text.unique_names import UniqueNames

_OURS = """applying begin bounded command follow is_heartbeat_lost is_input_lost is_latched is_new
is_zero keep limit limits message may_release no_limit settle std t zero LATEST LINES LONG_AGO
NEVER PERIOD REFUSING"""


class CppNames(UniqueNames):
    """Unique C++ identifiers, which also differ from those in the templates."""

    def __init__(self) -> None:
        """Reserve the names that the templates use."""
        super().__init__(frozenset(_OURS.split()))

    def new(self, *parts: str | int, endings: Sequence[str] = ()) -> str:
        """Return an identifier of ``parts`` that is free, as it is and with each of ``endings``."""
        name = super().new(*parts, endings=endings)
        if is_reserved(name):
            name = super().new(name, "value", endings=endings)
        return name


# Layout -------------------------------------------------------------------------------------------


def string_lines(text: str, indent: int) -> str:
    """Return a string literal that begins in column ``indent``, in parts where it is too long."""
    lines = expression(Text(text), indent + 1, ",")[:-1].replace("\n ", "\n")
    return f"({lines})" if "\n" in lines else lines  # else a comma might seem to be forgotten


def if_head(operands: Sequence[str], indent: int) -> str:
    """Return the head of an ``if`` whose operands all have to hold."""
    return "\n".join(lay_out_if(" && ", operands, indent, LINE_LENGTH)).lstrip()


def origin_comment(indent: int, title: str, span: Span) -> list[str]:
    """Return the comment above a block: its title, its origin and the source's text."""
    lead = f"{' ' * indent}// "
    lines = [f"{lead}{line}" for line in wrapped(f"{title} ({origin(span)})", len(lead))]
    for text in span.text.splitlines():
        lines += [f"{lead}  {line}" for line in wrapped(text, len(lead) + 2)]
    return lines
