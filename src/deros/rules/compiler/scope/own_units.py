"""Units that rules define under names that are units anyhow."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from deros import codes
from deros.diagnostics import Diagnostic, report
from deros.interfaces.units import UnitRegistry, in_bases, rounded
from deros.models.rules import UnitDefinition

_ROUNDING = 1e-5


def redefined(definitions: Sequence[UnitDefinition], units: UnitRegistry) -> Iterator[Diagnostic]:
    """Yield that a definition gives a known unit another meaning.

    Fields of messages, systems and other rules have the known one. To say what a unit is anyhow,
    to five digits, is no harm: ``unit knot = 0.514444 m/s``.
    """
    built_in = UnitRegistry()
    for each in definitions:
        known = built_in.parse(each.name.text)
        if known is None:
            continue
        given = units.parse(each.factor.unit or "1")
        if (
            given is not None
            and (given.exponents, given.offset) == (known.exponents, known.offset)
            and abs(units.convert(each.factor.value, given, known) - 1) <= _ROUNDING
        ):
            continue
        bases = in_bases(known)
        is_base = bases.text == known.text or known.offset
        what = "" if is_base else f"it is {rounded(known.factor):.6g} {bases}; "
        yield report(
            codes.DUPLICATE_RULE_NAME,
            f"unit '{each.name}' is built in and cannot be defined",
            each.name.span,
            f"{what}give yours another name",
        )
