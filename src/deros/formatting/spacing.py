"""Which tokens of a line touch, and which have a blank between them."""

from __future__ import annotations

from deros.metamodels.tokens import SyntaxToken

_TOUCHES_BEFORE = frozenset({",", ";", ")", "]"})
"""Signs that touch what stands before them."""

_TOUCHES_AFTER = frozenset({"(", "["})

_CALLS = frozenset({"Action", "ActionCall", "Arguments", "Entries", "Lookup", "Subsystem"})
"""Rules in which a ``(`` follows a name, and touches it."""

_HEADS = frozenset({"Behaviour", "GateLine", "Rule"})
"""Rules in which a ``:`` ends what is defined, and touches it; elsewhere a type follows."""

_NEGATIVE = frozenset({"Negative", "Opposite"})
_EQUALS = frozenset({"=", "=="})
_UNITS = frozenset({"BracketUnit", "LossUnit", "UnitText"})


def touches(before: SyntaxToken, after: SyntaxToken) -> bool:
    """Return whether there is no blank between two tokens that follow one another in a line."""
    if after.goes_on and after.rule == "Path":
        return _EQUALS.isdisjoint((before.text, after.text))
    if after.goes_on:  # within units, blanks tell an input that is multiplied from another unit
        return after.rule not in _UNITS
    if after.text in _TOUCHES_BEFORE or before.text in _TOUCHES_AFTER:
        return True
    if after.rule == "Path" or (after.within == "Call" and after.text == "."):
        return True
    if before.within == "Call" and before.text == ".":
        return True
    if after.text == "(":
        return after.within in _CALLS
    if after.text == ":":
        return after.within in _HEADS
    return _is_sign(before) and not _is_number(after)


def _is_sign(token: SyntaxToken) -> bool:
    return token.text == "-" and not token.rule and token.within in _NEGATIVE


def _is_number(token: SyntaxToken) -> bool:
    """Return whether a sign before a token would become a part of it."""
    return token.text[0].isdecimal() or token.text[0] == "."
