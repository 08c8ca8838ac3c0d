"""Which parts of a system a finding is about."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence

from deros.diagnostics import Diagnostic, SourceFile, Span
from deros.models.system import Subsystem
from deros.systems.flat import FlatNode, FlatPort, FlatProgram, FlatTopic

Key = tuple[int, ...]
"""By which a part is known: the identities of objects of the flat system, outermost first."""


class Subjects:
    """The findings by the part that each is about: the smallest one that its place lies in.

    A finding in a node description is about every node of that type, one in rules about the nodes
    that they become.
    """

    def __init__(
        self,
        programs: Iterable[FlatProgram],
        topics: Iterable[FlatTopic],
        groups: Iterable[Subsystem],
        findings: Sequence[Diagnostic],
    ) -> None:
        """Find what each of ``findings`` is about."""
        parts: dict[SourceFile, list[tuple[Span, Key]]] = defaultdict(list)
        for span, key in _parts(programs, topics, groups):
            parts[span.source].append((span, key))
        self._findings: dict[Key, list[int]] = defaultdict(list)
        for number, finding in enumerate(findings):
            inside = [
                (span.end - span.start, key)
                for span, key in parts.get(finding.span.source, ())
                if span.start <= finding.span.start and finding.span.end <= span.end
            ]
            least = min((size for size, _ in inside), default=0)
            for key in dict.fromkeys(key for size, key in inside if size == least):
                self._findings[key].append(number)

    def of(self, *parts: object) -> tuple[int, ...]:
        """Return the positions of the findings about a part, given as its objects."""
        return tuple(self._findings.get(tuple(map(id, parts)), ()))


def _parts(
    programs: Iterable[FlatProgram],
    topics: Iterable[FlatTopic],
    groups: Iterable[Subsystem],
) -> Iterator[tuple[Span, Key]]:
    for topic in topics:
        yield topic.declaration.span, (id(topic),)
    for group in groups:
        yield group.span, (id(group),)
    for program in programs:
        yield from _parts_of(program)


def _parts_of(program: FlatProgram) -> Iterator[tuple[Span, Key]]:
    key = (id(program),)
    yield program.instance.span, key
    if not isinstance(program, FlatNode):
        return
    for port in program.ports:
        yield from _places_of(port, program, (*key, id(port)))
    for untyped in program.untyped:
        yield untyped.wiring.span, (*key, id(untyped))
    if program.type is not None:
        yield program.type.span, key
    rules = program.statement.rules if program.statement is not None else None
    if rules is not None:
        yield Span(rules.source, 0, len(rules.source.text)), key


def _places_of(port: FlatPort, node: FlatNode, key: Key) -> Iterator[tuple[Span, Key]]:
    # A safety node's ports stand in its rules, where a finding is about the node as a whole.
    if node.statement is not None:
        return
    yield port.port.span, key
    if port.wiring is not None:
        yield port.wiring.span, key
