"""The C text around generated monitors that lets tests drive them by 64-bit words."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from deros.generators.monitor.c.code.handlers import Handler, Parameter
from deros.generators.monitor.c.code.view import MonitorView, monitor_view
from deros.generators.monitor.c.interface import render_monitor
from deros.rules.program.ir import Program

DRIVER = Path(__file__).with_name("c")
"""The folder of ``driver.h``."""


@dataclass(frozen=True)
class Unit:
    """A monitor to be compiled, under a name that no other monitor of the library has."""

    program: Program
    view: MonitorView
    texts: dict[str, str]

    @property
    def prefix(self) -> str:
        """What the public names begin with."""
        return self.view.prefix

    @property
    def source(self) -> str:
        """The source; the header is included by it."""
        return self.texts[f"{self.prefix}_monitor.c"]


def unit(program: Program, name: str | None = None) -> Unit:
    """Render a monitor, under another name if one is given.

    Raises:
        GenerationError: C has no such monitor.
    """
    named = program if name is None else replace(program, name=name)
    return Unit(named, monitor_view(named), render_monitor(named))


def library_text(units: Sequence[Unit]) -> str:
    """Return a translation unit of monitors with what drives them.

    The names that each monitor keeps to itself are made its own, because several share the file.
    """
    parts = ['#include "driver.h"', "#include <math.h>"]
    for each in units:
        own = private_names(each.source)
        parts += [f"#define {name} {each.prefix}_own_{name}" for name in own]
        parts.append(f'#include "{each.prefix}_monitor.c"')
        parts += _driver(each)
        parts += [f"#undef {name}" for name in own]
    return "\n".join([*parts, *_table(units)]) + "\n"


def private_names(source: str) -> list[str]:
    """Return the functions and tables that a source keeps to itself."""
    found = re.findall(r"^static [^;{}()=\[]*?\b(\w+)(?=[(\[])", source, flags=re.MULTILINE)
    return list(dict.fromkeys(found))


def _driver(each: Unit) -> Iterator[str]:
    """Yield the lines of the callback, and of the function that takes one call."""
    view, prefix, macro = each.view, each.prefix, each.view.macro
    yield f"""\
static const {prefix}_monitor *{prefix}_running;

void {prefix}_emit(void *owner, int64_t t, {prefix}_kind kind, uint32_t site)
{{
  if (owner == NULL) {{  /* a copy that looks ahead */
    return;
  }}
  answer *out = *(answer **)owner;
  put(out, 1);
  put(out, t);
  put(out, (int64_t)kind);
  put(out, (site == {macro}_SITE_NONE) ? -1 : (int64_t)site);
  if (site != {macro}_SITE_NONE) {{
    const {prefix}_site *place = &{prefix}_sites[site];
    put(out, (int64_t)place->action);
    put(out, (place->behaviour == {macro}_BEHAVIOUR_NONE) ? -1 : (int64_t)place->behaviour);
    put(out, (int64_t)place->line);"""
    yield from _arguments(prefix, macro) if view.has_arguments else ("    put(out, 0);",)
    yield f"    if (kind == {macro}_REFUSED) {{"
    for name in view.layout.conditions.values():
        yield f"      put(out, {prefix}_running->{name});"
    yield "    }"
    yield f"""\
  }}
}}

