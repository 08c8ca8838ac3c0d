"""What to write instead of a habit of other languages, where a template cannot say it."""

from __future__ import annotations

import re

NUMBER = r"[+-]?(?:\d+(?:\.\d+)?|\.\d+)(?:[eE][+-]?\d+)?"
"""A number as other languages write it, with its sign."""


def interval(match: re.Match[str]) -> str:
    """Return a chain of comparisons as an interval."""
    opening = "[" if match["first"] == "<=" else "("
    closing = "]" if match["last"] == "<=" else ")"
    low, high = match["low"].strip(), match["high"].strip()
    return f"{match['name']} in {opening}{low}, {high}{closing}"


def in_quotes(match: re.Match[str]) -> str:
    """Return a name with arguments in it as a text in quotes."""
    return '"' + re.sub(r"\$\{?(\w+)\}?", r"${\1}", match[0]) + '"'


def value_of_argument(match: re.Match[str]) -> str:
    """Return a word as the value of an argument, if the text declares one of that name."""
    word = match["word"]
    if re.search(rf"\bargument\s+{word}\b", match.string) is None:
        return match[0]  # which repairs nothing
    return f"{match[0].removesuffix(word)}${word}"


def lower(match: re.Match[str]) -> str:
    """Return a word in lower case."""
    return match[0].lower()


_GATE_TYPE = re.compile(r"\bgate\b[^{}]*?:\s*(?P<type>[\w./]+)\s+rate\b")
_TWISTS = {"Twist": "", "TwistStamped": "twist."}


def ramp(match: re.Match[str]) -> str:
    """Return how to write a ramp; of a twist the unit tells which fields it can be."""
    types = [each["type"] for each in _GATE_TYPE.finditer(match.string, 0, match.start())]
    name = re.split(r"[./]", types[-1])[-1] if types else ""
    field = "FIELD"
    if name in _TWISTS:
        turns = (match["unit"] or "").startswith(("rad", "deg"))
        field = _TWISTS[name] + ("angular.z" if turns else "linear.x")
    rate = " ".join((match["rate"] or "RATE").split())
    return f"write each field that ramps, and its change per second: 'zero ramp {field} {rate}'"
