"""A program for Frama-C's value analysis: any calls of a monitor, in any order, with any values."""

from __future__ import annotations

from collections.abc import Iterator

from deros.generators.monitor.c.code.handlers import Handler, Parameter
from deros.generators.monitor.c.code.literals import integer, number
from deros.generators.monitor.c.code.view import MonitorView

TABLES_CHECK = "tables_stand"
"""The function that looks at the constant tables."""

_MOST = 64
"""Number of elements of the given arrays; more of them take the same paths through the loops."""


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
            *_sites(view),
            "int main(void)",
            "{",
            f"  {TABLES_CHECK}();",
            "  int64_t next = 0;",
            "  bool waits = false;",
            *_start(view),
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


def _start(view: MonitorView) -> Iterator[str]:
    """Yield the call that starts a monitor, with any constants."""
    call = f"{view.prefix}_start(&m, (void *)0, any_time, any_time"
    if not view.constants:
        yield f"  {call});"
        return
    values = ", ".join("any_number" for _ in view.constants)
    yield f"  const {view.prefix}_constants constants = {{{values}}};"
    yield f"  waits = {call}, &constants);"


def _sites(view: MonitorView) -> Iterator[str]:
    """Yield a function that divides by zero unless the table of sites is what the rules say."""
    yield "static int wrong(int is_wrong) { return is_wrong ? 1 / (is_wrong - is_wrong) : 0; }"
    yield f"int {TABLES_CHECK}(void)"
    yield "{"
    yield "  int all = 0;"
    for index, site in enumerate(view.sites.rows):
        row = f"{view.prefix}_sites[{index}]"
        none = f"{view.macro}_BEHAVIOUR_NONE"
        behaviour = none if site.behaviour is None else view.behaviour_names[site.behaviour][1]
        expected = {
            "action": view.actions[site.action].enumerator,
            "behaviour": behaviour,
            "line": f"{site.line}U",
        }
        if view.has_arguments:
            expected["count"] = f"{len(site.arguments)}U"
            if not site.arguments:
                expected["arguments"] = "(void *)0"
        for place, argument in enumerate(site.arguments):
            for member, value in _argument(argument, view.macro).items():
                expected[f"arguments[{place}].{member}"] = value
        yield from (f"  all += wrong({row}.{name} != {each});" for name, each in expected.items())
    yield "  return all;"
    yield "}"


def _argument(value: bool | int | float | str, macro: str) -> dict[str, str]:
    """Return what the members of an argument are."""
    members = {"truth": "0", "integer": "0", "number": "0.0", "text": "(void *)0"}
    if isinstance(value, bool):
        return {**members, "type": f"{macro}_TRUTH", "truth": str(int(value))}
    if isinstance(value, int):
        return {**members, "type": f"{macro}_INTEGER", "integer": integer(value)}
    if isinstance(value, float):
        return {**members, "type": f"{macro}_NUMBER", "number": number(value)}
    characters = {f"text[{i}]": f"(char){c}" for i, c in enumerate(value.encode() + b"\0")}
    del members["text"]
    return {**members, "type": f"{macro}_TEXT", **characters}


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