static void {prefix}_step({prefix}_monitor *m, answer **owner, words *in, answer *out)
{{
  int64_t result = 0;
  {prefix}_running = m;
  *owner = out;
  switch (word(in)) {{
    case 0: {{
      const int64_t t = word(in);
      memset(m, 0xA5, sizeof *m);"""
    yield from _start(view)
    for action in view.actions:
        if action.latched:
            yield f"      if (word(in) != 0) {{ {prefix}_latch_{action.name}(m); }}"
    yield f"""\
      break;
    }}
    case 1:
      result = {prefix}_advance(m, word(in));
      break;"""
    if view.has_latched:
        yield f"    case 2: result = {prefix}_reset(m, word(in)); break;"
    for number, (_, function, _) in enumerate(view.optional):
        yield f"    case {100 + number}: {{ const int64_t t = word(in); {function}(m, t,"
        yield "      word(in) != 0); break; }"
    for number, message in enumerate(view.messages):
        yield f"    case {200 + number}: {{"
        yield from call_of(message.handler)
        yield "      break;\n    }"
    yield "    default: abort();\n  }\n  put(out, 0);\n  put(out, result);"
    yield f"  put(out, m->due);\n  put(out, {prefix}_waiting(m));"
    yield from (f"  {line}" for line in _state(view))
    yield "}"


def _start(view: MonitorView) -> Iterator[str]:
    """Yield the statements that start a monitor, with the constants that the words say."""
    call = f"{view.prefix}_start(m, owner, t, grace"
    yield "      const int64_t grace = word(in);"
    if not view.constants:
        yield f"      {call});"
        return
    yield f"      {view.prefix}_constants constants = {view.prefix}_default_constants;"
    for each in view.constants:
        yield f"      constants.{each.field} = real(in);"
    yield f"      result = {call}, &constants);"


def _arguments(prefix: str, macro: str) -> Iterator[str]:
    yield f"""\
    put(out, (int64_t)place->count);
    for (uint32_t i = 0; i < place->count; ++i) {{
      const {prefix}_argument *argument = &place->arguments[i];
      put(out, (int64_t)argument->type);
      switch (argument->type) {{
        case {macro}_TRUTH: put(out, argument->truth); break;
        case {macro}_INTEGER: put(out, argument->integer); break;
        case {macro}_NUMBER: put_real(out, argument->number); break;
        default: put_text(out, argument->text); break;
      }}
    }}"""


def _state(view: MonitorView) -> Iterator[str]:
    """Yield the statements that answer with all that a monitor knows."""
    layout, program = view.layout, view.program
    for rule in program.rules:
        yield f"put(out, (int64_t)m->{layout.verdicts[rule.index]});"
        yield f"put(out, m->{layout.turned[rule.index]});"
    for name in (*layout.conditions.values(), *layout.active.values()):
        yield f"put(out, m->{name});"
    for term in layout.terms.values():
        yield f"put(out, {f'm->{term.known}' if term.known else '1'});"
        if term.type == "double":
            yield f"put_real(out, m->{term.name});"
        else:
            yield f"put(out, (int64_t)m->{term.name});"


def call_of(handler: Handler) -> Iterator[str]:
    """Yield the statements that read the arguments of a handler and call it."""
    yield "      const int64_t t = word(in);"
    arguments, freed = ["m", "t"], []
    for parameter in handler.parameters:
        yield from (f"      {line}" for line in _read(parameter))
        arguments += [re.sub(r".*[ *]", "", each) for each in parameter.declarations]
        if parameter.form in ("array", "text"):
            freed.append(parameter.name)
    yield f"      {handler.function}({', '.join(arguments)});"
    yield from (f"      free((void *){name});" for name in freed)


def _read(parameter: Parameter) -> Iterator[str]:
    name, form = parameter.name, parameter.form
    if form == "value":
        declaration = parameter.declarations[0]
        kind = declaration.split()[0]
        taken = {"double": "real(in)", "bool": "word(in) != 0"}.get(kind, f"({kind})word(in)")
        yield f"const {declaration} = {taken};"
    elif form != "given":
        length = f"{name}_length" if form == "text" else f"{name}_count"
        yield f"const size_t {length} = (size_t)word(in);"
        if form != "count":
            element = "char" if form == "text" else parameter.element
            taken = "real(in)" if element in ("float", "double") else "word(in)"
            yield f"{element} *{name} = exactly({length}, sizeof *{name});"
            yield f"for (size_t i = 0; i < {length}; ++i) {{ {name}[i] = ({element}){taken}; }}"
    if parameter.given:
        yield f"const bool {name}_given = word(in) != 0;"


def _table(units: Sequence[Unit]) -> Iterator[str]:
    """Yield the one function that all monitors of a library are reached by."""
    yield """\
size_t driver_size(int64_t number)
{
  switch (number) {"""
    for number, each in enumerate(units):
        yield f"    case {number}: return sizeof({each.prefix}_monitor);"
    yield """\
    default: abort();
  }
}

size_t driver_step(
  int64_t number, void *monitor, void *owner, const int64_t *in, size_t count, int64_t *out,
  size_t capacity)
{
  words asked = {in, in + count};
  answer given = {out, out + capacity};
  switch (number) {"""
    for number, each in enumerate(units):
        call = f"{each.prefix}_step(monitor, owner, &asked, &given)"
        yield f"    case {number}: {call}; break;"
    yield """\
    default: abort();
  }
  if (asked.next != asked.end) {
    abort();
  }
  return (size_t)(given.next - out);
}"""
