"""Completion of the word that is being written.

What fits is asked of the grammar, for the text as it is now; the names that fit come from the last
analysis, which may be of an earlier text. So there is an answer at once, however long the file is.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from lsprotocol import types

from deros.diagnostics import SourceFile, Span
from deros.lsp.analysis import Analysis
from deros.lsp.completion import fields, names, units
from deros.lsp.completion.offers import Kind, Offer, Place
from deros.lsp.places import Places
from deros.metamodels.recovery.slots import Slot, Slots
from deros.models.node import PortKind

_WORD = re.compile(r"[\w~/$]*$")
_PART = re.compile(r"\w*$")
_CHAIN = re.compile(
    r"((?:[/~][\w/~]*|[A-Za-z_]\w*)(?:\[[^\[\]\n]*\])*"
    r"(?:\s*\.\s*[A-Za-z_]\w*(?:\([^()\n]*\))?(?:\[[^\[\]\n]*\])*)*)\s*\.\s*$"
)
_PATH = re.compile(r'"([^"\n]*/)?([^"/\n]*)$')
_UNIT_TOKENS = frozenset({"UnitText", "BracketUnit", "LossUnit"})
_LONGEST_LINE = 2000


def complete(
    places: Places, analysis: Analysis, slots: Slots, text: str, position: types.Position
) -> list[types.CompletionItem]:
    """Return what fits at a position.

    Args:
        places: how positions are counted.
        analysis: the last one of the file.
        slots: those of the file's language.
        text: the present text.
        position: of the cursor, behind what has been written of the word.
    """
    source = SourceFile(analysis.file.path, text)
    offset = places.offset(source, position)
    start, offers = _offers(analysis, slots, text, offset)
    found: dict[str, Offer] = {}
    for each in sorted(offers, key=lambda each: each.rank):
        found.setdefault(each.text, each)
    at = places.range(Span(source, start, offset))
    return [_item(each, at) for each in found.values()]


def _item(offer: Offer, at: types.Range) -> types.CompletionItem:
    # Behind what is written with parentheses, the cursor stands between them.
    snippet = offer.text.endswith("()")
    text = f"{offer.text[:-1]}$1)" if snippet else offer.text
    return types.CompletionItem(
        offer.text,
        kind=offer.kind,
        detail=offer.detail or None,
        documentation=offer.description or None,
        sort_text=f"{offer.rank}{offer.text}",
        filter_text=offer.text,
        text_edit=types.TextEdit(at, text),
        insert_text_format=types.InsertTextFormat.Snippet if snippet else None,
    )


def _offers(
    analysis: Analysis, slots: Slots, text: str, offset: int
) -> tuple[int, Iterator[Offer] | list[Offer]]:
    """Return where the word begins that is being written, and what fits there."""
    line_start = max(text.rfind("\n", 0, offset) + 1, offset - _LONGEST_LINE)
    line = text[line_start:offset]
    if line.count('"') % 2:
        return _in_text(analysis, slots, text, offset, line)
    part = offset - len(_last(_PART, line))
    chain = _CHAIN.search(line[: part - line_start])
    if chain is not None:
        begin = line_start + chain.start()
        found = slots.at(text, begin)
        return part, list(_behind_dot(analysis, found, text[:begin], chain[1]))
    start = offset - len(_last(_WORD, line))
    before = text[:start]
    found = slots.at(text, start)
    return start, list(_at_slots(analysis, found, before))


def _last(pattern: re.Pattern[str], line: str) -> str:
    found = pattern.search(line)
    return found[0] if found is not None else ""


def _in_text(
    analysis: Analysis, slots: Slots, text: str, offset: int, line: str
) -> tuple[int, list[Offer]]:
    """Return the same inside of a text in quotes, which may be a path."""
    written = _PATH.search(line)
    if written is None:
        return offset, []
    folder, name = written[1] or "", written[2]
    quote = offset - len(written[0])
    offers: dict[str, Offer] = {}
    for slot in slots.at(text, quote):
        place = Place(analysis, slot, line, text[:quote], folder)
        offers |= {each.text: each for each in names.files(place)}
    return offset - len(name), list(offers.values())


def _at_slots(analysis: Analysis, slots: list[Slot], before: str) -> Iterator[Offer]:
    line = before[before.rfind("\n") + 1 :]
    for slot in _distinct(slots):
        place = Place(analysis, slot, line, before)
        offered = names.OFFERED.get((slot.rule, slot.attribute)) or names.OF_TOKENS.get(slot.token)
        if offered is not None:
            yield from offered(place)
        elif slot.token in _UNIT_TOKENS:
            yield from units.units(place)
        elif slot.rule == "FieldUnit" and slot.attribute == "path":
            yield from _fields(place, "")
        yield from (Offer(each, Kind.Keyword, rank=2) for each in slot.words if each.isidentifier())


def _distinct(slots: list[Slot]) -> list[Slot]:
    """Return one slot for each meaning; of several, the last one is innermost."""
    return list(
        {(each.rule, each.attribute, each.token, each.words): each for each in slots}.values()
    )


def _behind_dot(analysis: Analysis, slots: list[Slot], before: str, chain: str) -> Iterator[Offer]:
    """Yield what may follow a dot, for each way in which the names before it can be read."""
    line = before[before.rfind("\n") + 1 :]
    chain = "".join(chain.split())
    asked = set()
    for slot in _distinct(slots):
        place = Place(analysis, slot, line, before, chain)
        if slot.token == "InterfaceName" and "types" not in asked:
            asked.add("types")
            yield from names.interface_types(place)
        elif slot.rule == "FieldUnit" and slot.attribute == "path":
            yield from _fields(place, chain)
        elif slot.token in ("TermName", "MarkedGraphName", "GraphName") and "terms" not in asked:
            asked.add("terms")
            yield from fields.after_dot(place)


def _fields(place: Place, chain: str) -> Iterator[Offer]:
    """Yield the fields of the message of a port whose units are declared."""
    model = place.analysis.file.model
    ports = getattr(model, "ports", ())
    name = place.slot.read("TopicPort", "name")
    for port in ports:
        if port.name == name and port.kind in (PortKind.PUBLISHER, PortKind.SUBSCRIPTION):
            yield from fields.below(place.analysis.workspace.store, port.type, chain)
            return
