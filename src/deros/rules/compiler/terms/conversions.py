"""Whether the unit of a term converts to another one."""

from __future__ import annotations

from fractions import Fraction

from deros import codes
from deros.interfaces.units import Unit
from deros.models import rules
from deros.rules.compiler.scope.scope import Scope

_TEMPERATURES = {"C": ("coulomb", "degC"), "F": ("farad", "degF")}
_GRAVITY = 9.80665
"""Standard gravity in m/s^2 (3rd General Conference on Weights and Measures, 1901)."""


def compatible(scope: Scope, found: Unit, wanted: Unit, term: rules.Term) -> bool:
    """Return whether a term's unit converts to the wanted one; report it if it does not."""
    if scope.units.compatible(found, wanted):
        return True
    need = "a plain number" if wanted.text == "1" else f"{wanted.text} ({wanted.dimension})"
    message = f"'{term.span.text}' is in {found.text} ({found.dimension}), {need} is needed"
    scope.fault(codes.INCOMPATIBLE_UNITS, message, term.span, _meant(found, wanted, term))
    return False


def _meant(found: Unit, wanted: Unit, term: rules.Term) -> str:
    """Return a hint where a letter is another unit: free fall, or a degree of temperature."""
    if found.text in _TEMPERATURES and wanted.exponents == (("K", Fraction(1)),):
        name, degree = _TEMPERATURES[found.text]
        return f"'{found.text}' is the {name}: write '{degree}'"
    is_acceleration = wanted.exponents == (("m", Fraction(1)), ("s", Fraction(-2)))
    if found.text != "g" or not is_acceleration or not isinstance(term, rules.Number):
        return ""
    meant = float(term.value) * _GRAVITY
    return f"'g' is the gram; free fall is {_GRAVITY} m/s^2: write '{meant:.6g} m/s^2'"
