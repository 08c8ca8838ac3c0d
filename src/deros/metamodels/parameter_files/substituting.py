"""Parameter files in which ``$(…)`` and ``<…>`` stand for values that the system gives.

What is substituted is the text, when the system is started; a check does so with the values of an
assignment of its arguments. A value may stand wherever none of its characters means something to
YAML, so that both say the same.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from deros.diagnostics import Span
from deros.metamodels.parameter_files.scalars import value_of
from deros.models.arguments import LaunchArgument
from deros.models.parameter_files import Document, Event, Fault, Substituted
from deros.names.names import did_you_mean, near

_USE = re.compile(
    r"""\$\((?:var +(?P<var>[^\s()'"]+)"""
    r"""|env +(?P<env>[A-Za-z_]\w*)(?: +(?P<default>[^\s()'"]*))?"""
    r"""|find-pkg-share +(?P<package>\w+)) *\)""",
    re.ASCII,
)
_ANY_USE = re.compile(r"\$\([^()\n]*\)?")
_LOOKS_LIKE_COMMENT = re.compile(r"(?:\A|.*[ \t])#")
_LIKE_ANYTHING = re.compile(r"\$\((?:var|env) [^()\n]*\)")
_MEANT_BY_YAML = re.compile(
    "[\x00-\x1f\x7f-\x9f\u2028\u2029\ud800-\udfff\ufeff\ufffe\uffff\"'\\\\#,\\[\\]{}]"
    r"|\A[ &*!|>%@`?]|\A-(?= |\Z)|:(?= |\Z)| \Z"
)
_HINT = "write '$(var NAME)', '$(env NAME)', '$(env NAME DEFAULT)' or '$(find-pkg-share PACKAGE)'"


def substituted(document: Document, given: Sequence[LaunchArgument]) -> Document:
    """Return a file with what the system gives in place of ``$(…)``, and what is wrong with that.

    Of what is looked up where the system is started, a stand-in is put in.
    """
    values = {each.name: each.value for each in given}
    source = document.source
    uses = list(_USE.finditer(source.text))
    used = frozenset({*_names_in(source.text), *_brackets_in(source.text, values)})
    faults = [*_faults(document, values)]
    steps = tuple(_put_in(event, values, faults) for event in document.events)
    looks_up = any(not use["var"] for use in uses)
    made = Substituted(tuple(values.items()), used, tuple(faults), looks_up)
    return replace(document, events=steps, substituted=made)


def _faults(document: Document, values: Mapping[str, str]) -> Iterator[Fault]:
    for found in _ANY_USE.finditer(document.source.text):
        span = Span(document.source, found.start(), found.end())
        use = _USE.fullmatch(found[0])
        name = use and use["var"]
        is_known = use is not None and (name is None or name in values)
        if not is_known and _is_in_comment(document.source.text, found.start()):
            continue
        if use is None:
            yield Fault(f"'{found[0]}' cannot be substituted", span, _HINT)
        elif name is None:
            continue
        elif name not in values:
            hint = did_you_mean(near(name, values), name) or f"write '{name} = …' behind the path"
            yield Fault(f"the system gives no value for '{name}'", span, hint)
        else:
            yield from _apart(name, values[name], span)
    for name in _brackets_in(document.source.text, values):
        start = document.source.text.index(name)
        yield from _apart(name, values[name], Span(document.source, start, start + len(name)))


def _apart(name: str, value: str, span: Span) -> Iterator[Fault]:
    """Yield that YAML would take a value apart, if it would."""
    if _MEANT_BY_YAML.search(value):
        what = f"'{name}' is '{value}' here, which would not be one value of YAML"
        yield Fault(what, span, "give it with 'param', which takes any text")


def _is_in_comment(text: str, position: int) -> bool:
    """Tell whether the text before a position, in its line, looks like the head of a comment."""
    start = text.rfind("\n", 0, position) + 1
    return _LOOKS_LIKE_COMMENT.match(text[start:position]) is not None


def _put_in(event: Event, values: Mapping[str, str], faults: list[Fault]) -> Event:
    brackets = _brackets_in(event.text, values)
    if event.kind != "scalar" or not (brackets or "$(" in event.text):
        return event
    is_left = "$(" in _USE.sub("", event.text) or not _names_in(event.text) <= values.keys()
    place = range(event.span.start, event.span.end)
    if is_left and not any(fault.span.start in place for fault in faults):
        faults.append(Fault(f"'{event.text}' cannot be substituted", event.span, _HINT))
    text = _USE.sub(lambda use: _value(use, values), event.text)
    for name in brackets:
        text = text.replace(name, values[name])
    is_text = isinstance(value_of(text, is_text=event.is_text), str)
    is_bare = not _LIKE_ANYTHING.sub("", event.text) or event.text in brackets
    if is_text and not event.is_text and is_bare:
        what = f"'{event.text}' is a text here, and a number or a bool as soon as it looks like one"
        faults.append(Fault(what, event.span, f'put it in quotes: "{event.text}"'))
    return replace(event, text=text)


def _brackets_in(text: str, values: Mapping[str, str]) -> list[str]:
    return [name for name in values if name.startswith("<") and name in text]


def _names_in(text: str) -> set[str]:
    return {use["var"] for use in _USE.finditer(text) if use["var"]}


def _value(use: re.Match[str], values: Mapping[str, str]) -> str:
    if use["var"] is not None:
        return values.get(use["var"], use["var"])
    if use["package"] is not None:
        return f"share:{use['package']}"
    return str(use["env"] if use["default"] is None else use["default"])
