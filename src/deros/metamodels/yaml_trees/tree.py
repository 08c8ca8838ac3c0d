"""YAML as a tree whose nodes know their places.

Texts of other tools are read, so what YAML allows is understood: anchors, aliases, merged keys. A
scalar has the value that YAML 1.1 gives it, as PyYAML reads it, which those tools use.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

from deros.diagnostics import SourceFile, Span
from deros.metamodels.parameter_files.events import DEEPEST, span_of, yaml_fault
from deros.models.common import Scalar as Value
from deros.models.parameter_files import Fault

LARGEST = 200_000
"""The most nodes of a tree, those behind aliases counted each time."""

_PREFIX = "tag:yaml.org,2002:"


class NotATreeError(Exception):
    """The text is not YAML, or is more than a file of that kind has; ``fault`` says where."""

    def __init__(self, fault: Fault) -> None:
        """Store the fault."""
        super().__init__(fault.message)
        self.fault = fault


@dataclass(frozen=True, slots=True)
class Scalar:
    """A single value; ``None`` is null, and an empty place."""

    value: Value | None
    text: str
    is_quoted: bool
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Sequence:
    """A list."""

    items: tuple[Tree, ...]
    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Mapping:
    """Keys with their values, in order.

    Attributes:
        entries: by the text of the key; of a key that comes twice, the last one counts.
        keys: the place of each key.
        repeated: the places of those that do not count.
        unnamed: the places of keys that are no scalars.
    """

    entries: dict[str, Tree]
    keys: dict[str, Span]
    span: Span = field(compare=False, repr=False)
    repeated: tuple[Span, ...] = ()
    unnamed: tuple[Span, ...] = ()

    def get(self, key: str) -> Tree | None:
        """Return the value of a key, or ``None``."""
        return self.entries.get(key)


Tree = Scalar | Sequence | Mapping


def tree_of(source: SourceFile) -> Tree | None:
    """Return the first document of a text; ``None`` if it has none.

    Raises:
        NotATreeError: if it is not YAML, or larger or deeper than what people write.
    """
    import yaml

    loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    try:
        return _Builder(source, yaml.parse(source.text, Loader=loader)).document()
    except yaml.YAMLError as error:
        fault = yaml_fault(error, source)
        raise NotATreeError(Fault(fault.message, fault.span)) from error


class _Builder:
    """Builds a tree from the events of a parser."""

    def __init__(self, source: SourceFile, events: Iterator[Any]) -> None:
        import yaml

        self._source = source
        self._events = events
        self._scalars = _Scalars(yaml)
        self._anchors: dict[str, tuple[Tree, int]] = {}
        self._count = 0

    def document(self) -> Tree | None:
        for event in self._events:
            if type(event).__name__ not in ("StreamStartEvent", "DocumentStartEvent"):
                return None if type(event).__name__ == "StreamEndEvent" else self._node(event, 0)
        return None

    def _node(self, event: Any, depth: int) -> Tree:
        span = span_of(event, self._source)
        if depth > DEEPEST:
            raise NotATreeError(Fault(f"this is nested more than {DEEPEST} levels deep", span))
        kind = type(event).__name__
        if kind == "AliasEvent":
            return self._alias(event, span)
        before = self._count
        self._add(1, span)
        if kind == "ScalarEvent":
            made: Tree = self._scalars.of(event, span)
        elif kind == "SequenceStartEvent":
            items = []
            while type(each := next(self._events)).__name__ != "SequenceEndEvent":
                items.append(self._node(each, depth + 1))
            made = Sequence(tuple(items), self._up_to(span, each))
        else:
            made = self._mapping(span, depth)
        if event.anchor is not None:
            self._anchors[event.anchor] = (made, self._count - before)
        return made

    def _alias(self, event: Any, span: Span) -> Tree:
        if event.anchor not in self._anchors:
            raise NotATreeError(Fault(f"'*{event.anchor}' stands for nothing above it", span))
        found, size = self._anchors[event.anchor]
        self._add(size, span)
        return found

    def _add(self, size: int, span: Span) -> None:
        self._count += size
        if self._count > LARGEST:
            raise NotATreeError(Fault(f"this has more than {LARGEST} values", span))

    def _mapping(self, span: Span, depth: int) -> Mapping:
        entries: dict[str, Tree] = {}
        keys: dict[str, Span] = {}
        repeated: list[Span] = []
        unnamed: list[Span] = []
        merged: list[Tree] = []
        while type(each := next(self._events)).__name__ != "MappingEndEvent":
            key, value = self._node(each, depth + 1), self._node(next(self._events), depth + 1)
            if not isinstance(key, Scalar):
                unnamed.append(key.span)
            elif key.text == "<<" and not key.is_quoted:
                merged += value.items if isinstance(value, Sequence) else (value,)
            else:
                if key.text in entries:
                    repeated.append(keys[key.text])
                entries[key.text], keys[key.text] = value, key.span
        for other in merged:
            if not isinstance(other, Mapping):
                raise NotATreeError(Fault("'<<' takes what stands elsewhere with '*'", other.span))
            entries = {**other.entries, **entries}
            keys = {**other.keys, **keys}
        whole = self._up_to(span, each)
        return Mapping(entries, keys, whole, tuple(repeated), tuple(unnamed))

    def _up_to(self, span: Span, event: Any) -> Span:
        return Span(span.source, span.start, max(span.end, span_of(event, self._source).end))


class _Scalars:
    """Gives scalars the values that YAML 1.1 says they have."""

    def __init__(self, yaml: Any) -> None:
        self._yaml = yaml
        self._resolver = yaml.resolver.Resolver()
        self._constructor = yaml.constructor.SafeConstructor()

    def of(self, event: Any, span: Span) -> Scalar:
        text: str = event.value
        is_quoted = event.style is not None and event.style != ""
        tag = event.tag
        if tag is None or tag == "!":
            plain = (not is_quoted, is_quoted)
            tag = self._resolver.resolve(self._yaml.ScalarNode, text, plain)
        value: Value | None = text
        name = tag.removeprefix(_PREFIX)
        if name == "null":
            value = None
        elif name in ("bool", "int", "float"):
            try:
                value = self._constructor.construct_object(self._yaml.ScalarNode(tag, text))
            except (ValueError, KeyError, IndexError, OverflowError):
                value = text  # what YAML calls a number, and nobody can read
        return Scalar(value, text, is_quoted, span)
