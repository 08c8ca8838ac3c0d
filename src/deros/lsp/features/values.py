"""Values that the text does not show: constants in base units, names resolved."""

from __future__ import annotations

from collections.abc import Iterator

from lsprotocol import types

from deros.interfaces.units import in_bases, is_one
from deros.lsp.analysis import Analysis
from deros.lsp.places import Places
from deros.models import rules
from deros.models.rules import Rules
from deros.rules.compiler.scope.resolved import Quantity
from deros.words.words import WordKind


def in_base_units(analysis: Analysis, constant: rules.Constant) -> str:
    """Return a constant's value in base units; ``""`` where it has none, or is written so."""
    model = analysis.file.model
    if not isinstance(model, Rules):
        return ""
    value = analysis.workspace.builds.of(model).constants.get(constant.name.text)
    if not isinstance(value, Quantity) or value.unit is None:
        return ""
    base = in_bases(value.unit)
    shown = f"{float(value.in_unit(base)):.6g}"
    text = shown if is_one(base) else f"{shown} {base}"
    return "" if text == " ".join(constant.value.span.text.split()) else text


def hints(places: Places, analysis: Analysis, asked: types.Range) -> Iterator[types.InlayHint]:
    """Yield the values of converted constants, and full names of topics written otherwise."""
    start = places.offset(analysis.source, asked.start)
    end = places.offset(analysis.source, asked.end)
    model = analysis.file.model
    for constant in model.constants if isinstance(model, Rules) else ():
        if start <= constant.value.span.end <= end and (text := in_base_units(analysis, constant)):
            yield types.InlayHint(
                places.position(analysis.source, constant.value.span.end),
                f"= {text}",
                padding_left=True,
            )
    for word in analysis.index:
        is_other = word.kind is WordKind.TOPIC and word.name != word.span.text
        if is_other and start <= word.span.end <= end and not isinstance(model, Rules):
            at = places.position(analysis.source, word.span.end)
            yield types.InlayHint(at, word.name, padding_left=True)
