"""Changes, and how parts of two versions are compared: by tables of their aspects.

A *part* is what a model consists of: a port, a parameter, a node, a rule. A table says for each
kind of part which aspects it has, how each is read and written, and whom a change of it breaks.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Generic, Literal, TypeVar

from deros.diagnostics import Span

Part = TypeVar("Part")

Kind = Literal["removed", "added", "changed"]

NOTHING = "none"
"""What stands for an aspect that a part does not have."""


@dataclass(frozen=True, slots=True)
class Change:
    """One change.

    Attributes:
        kind: whether the part is in one version only, or an aspect of it differs.
        part: the kind of part, ``parameter``.
        name: the name of the part, in the old version if it is there.
        aspect: of a changed part, what differs; else empty.
        old: the aspect in the old version, or what the part was; ``None`` if it is added.
        new: the same in the new version; ``None`` if it is removed.
        old_span: where the part is in the old version.
        new_span: where it is in the new one.
        breaks: whom the change breaks and why; empty, if it is compatible.
    """

    kind: Kind
    part: str
    name: str
    aspect: str
    old: str | None
    new: str | None
    old_span: Span | None
    new_span: Span | None
    breaks: str = ""


Verdict = Callable[[Any, Any], str]
"""Returns whom a change of an aspect from one value to another breaks and why, or nothing."""


def compatible(old: object, new: object) -> str:
    """Say of any change that it breaks nobody."""
    del old, new
    return ""


def breaking(why: str) -> Verdict:
    """Return the verdict that any change breaks, for one reason."""
    return lambda _old, _new: why


@dataclass(frozen=True, slots=True)
class Aspect(Generic[Part]):
    """One aspect of a kind of part.

    Attributes:
        name: in words, as in ``default``.
        read: returns the value that is compared; values that mean the same are equal.
        breaks: decides about a change, given the old and the new value.
        say: writes a value.
    """

    name: str
    read: Callable[[Part], Any]
    breaks: Verdict = compatible
    say: Callable[[Any], str] = str


@dataclass(frozen=True, slots=True)
class PartKind(Generic[Part]):
    """How parts of one kind are compared.

    Attributes:
        word: the kind, in words.
        name: returns the name that users know a part by.
        span: returns where a part is written.
        aspects: what is compared; ``None``: all that a part has, as ``aspects_of`` says.
        summary: writes a part that is in one version only.
        removed: returns whom it breaks that a part is gone, and why.
        added: returns whom a new part breaks, and why.
        keys: by which parts of both versions are matched, the first one first. Parts that share a
            key are matched in their order.
        aspects_of: returns the aspects of a pair whose names are not the same for all.
    """

    word: str
    name: Callable[[Part], str]
    span: Callable[[Part], Span | None]
    aspects: Sequence[Aspect[Part]]
    summary: Callable[[Part], str]
    removed: Callable[[Part], str] = lambda _part: ""
    added: Callable[[Part], str] = lambda _part: ""
    keys: Sequence[Callable[[Part], Hashable]] = ()
    aspects_of: Callable[[Part, Part], Sequence[Aspect[Part]]] = lambda _old, _new: ()


def compare(kind: PartKind[Part], old: Sequence[Part], new: Sequence[Part]) -> Iterator[Change]:
    """Yield the changes of all parts of one kind: those gone, those changed, and new ones."""
    pairs, gone, come = matched(kind.keys or (kind.name,), old, new)
    for part in gone:
        yield Change(
            "removed",
            kind.word,
            kind.name(part),
            "",
            kind.summary(part),
            None,
            kind.span(part),
            None,
            kind.removed(part),
        )
    for before, after in pairs:
        yield from changed(kind, before, after)
    for part in come:
        yield Change(
            "added",
            kind.word,
            kind.name(part),
            "",
            None,
            kind.summary(part),
            None,
            kind.span(part),
            kind.added(part),
        )


def changed(kind: PartKind[Part], old: Part, new: Part) -> Iterator[Change]:
    """Yield the changes of one part that is in both versions."""
    for aspect in (*kind.aspects, *kind.aspects_of(old, new)):
        before, after = aspect.read(old), aspect.read(new)
        if before != after:
            yield Change(
                "changed",
                kind.word,
                kind.name(old),
                aspect.name,
                _said(aspect, before),
                _said(aspect, after),
                kind.span(old),
                kind.span(new),
                aspect.breaks(before, after),
            )


def _said(aspect: Aspect[Any], value: object) -> str:
    return NOTHING if value is None or value in ((), "") else aspect.say(value)


def matched(
    keys: Sequence[Callable[[Part], Hashable]], old: Sequence[Part], new: Sequence[Part]
) -> tuple[list[tuple[Part, Part]], list[Part], list[Part]]:
    """Return the pairs of parts that correspond, in the old order, and those without another."""
    pairs: dict[int, int] = {}
    free = set(range(len(new)))
    for key in keys:
        waiting: dict[Hashable, list[int]] = {}
        for position in sorted(free, reverse=True):
            waiting.setdefault(key(new[position]), []).append(position)
        for position, part in enumerate(old):
            if position not in pairs and (found := waiting.get(key(part))):
                pairs[position] = found.pop()
                free.discard(pairs[position])
    return (
        [(old[before], new[after]) for before, after in sorted(pairs.items())],
        [part for position, part in enumerate(old) if position not in pairs],
        [new[position] for position in sorted(free)],
    )
