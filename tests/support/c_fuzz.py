"""The C text that turns bytes into calls of a monitor, and checks what must hold after each."""

from __future__ import annotations

import re
from collections.abc import Iterator

from deros.generators.monitor.c.code.handlers import Handler, Parameter
from deros.generators.monitor.c.code.view import MonitorView
from deros.rules.program import walk
from deros.rules.program.ir import Behaviour, For, Trigger
from tests.support.c_harness import Unit


def fuzz_text(unit: Unit) -> str:
    """Return the translation unit of a fuzzer: the monitor, its owner, and the entry point."""
    return "\n".join(_lines(unit)) + "\n"


def _lines(unit: Unit) -> Iterator[str]:
    view, prefix, macro = unit.view, unit.prefix, unit.view.macro
    yield f"""\
#include "fuzzing.h"
#include "{prefix}_monitor.c"

void {prefix}_emit(void *owner, int64_t t, {prefix}_kind kind, uint32_t site)
{{
  const {prefix}_monitor *m = owner;
  HOLDS(t == m->now);
  HOLDS((unsigned)kind <= {macro}_CLOCK_STEP);
  HOLDS((site < {macro}_SITE_COUNT) == (kind != {macro}_CLOCK_STEP));
  HOLDS((site == {macro}_SITE_NONE) == (kind == {macro}_CLOCK_STEP));
  if (kind != {macro}_CLOCK_STEP) {{
    const bool called = ({prefix}_sites[site].behaviour != {macro}_BEHAVIOUR_NONE);
    HOLDS(called == (kind == {macro}_TRIGGER));
  }}
}}

static void check(const {prefix}_monitor *m, int64_t t)
{{
  HOLDS(m->now == ((t < 0) ? 0 : ((t > {macro}_LATEST) ? {macro}_LATEST : t)));
  HOLDS(m->due > m->now);"""
    yield from (f"  HOLDS({each});" for each in invariants(view))
    yield f"""\
}}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{{
  input_bytes bytes = {{data, data + size}};
  input_bytes *in = &bytes;
  {prefix}_monitor monitor;
  {prefix}_monitor *m = &monitor;
  int64_t t = take_time(in, 0);
  memset(m, 0xA5, sizeof *m);
  {start_of(view)}
  check(m, t);"""
    for action in view.actions:
        if action.latched:
            yield f"  if ((take_byte(in) & 1U) != 0U) {{ {prefix}_latch_{action.name}(m); }}"
    yield f"""\
  while (in->next != in->end) {{
    const {prefix}_monitor before = *m;
    bool was_reset = false;
    const uint8_t call = take_byte(in);
    t = take_time(in, m->now);
    switch (call % {_calls(view)}U) {{"""
    yield from _cases(view)
    yield """\
      default:
        HOLDS(ADVANCE(m, t) == m->due);
        break;
    }
    check(m, t);""".replace("ADVANCE", f"{prefix}_advance")
    for action in view.actions:
        if action.latched:
            yield f"    HOLDS(was_reset || !before.{action.active} || m->{action.active});"
    yield """\
    (void)was_reset;
    (void)before;
  }
  return 0;
}"""


def start_of(view: MonitorView) -> str:
    """Return the call that starts a monitor, with its default constants."""
    constants = f", &{view.prefix}_default_constants" if view.constants else ""
    ignored = "(void)" if view.constants else ""
    return f"{ignored}{view.prefix}_start(m, m, t, take_time(in, 0){constants});"


def _calls(view: MonitorView) -> int:
    return len(view.messages) + len(view.optional) + 2


def _cases(view: MonitorView) -> Iterator[str]:
    number = 0
    for message in view.messages:
        yield f"      case {number}: {{"
        yield from (f"        {line}" for line in _call(view, message.handler))
        yield "        break;\n      }"
        number += 1
    for _, function, _ in view.optional:
        yield f"      case {number}: {function}(m, t, (take_byte(in) & 1U) != 0U); break;"
        number += 1
    if view.has_latched:
        latched = [f"m->{each.active}" for each in view.actions if each.latched]
        yield f"      case {number}:\n        was_reset = true;"
        yield f"        HOLDS({view.prefix}_reset(m, t) == !({' || '.join(latched)}));"
        yield "        break;"


