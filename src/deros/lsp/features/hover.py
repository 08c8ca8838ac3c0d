"""What a word is, in a few lines of Markdown; on a finding, its page."""

from __future__ import annotations

from collections.abc import Iterator
from importlib import resources

from deros.diagnostics import Diagnostic
from deros.interfaces.fields import format_path
from deros.interfaces.store import InterfaceStore
from deros.interfaces.types import InterfaceType
from deros.lsp.analysis import Analysis
from deros.lsp.features.values import in_base_units
from deros.models import rules
from deros.models.node import Parameter, Port
from deros.rules.functions.functions import Function
from deros.systems.flat import FlatPort
from deros.systems.known_topics import KnownTopic
from deros.words.sentences import sentence
from deros.words.words import Word, WordKind

_MOST_FIELDS = 20


def hover(analysis: Analysis, word: Word) -> str:
    """Return what there is to say of a word, in Markdown."""
    head = f"**{word.kind.value}** `{word.name}`"
    if word.type and word.kind is not WordKind.TYPE:
        head += f" : `{word.type}`"
    if word.unit:
        head += f" in `{word.unit}`"
    parts = [head, word.description, *_more(analysis, word)]
    return "\n\n".join(part for part in parts if part)


def page_of(found: Diagnostic) -> str:
    """Return the page of a finding's code, with the finding above it."""
    page = resources.files("deros") / "pages" / f"{found.code.name}.md"
    return f"{found.message}\n\n---\n\n{page.read_text(encoding='utf-8')}"


def _more(analysis: Analysis, word: Word) -> Iterator[str]:
    match word.meaning:
        case rules.Rule() as rule:
            unknown = "\n\nIt counts as true where it is unknown." if rule.failsafe else ""
            yield f"True while {sentence(rule.condition)}.{unknown}"
        case rules.Constant() as constant:
            yield from _constant(analysis, constant)
        case rules.Zone() as zone:
            yield f"`{' '.join(zone.shape_span.text.split())} {zone.unit or ''}`"
        case rules.Input() as each:
            yield f"Read from `{each.term.span.text}`."
            if each.timeout is not None:
                yield f"Missing after {each.timeout.span.text} without a message."
        case rules.Action() as action:
            yield from _action(action)
        case Function() as row:
            yield f"`{row.usage or row.name}`"
        case Parameter() as parameter:
            yield from _parameter(parameter)
        case Port() as port:
            yield f"It {port.kind.value} `{port.type}`." if _is_topic(port) else f"`{port.type}`"
        case KnownTopic() as topic:
            yield from _ends("Published by", topic.publishers)
            yield from _ends("Read by", topic.subscriptions)
        case InterfaceType() as kind:
            yield definition(analysis.workspace.store, kind)
        case (InterfaceType() as kind, tuple() as path):
            yield f"`{format_path(path)}` of `{kind}`"


def _is_topic(port: Port) -> bool:
    return port.kind.value in ("publishes", "subscribes")


def _constant(analysis: Analysis, constant: rules.Constant) -> Iterator[str]:
    yield f"`{constant.value.span.text}`"
    if constant.tunable is not None:
        yield f"Tunable in `{constant.tunable.interval_span.text}`."
    value = in_base_units(analysis, constant)
    if value:
        yield f"= {value}"


def _action(action: rules.Action) -> Iterator[str]:
    if action.binding is not None:
        topic = action.binding.topic
        yield f"While it is active, `{action.binding.value.span.text}` is published on `{topic}`."
    if action.service is not None:
        yield f"It calls `{action.service.service}`."
    if action.binding is None and action.service is None:
        yield "Robot code carries it out."
    if action.latched:
        yield "Once active it stays so until it is reset."
    if action.reset_by is not None:
        yield f"`{action.reset_by}` resets it."


def _parameter(parameter: Parameter) -> Iterator[str]:
    if parameter.default is not None and parameter.default_span is not None:
        yield f"Default: `{parameter.default_span.text}`"
    elif not parameter.has_default:
        yield "It has no default and has to be given."
    if parameter.interval is not None:
        yield f"Range: `{parameter.interval.clause()}`"
    if parameter.read_only:
        yield "It cannot be changed while the node runs."


def _ends(word: str, ports: list[FlatPort]) -> Iterator[str]:
    if ports:
        places = dict.fromkeys(f"`{each.requested}`" for each in ports)
        yield f"{word} {', '.join(places)}."


def definition(store: InterfaceStore, kind: InterfaceType) -> str:
    """Return the fields of a message, or of the parts of a service or action, as a block."""
    message, service, action = store.message(kind), store.service(kind), store.action(kind)
    parts = [(message,) if message is not None else (), service or (), action or ()]
    blocks = []
    for part in next((each for each in parts if each), ()):
        lines = [f"{kind_of} {name}" for name, kind_of in part.fields]
        lines += [f"{each.type} {each.name}={each.value}" for each in part.constants]
        hidden = len(lines) - _MOST_FIELDS
        blocks.append(lines if hidden <= 0 else [*lines[:_MOST_FIELDS], f"… {hidden} more"])
    text = "\n---\n".join("\n".join(lines) for lines in blocks)
    return f"```\n{text}\n```" if text else ""
