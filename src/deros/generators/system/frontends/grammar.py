r"""Substitutions as the frontends of ``launch`` read them (``launch/frontend/grammar.lark``).

In a text, a substitution is ``$(name operand operand)``. An operand with blanks stands between
quotes; inside these, no further operand can, so what it must not contain is evaluated there:
``$(eval chr\(32\))`` is a blank. A backslash before ``$`` or a closing quote would be taken for
one that escapes it, and is evaluated, too, as are the characters that XML does not have.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from itertools import pairwise

from deros.generators.system.launch.terms import Substitution, Term, Terms

_NAMES = {
    "AllSubstitution": "and",
    "AnySubstitution": "or",
    "Command": "command",
    "EnvironmentVariable": "env",
    "EqualsSubstitution": "equals",
    "FileContent": "file-content",
    "FindExecutable": "find-exec",
    "FindPackageShare": "find-pkg-share",
    "IfElseSubstitution": "if",
    "LaunchConfiguration": "var",
    "NotEqualsSubstitution": "not-equals",
    "NotSubstitution": "not",
    "PythonExpression": "eval",
    "ThisLaunchFileDir": "dirname",
}
_OPERATOR = re.compile(r" ?([-+*/<>=!,]+) ?")
_NOT_IN_XML = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\ufffe\uffff]")


def template(terms: Terms) -> str:
    """Return a text with substitutions, as it stands in an attribute."""
    return "".join(_template(terms, ""))


def escaped(text: str) -> str:
    """Return a text as it stands where escapes count, but no substitutions."""
    return text.replace("\\", "\\\\")


def without_controls(terms: Iterable[Term]) -> Iterator[Term]:
    """Yield terms in which what XML has no character for is evaluated."""
    for term in terms:
        if not isinstance(term, str):
            yield term
            continue
        start = 0
        for found in _NOT_IN_XML.finditer(term):
            yield from filter(None, (term[start : found.start()],))
            yield character(found[0])
            start = found.end()
        yield from filter(None, (term[start:],))


def character(text: str) -> Substitution:
    """Return a substitution that becomes one character."""
    return Substitution("PythonExpression", ((f"chr({ord(text)})",),))


def _template(terms: Iterable[Term], quote: str) -> Iterator[str]:
    """Yield the pieces of a text, or of what stands between quotes."""
    found = list(without_controls(terms))
    for term, after in pairwise([*found, None]):
        assert term is not None
        if not isinstance(term, str):
            yield _substitution(term, quote)
            continue
        is_before_mark = isinstance(after, Substitution) or (after is None and quote)
        evaluated = len(term) - len(term.rstrip("\\")) if is_before_mark else 0
        text = escaped(term[: len(term) - evaluated]).replace("$(", "\\$(")
        yield text.replace(quote, f"\\{quote}") if quote else text
        yield _substitution(character("\\"), quote) * evaluated


def _substitution(found: Substitution, quote: str) -> str:
    """Return a substitution that stands between quotes, or not."""
    operands = "".join(f" {_operand(each, quote)}" for each in _operands(found))
    if found.name == "PythonExpression":
        dense = "".join(f" {_operand(each, quote)}" for each in map(_dense, found.operands))
        operands = min(operands, dense, key=_badness)
    return f"$({_NAMES[found.name]}{operands})"


def _operands(found: Substitution) -> tuple[Terms, ...]:
    """Return the operands as the frontends take them."""
    operands = found.operands
    if found.name in ("AllSubstitution", "AnySubstitution") and len(operands) > 2:
        rest = Substitution(found.name, operands[1:])  # "any" and "all" fail in Jazzy
        return (operands[0], (rest,))
    is_compared = found.name in ("EqualsSubstitution", "NotEqualsSubstitution")
    if is_compared and not all(any(operand) for operand in operands):
        return tuple(("_", *operand) for operand in operands)  # nothing would be read as "[]"
    return operands


def _dense(expression: Terms) -> Terms:
    """Return a Python expression without the blanks that it can do without."""
    texts = [each for each in expression if isinstance(each, str)]
    if any("'" in each or '"' in each for each in texts):
        return expression
    return tuple(_OPERATOR.sub(r"\1", e) if isinstance(e, str) else e for e in expression)


def _badness(text: str) -> tuple[int, int, int]:
    """Return by how much a way to write operands reads worse than another."""
    return (text.count("chr\\("), text.count("\\"), len(text))


def _operand(terms: Terms, quote: str) -> str:
    bare = "".join(_bare(terms, quote))
    if quote:
        return bare or _substitution(Substitution("PythonExpression", (("str()",),)), quote)
    quoted = (f"{mark}{''.join(_template(terms, mark))}{mark}" for mark in "'\"")
    return min([*([bare] if bare else []), *quoted], key=_badness)


def _bare(terms: Terms, quote: str) -> Iterator[str]:
    """Yield the pieces of an operand without quotes of its own."""
    quotes = quote or "'\""
    for term in without_controls(terms):
        if not isinstance(term, str):
            yield _substitution(term, quote)
            continue
        for each in term:
            if each in " \\":
                yield f"$(eval chr\\({ord(each)}\\))"
            elif each in "()" or each in quotes:
                yield f"\\{each}"
            else:
                yield each