def _call(view: MonitorView, handler: Handler) -> Iterator[str]:
    arguments, freed = ["m", "t"], []
    for parameter in handler.parameters:
        yield from _take(view, parameter)
        arguments += [re.sub(r".*[ *]", "", each) for each in parameter.declarations]
        if parameter.form in ("array", "text"):
            freed.append(parameter.name)
    yield f"{handler.function}({', '.join(arguments)});"
    yield from (f"free((void *){name});" for name in freed)


def _take(view: MonitorView, parameter: Parameter) -> Iterator[str]:
    name = parameter.name
    match parameter.form:
        case "value":
            declaration = parameter.declarations[0]
            kind = declaration.split()[0]
            taken = {"double": "take_real(in)", "bool": "(take_byte(in) & 1U) != 0U"}
            yield f"const {declaration} = {taken.get(kind, f'({kind})take_word(in)')};"
        case "count":
            yield f"const size_t {name}_count = (size_t)take_word(in);"
        case "text":
            yield f"const size_t {name}_length = take_byte(in) % 32U;"
            yield f"const char *{name} = take_memory(in, {name}_length);"
        case "array":
            element = parameter.element
            yield f"size_t {name}_count = take_byte(in);"
            yield f"{element} *{name} = take_memory(in, {name}_count * sizeof *{name});"
            if element == "bool":
                yield f"memset({name}, 0, {name}_count);"
            yield f"if ({name}_count == 255U) {{ {name}_count += {view.macro}_MOST_ELEMENTS; }}"
    if parameter.given:
        yield f"const bool {name}_given = (take_byte(in) & 1U) != 0U;"


def invariants(view: MonitorView) -> Iterator[str]:
    """Yield what must hold of a monitor ``m`` between its calls, if no timeout is 0."""
    layout, program, macro = view.layout, view.program, view.macro
    for rule in program.rules:
        verdict, turned = layout.verdicts[rule.index], layout.turned[rule.index]
        yield f"(unsigned)m->{verdict} <= {macro}_TRUE"
        yield f"0 <= m->{turned} && m->{turned} <= m->now"
        if isinstance(rule.condition, For) and rule.condition.index in layout.since:
            since = layout.since[rule.condition.index]
            lasted = f"m->now - m->{since} >= INT64_C({rule.condition.duration_ns})"
            true = f"(m->{since} != {macro}_UNSET && {lasted})"
            yield f"(m->{verdict} == {macro}_TRUE) == {true}"
    for since in layout.since.values():
        yield f"m->{since} == {macro}_UNSET || (0 <= m->{since} && m->{since} <= m->now)"
    for index, fields in layout.inputs.items():
        if fields.base:
            yield f"0 <= m->{fields.base} && m->{fields.base} <= {macro}_LATEST"
            yield f"!m->{fields.came} || m->{fields.base} <= m->now"
        if fields.missing:
            for known in dict.fromkeys(term.known for term in layout.terms_of(index)):
                yield f"!(m->{fields.missing} && m->{known})"
    for behaviour in walk.behaviours(program):
        yield from _of_behaviour(view, behaviour)


def _of_behaviour(view: MonitorView, behaviour: Behaviour) -> Iterator[str]:
    layout = view.layout
    condition, macro = f"m->{layout.conditions[behaviour.index]}", layout.macro
    if behaviour.parent is not None:
        yield f"{condition} <= m->{layout.conditions[behaviour.parent]}"
    if behaviour.optional:
        yield f"({condition} == {macro}_FALSE) || m->{layout.enabled[behaviour.index]}"
    for item in behaviour.body:
        if isinstance(item, Trigger) and item.action in layout.active:
            yield f"({condition} != {macro}_TRUE) || m->{layout.active[item.action]}"
