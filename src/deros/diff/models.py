"""Which models of two sides correspond, and the changes of each."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from deros.diff.changes import Change, Kind, matched
from deros.diff.nodes import NODE_TYPE, compare_node_types
from deros.diff.rules import compare_rules
from deros.diff.systems import SYSTEM, compare_systems
from deros.models.node import NodeType
from deros.models.rules import Rules
from deros.models.system import System

Model = NodeType | System | Rules


@dataclass(frozen=True, slots=True)
class Side:
    """One model of one side.

    Attributes:
        path: by which it corresponds with one of the other side: within the folder that was named,
            or empty for a file that was named itself.
        shown: the path that users know it by.
        model: what is compared.
    """

    path: str
    shown: str
    model: Model


@dataclass(frozen=True, slots=True)
class FileChanges:
    """The changes of one model.

    Attributes:
        old: the path of the model in the old version; ``None`` if it is new.
        new: its path in the new version; ``None`` if it is gone.
        changes: in the order of kinds of parts, and of the parts as written.
    """

    old: str | None
    new: str | None
    changes: tuple[Change, ...]

    @property
    def breaking(self) -> tuple[Change, ...]:
        """The changes that break somebody."""
        return tuple(each for each in self.changes if each.breaks)


def compare_models(old: Sequence[Side], new: Sequence[Side]) -> Iterator[FileChanges]:
    """Yield the changes of all models that have some.

    Models correspond that have the same path, and of the others those of one language that have the
    same name: such a file has been moved, which by itself is no change.
    """
    keys = (lambda s: (type(s.model), s.path), lambda s: (type(s.model), s.model.name))
    pairs, gone, come = matched(keys, old, new)
    for before, after in pairs:
        changes = tuple(_changes(before.model, after.model))
        if changes:
            yield FileChanges(before.shown, after.shown, changes)
    for side in gone:
        yield FileChanges(side.shown, None, (_whole(side.model, is_new=False),))
    for side in come:
        yield FileChanges(None, side.shown, (_whole(side.model, is_new=True),))


def _changes(old: Model, new: Model) -> Iterator[Change]:
    if isinstance(old, NodeType) and isinstance(new, NodeType):
        yield from compare_node_types(old, new)
    elif isinstance(old, System) and isinstance(new, System):
        yield from compare_systems(old, new)
    elif isinstance(old, Rules) and isinstance(new, Rules):
        yield from compare_rules(old, new)


def _whole(model: Model, *, is_new: bool) -> Change:
    words = {NodeType: NODE_TYPE.word, System: SYSTEM.word, Rules: "rules"}
    span = model.span if not isinstance(model, Rules) else None
    why = "" if is_new else "whoever uses the file or what it defines"
    places = (None, span) if is_new else (span, None)
    texts = (None, "") if is_new else ("", None)
    kind: Kind = "added" if is_new else "removed"
    return Change(
        kind, words[type(model)], model.name, "", texts[0], texts[1], places[0], places[1], why
    )
