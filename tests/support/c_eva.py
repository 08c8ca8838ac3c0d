"""A program for Frama-C's value analysis: any calls of a monitor, in any order, with any values."""

from __future__ import annotations

from collections.abc import Iterator

from deros.generators.monitor_c.handlers import Handler, Parameter
from deros.generators.monitor_c.view import MonitorView

_MOST = 64
"""How many elements the arrays have that are handed in; their loops do not tell more apart."""


def eva_program(view: MonitorView) -> str:
    """Return a C program whose ``main`` starts a monitor and calls it for ever.

    Every argument is volatile, so that the analysis takes it for any value of its type.
    """
    prefix = view.prefix
    calls = [
        f"next = {prefix}_advance(&m, any_time);",
        f"waits = {prefix}_waiting(&m);",
        *([f"waits = {prefix}_reset(&m, any_time);"] if view.has_latched else []),
        *(f"{function}(&m, any_time, any_truth != 0);" for _, function, _ in view.optional),
        *(_call(each.handler) for each in view.messages),
    ]
    latches = [
        f"if (any_truth != 0) {{ {prefix}_latch_{each.name}(&m); }}"
        for each in view.actions
        if each.latched
    ]
    cases = [f"    case {number}: {call} break;" for number, call in enumerate(calls)]
    return "\n".join(
        [
            f'#include "{prefix}_monitor.h"',
            "volatile int64_t any_time;",
            "volatile int any_truth;",
            "volatile unsigned any_count;",
            "volatile double any_number;",
            *_arrays(view),
            f"static {prefix}_monitor m;",
            "int main(void)",
            "{",
            "  int64_t next = 0;",
            "  bool waits = false;",
            f"  {prefix}_start(&m, (void *)0, any_time, any_time);",
            *(f"  {line}" for line in latches),
            "  while (1) {",
            *(f"    {line}" for line in _fill(view)),
            "    switch (any_truth) {",
            *(f"  {line}" for line in cases),
            "      default: break;",
            "    }",
            "  }",
            "  return (int)next + (int)waits;",
            "}",
            "",
        ]
    )


def _elements(view: MonitorView) -> list[str]:
    kinds = {
        parameter.element or "char"
        for each in view.messages
        for parameter in each.handler.parameters
        if parameter.form in ("array", "text")
    }
    return sorted(kinds)


def _arrays(view: MonitorView) -> Iterator[str]:
    for kind in _elements(view):
        yield f"volatile {kind} any_{kind};"
        yield f"static {kind} many_{kind}[{_MOST}];"


def _fill(view: MonitorView) -> Iterator[str]:
    for kind in _elements(view):
        yield f"for (unsigned i = 0U; i < {_MOST}U; ++i) {{ many_{kind}[i] = any_{kind}; }}"


def _call(handler: Handler) -> str:
    values = [value for each in handler.parameters for value in _values(each)]
    return f"{handler.function}({', '.join(['&m', 'any_time', *values])});"


def _values(parameter: Parameter) -> Iterator[str]:
    count = f"any_count % {_MOST + 1}U"
    match parameter.form:
        case "array":
            yield from (f"many_{parameter.element}", count)
        case "text":
            yield from ("many_char", count)
        case "count":
            yield "any_count"
        case "value":
            kind = parameter.declarations[0].split()[0]
            yield {"double": "any_number", "bool": "any_truth != 0"}.get(kind, f"({kind})any_time")
    if parameter.given:
        yield "any_truth != 0"
