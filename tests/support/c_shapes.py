"""The shapes of C: what is left of functions, types and tables without what comes from the rules.

Texts of the same shapes are written by the same parts of the generator.
"""

from __future__ import annotations

import functools
import re

from tests.support.c_snippets import KINDS, SMALLEST_RULES, kind_of, named, texts

_IGNORED = re.compile(r"/\*.*?\*/|^#(?!define).*?$|^extern \"C\" \{$", re.DOTALL | re.MULTILINE)
_STRING = r'"(?:\\.|[^"\\])*"'
_STATES = (
    "active|base|came|condition|enabled|kept|known|last|last_t|missing|ran|since|total|until|window"
)
_MESSAGE = re.compile(r"(?:observe|take|small_on)\b;?")
_ALIKE = tuple(
    (re.compile(pattern, re.MULTILINE), form)
    for pattern, form in (
        (rf"{_STRING}(?: {_STRING})*", '""'),
        (r"^#define .*$", r"\g<0>;"),
        (r"-?\b\d[\d.]*(?:e[-+]?\d+)?U?L*\b", "x"),
        (r"-(?=INT64_C)", ""),
        (r"\bSMALL_(?:ACTION|BEHAVIOUR)_\w+", "x"),
        *((rf"\b{pattern}(?=\()", form) for pattern, form in KINDS),
        (rf"\b{_MESSAGE.pattern}(?=\()", "message"),
        (rf"\b[A-Za-z]\w*?_({_STATES})(?:_\d)?\b(?!\()", r"x_\1"),
        (r"(?<= )(?:[<>]|[=!<>]=)(?= )", "<"),
    )
)
"""What differs in what is otherwise alike."""

_CALL = re.compile(r"(\w*)\(([^()]*)\)")
_OF_ANYTHING = re.compile(r"(?:message|compute)$")
_OF_VERDICTS = re.compile(r"(?:both|either|negated|failsafe|lasting|recent)$")


def shapes(text: str, name: str = "small") -> set[tuple[str, str]]:
    """Return what expressions and statements look like in the functions of each kind.

    Literals, comparisons, repeated parts, and names that come from rules are the same in each.

    Args:
        text: of a header or a source.
        name: of the monitor.
    """
    text = re.sub(rf"\b{name}_", "small_", text)
    text = re.sub(rf"\b{name.upper()}_", "SMALL_", text)
    blocks: dict[str, str] = {}
    for key, block in named(text):
        kind = _MESSAGE.sub("message", kind_of(key))
        blocks[kind] = f"{blocks.get(kind, '')}\n{block}\n"
    return {(kind, shape) for kind, block in blocks.items() for shape in _shapes(block)}


def _shapes(text: str) -> set[str]:
    text = _IGNORED.sub("", text)
    for pattern, form in _ALIKE:
        text = pattern.sub(form, text)
    words = _words()
    text = re.sub(
        r"\b(?!x_)[A-Za-z_]*[a-z]\w*\b(?!\()",
        lambda each: each[0] if each[0] in words else "x",
        text,
    )
    text = re.sub(r"\bm->x(?=\b|_)", "x", text)
    found: set[str] = set()

    def folded(call: re.Match[str]) -> str:
        function, arguments = call.groups()
        if _OF_VERDICTS.match(function):
            arguments = re.sub(r"\bx_\w+", "x", arguments)
        parts = arguments.split(",") if _OF_ANYTHING.match(function) else [arguments]
        found.update(f"{function}({_alike(part)})" for part in parts)
        return "x"

    while (shorter := _CALL.sub(folded, text)) != text:
        text = shorter
    found |= {_alike(each) for each in re.split(r"[;{}]", text)}
    return found - {""}


def _alike(text: str) -> str:
    text = " ".join(text.split())
    while (shorter := re.sub(r"\b(\w+)((?:,| &&| \|\|) \1)+\b", r"\1", text)) != text:
        text = shorter
    return text


@functools.cache
def _words() -> set[str]:
    """Return the names that are in every monitor, and the types of C."""
    text = _IGNORED.sub("", "".join(texts(SMALLEST_RULES).values()))
    named = {
        each
        for each in re.findall(r"\b[a-z]\w*", text)
        if not re.match(r"(?:v|e|data|behaviour)(?:_|$)", each)
    }
    return named | {
        "double",
        "float",
        "size_t",
        "char",
        *(f"{sign}int{bits}_t" for sign in ("u", "") for bits in (8, 16, 32, 64)),
    }
