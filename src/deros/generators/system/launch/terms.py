"""Substitutions of ``launch`` as data, of which Python, XML and YAML are written."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Substitution:
    """A substitution.

    Attributes:
        name: of its class in ``launch.substitutions`` or ``launch_ros.substitutions``.
        operands: what it is made of, each of which is a text.
    """

    name: str
    operands: tuple[Terms, ...] = ()


Term = str | Substitution
Terms = tuple[Term, ...]
"""A text: what its terms become, one behind the other."""


def joined(terms: Iterable[Term]) -> Terms:
    """Return terms with neighbouring texts as one, and without empty ones."""
    return tuple(_runs(terms))


def _runs(terms: Iterable[Term]) -> Iterator[Term]:
    text = ""
    for each in terms:
        if isinstance(each, str):
            text += each
            continue
        if text:
            yield text
        text = ""
        yield each
    if text:
        yield text
