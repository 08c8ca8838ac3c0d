"""The outline of a file, what can be folded in it, and what its words are, for colours."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from lsprotocol import types

from deros.diagnostics import Span
from deros.lsp.analysis import Analysis
from deros.lsp.places import Places
from deros.models.node import NodeType
from deros.models.rules import Behaviour, Rules
from deros.models.system import NodeInstance, Subsystem, System
from deros.words.words import Word, WordKind

_Kind = types.SymbolKind

TOKENS: dict[WordKind, types.SemanticTokenTypes] = {
    WordKind.NODE_TYPE: types.SemanticTokenTypes.Class,
    WordKind.SYSTEM: types.SemanticTokenTypes.Namespace,
    WordKind.NODE: types.SemanticTokenTypes.Variable,
    WordKind.SUBSYSTEM: types.SemanticTokenTypes.Namespace,
    WordKind.PROCESS: types.SemanticTokenTypes.Variable,
    WordKind.HOST: types.SemanticTokenTypes.Variable,
    WordKind.ARGUMENT: types.SemanticTokenTypes.Parameter,
    WordKind.PARAMETER: types.SemanticTokenTypes.Property,
    WordKind.PORT: types.SemanticTokenTypes.Property,
    WordKind.TIMER: types.SemanticTokenTypes.Event,
    WordKind.TOPIC: types.SemanticTokenTypes.Variable,
    WordKind.TYPE: types.SemanticTokenTypes.Type,
    WordKind.FIELD: types.SemanticTokenTypes.Property,
    WordKind.UNIT: types.SemanticTokenTypes.Number,
    WordKind.CONSTANT: types.SemanticTokenTypes.Variable,
    WordKind.MESSAGE_CONSTANT: types.SemanticTokenTypes.EnumMember,
    WordKind.INPUT: types.SemanticTokenTypes.Variable,
    WordKind.ZONE: types.SemanticTokenTypes.Variable,
    WordKind.ENTITY: types.SemanticTokenTypes.Namespace,
    WordKind.RULE: types.SemanticTokenTypes.Event,
    WordKind.ACTION: types.SemanticTokenTypes.Function,
    WordKind.BEHAVIOUR: types.SemanticTokenTypes.Event,
    WordKind.FUNCTION: types.SemanticTokenTypes.Method,
}
"""The colours of words; paths of files keep that of texts."""

_CONSTANTS = frozenset({WordKind.CONSTANT, WordKind.MESSAGE_CONSTANT, WordKind.ZONE})
LEGEND = types.SemanticTokensLegend(
    [each.value for each in dict.fromkeys(TOKENS.values())],
    [
        types.SemanticTokenModifiers.Declaration.value,
        types.SemanticTokenModifiers.Readonly.value,
    ],
)
_DECLARATION, _READONLY = 1, 2


def colours(places: Places, words: Iterable[Word]) -> list[int]:
    """Return the words as the protocol encodes them: five numbers each, relative to the last."""
    data: list[int] = []
    line = column = 0
    end = -1
    for word in words:
        kind = TOKENS.get(word.kind)
        if kind is None or word.span.start < end or "\n" in word.span.text:
            continue
        end = word.span.end
        at = places.position(word.span.source, word.span.start)
        same = at.line == line
        data += (at.line - line, at.character - column if same else at.character)
        data += (places.length(word.span), LEGEND.token_types.index(kind.value))
        data.append(_DECLARATION * word.declares | _READONLY * (word.kind in _CONSTANTS))
        line, column = at.line, at.character
    return data


def outline(places: Places, analysis: Analysis) -> list[types.DocumentSymbol]:
    """Return the outline of a file."""
    match analysis.file.model:
        case NodeType() as node:
            return _of_node(places, node)
        case System() as system:
            return _of_system(places, system)
        case Rules() as rules:
            return _of_rules(places, rules)
        case _:
            return []


def foldings(outline: Iterable[types.DocumentSymbol]) -> Iterator[types.FoldingRange]:
    """Yield what can be folded: each part of an outline that takes several lines."""
    for each in outline:
        if each.range.end.line > each.range.start.line:
            yield types.FoldingRange(each.range.start.line, each.range.end.line)
        yield from foldings(each.children or ())


def _symbol(
    places: Places,
    name: str,
    kind: types.SymbolKind,
    whole: Span,
    place: Span,
    detail: str = "",
    children: list[types.DocumentSymbol] | None = None,
) -> types.DocumentSymbol:
    inside = whole.start <= place.start and place.end <= whole.end
    return types.DocumentSymbol(
        name or "…",
        kind,
        places.range(whole),
        places.range(place if inside else whole),
        detail or None,
        children=children,
    )


def _of_node(places: Places, node: NodeType) -> list[types.DocumentSymbol]:
    parts = [
        _symbol(places, p.name, _Kind.Property, p.span, p.name_span, p.type.value)
        for p in node.parameters
    ]
    parts += [
        _symbol(
            places, p.name, _Kind.Interface, p.span, p.name_span, f"{p.kind.word} {p.type.short}"
        )
        for p in node.ports
    ]
    parts += [
        _symbol(places, t.name, _Kind.Event, t.span, t.name_span, "timer") for t in node.timers
    ]
    return [_symbol(places, node.name, _Kind.Class, node.span, node.name_span, node.package, parts)]


def _of_system(places: Places, system: System) -> list[types.DocumentSymbol]:
    parts = [
        _symbol(places, a.name, _Kind.Property, a.span, a.name_span, "argument")
        for a in system.arguments
    ]
    parts += _of_group(places, system)
    return [
        _symbol(places, system.name, _Kind.Module, system.span, system.name_span, "system", parts)
    ]


def _of_group(places: Places, group: System | Subsystem) -> list[types.DocumentSymbol]:
    found = [
        _symbol(
            places, t.name, _Kind.Field, t.span, t.name_span, t.type.short if t.type else "topic"
        )
        for t in group.topics
    ]
    for member in group.members:
        if isinstance(member, NodeInstance):
            kind, detail, children = _Kind.Object, member.type_name, None
        else:
            kind, detail = _Kind.Namespace, member.system_name or "subsystem"
            children = [] if member.launch is not None else _of_group(places, member)
        found.append(
            _symbol(places, member.name, kind, member.span, member.name_span, detail, children)
        )
    found += [
        _symbol(places, p.name, _Kind.Object, p.span, p.name_span, "process")
        for p in group.processes
    ]
    found += [
        _symbol(places, s.path, _Kind.Object, s.span, s.path_span, "safety") for s in group.safety
    ]
    return found


def _of_rules(places: Places, rules: Rules) -> list[types.DocumentSymbol]:
    found = [
        _symbol(places, each.name.text, _Kind.Function, each.span, each.name.span, "action")
        for each in rules.actions
    ]
    found += [
        _symbol(
            places, each.name.text, _Kind.Constant, each.span, each.name.span, each.value.span.text
        )
        for each in rules.constants
    ]
    found += [
        _symbol(
            places, each.name.text, _Kind.Variable, each.span, each.name.span, each.term.span.text
        )
        for each in rules.inputs
    ]
    found += [
        _symbol(places, each.name.text, _Kind.Constant, each.span, each.name.span, "zone")
        for each in rules.zones
    ]
    for entity in rules.entities:
        parts = [
            _symbol(places, each.name.text, _Kind.Event, each.span, each.name.span)
            for each in entity.rules
        ]
        found.append(
            _symbol(
                places,
                entity.name.text,
                _Kind.Namespace,
                entity.span,
                entity.name.span,
                "entity",
                parts,
            )
        )
    found += [_of_behaviour(places, each) for each in rules.behaviours]
    found += [
        _symbol(places, each.target.text, _Kind.Interface, each.span, each.target.span, "gate")
        for each in rules.gates
    ]
    return sorted(found, key=lambda each: (each.range.start.line, each.range.start.character))


def _of_behaviour(places: Places, behaviour: Behaviour) -> types.DocumentSymbol:
    inner = [_of_behaviour(places, each) for each in behaviour.body if isinstance(each, Behaviour)]
    place = behaviour.name.span if behaviour.name is not None else behaviour.condition.span
    name = behaviour.name.text if behaviour.name is not None else " ".join(place.text.split())
    return _symbol(places, name, _Kind.Event, behaviour.span, place, "behaviour", inner)
