"""Checks for inputs without a timeout."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from deros import codes
from deros.diagnostics import Diagnostic, Span, report
from deros.interfaces.fields import format_path
from deros.models.rules import (
    Arithmetic,
    Call,
    Entries,
    Input,
    NamePath,
    Negative,
    Rules,
    Term,
    TopicPath,
)
from deros.rules.functions.functions import WRITTEN, Argument
from deros.validators.findings.hints import SHOWN
from deros.validators.rules_walk import rules_of, terms_of


@dataclass(slots=True)
class _Untimed:
    """An input without a timeout, and the rules that read its value."""

    name: str
    topic: str
    span: Span
    hint: str
    rules: dict[str, None] = field(default_factory=dict)  # ordered, each once


def check_timeouts(rules: Rules) -> Iterator[Diagnostic]:
    """Yield one finding per input without a timeout, with the rules that read it.

    A rule that reads only its ``age()`` detects the loss, and is not counted.
    """
    inputs = {each.name.text: each for each in reversed(rules.inputs)}
    found: dict[str, _Untimed] = {}
    for full_name, rule in rules_of(rules):
        for term in terms_of(rule.condition):
            for read in _values_read(term):
                untimed = _untimed(read, inputs)
                if untimed is not None:
                    found.setdefault(untimed.name, untimed).rules.setdefault(full_name)
    for each in found.values():
        names = [f"'{name}'" for name in each.rules]
        shown = ", ".join(names[:SHOWN])
        if len(names) > SHOWN:
            shown += f" and {len(names) - SHOWN} more"
        yield report(
            codes.INPUT_WITHOUT_TIMEOUT,
            f"'{each.name}' has no timeout: when messages on {each.topic} stop,"
            f" {shown} still {'use' if len(names) > 1 else 'uses'} the last value",
            each.span,
            each.hint,
        )


def _values_read(term: Term) -> Iterator[NamePath | TopicPath]:
    """Yield the inputs whose value a term reads; ``age()`` and ``missing()`` read none."""
    match term:
        case NamePath() | TopicPath():
            yield term
        case Negative():
            yield from _values_read(term.operand)
        case Arithmetic():
            yield from _values_read(term.left)
            yield from _values_read(term.right)
        case Call(receiver=None):
            for argument in term.arguments:
                yield from _values_read(argument)
        case Entries():
            for outer in terms_of(term.condition):
                yield from _values_read(outer)
        case Call() if term.receiver is not None and not _asks_for_messages(term):
            yield from _values_read(term.receiver)
        case _:
            pass


def _untimed(read: NamePath | TopicPath, inputs: dict[str, Input]) -> _Untimed | None:
    if isinstance(read, TopicPath):
        hint = "name it as an input: 'input NAME = topic ... timeout 0.5 sec'"
        dot = "." if read.path and isinstance(read.path[0], str) else ""
        name = f"{read.topic}{dot}{format_path(read.path)}"
        return _Untimed(name, read.topic.text, read.span, hint)
    declared = inputs.get(read.name.text)
    if declared is None or declared.timeout is not None:
        return None
    name = declared.name.text
    hint = f"add 'timeout 0.5 sec', and a rule that reacts to '{name}.missing()'"
    return _Untimed(name, declared.term.topic.text, declared.name.span, hint)


def _asks_for_messages(call: Call) -> bool:
    """Return whether a function asks when messages came, and reads no value of them."""
    row = WRITTEN.get(call.function.text)
    return row is not None and row.argument is Argument.INPUT
