"""What is offered, and the place that it is offered for."""

from __future__ import annotations

from dataclasses import dataclass

from lsprotocol import types

from deros.lsp.analysis import Analysis
from deros.metamodels.recovery.slots import Slot

Kind = types.CompletionItemKind


@dataclass(frozen=True, slots=True)
class Offer:
    """One text that fits.

    Attributes:
        text: what is written.
        kind: what it is.
        detail: its type and unit, or the like.
        description: what its declaration says about it.
        rank: what fits best comes first; those of one rank are sorted by their text.
    """

    text: str
    kind: types.CompletionItemKind
    detail: str = ""
    description: str = ""
    rank: int = 1


@dataclass(frozen=True, slots=True)
class Place:
    """Where something is written.

    Attributes:
        analysis: of the file, perhaps of an earlier text; its models know the names.
        slot: what is written there.
        line: the text of the line before the word that is being written.
        before: the whole text before that word.
        chain: the names, with dots between, that a field is written behind; ``""``: it is none.
    """

    analysis: Analysis
    slot: Slot
    line: str
    before: str
    chain: str = ""
