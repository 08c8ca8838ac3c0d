"""The fields of the struct that holds a monitor."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from deros.generators.monitor.c.code.constants import started_as
from deros.generators.monitor.c.code.layout import Layout
from deros.rules.functions.memories import SAMPLES
from deros.rules.program.ir import Program, Read

WINDOW_SIZE = 16 * SAMPLES + 16
"""The bytes of the samples of one rate over a span of time."""


@dataclass(frozen=True, slots=True)
class Field:
    """A field of the struct.

    Attributes:
        type, name, comment: its declaration.
        size: in bytes.
        started: what it is at the start; empty if a restart sets it.
        restarted: what a start and a step of the clock set it to; empty if they do not.
    """

    type: str
    name: str
    comment: str
    size: int
    started: str = ""
    restarted: str = ""


def struct_fields(program: Program, layout: Layout) -> list[Field]:
    """Return the struct's fields, the widest first."""
    fields = [
        Field("void *", "owner", "handed on to the callback", 8, "owner"),
        Field("int64_t ", "now", "the instant of the last event, or later", 8, "bounded(t)"),
        Field("int64_t ", "due", "when to call advance at the latest", 8),
        *_input_fields(program, layout),
        *_verdict_fields(program, layout),
    ]
    return sorted(fields, key=lambda each: -each.size)


def _input_fields(program: Program, layout: Layout) -> Iterator[Field]:
    for each in program.inputs:
        fields = layout.inputs[each.index]
        if fields.base:
            what = "when its timeout began" if fields.missing else "when its last message came"
            yield Field("int64_t ", fields.base, what, 8, "", "from")
        for number, name in enumerate(fields.stamps, 1):
            what = f"when the last message but {number - 1} came"
            what = "when its last message came" if number == 1 else what
            yield Field("int64_t ", name, what, 8, "", "from")
        if fields.came:
            yield Field("bool ", fields.came, "whether a message has counted", 1, "", "false")
        if fields.missing:
            yield Field("bool ", fields.missing, "whether its timeout has passed", 1, "", "false")
        if fields.known:
            yield Field("bool ", fields.known, f"whether {each.name} is known", 1, "false")
    for term in layout.fixed:
        initial = started_as(program, layout, term)
        yield Field("double ", term.name, "set at the start", 8, initial)
    for term in (each for each in layout.terms.values() if each.known):
        size = {"bool": 1, "uint32_t": 4}.get(term.type, 8)
        initial = {"bool": "false", "uint32_t": "0U", "double": "0.0"}.get(term.type, "0")
        yield Field(f"{term.type} ", term.name, "as of the last message", size, initial)
        if not isinstance(term.value, Read):
            yield Field("bool ", term.known, "whether it is known", 1, "false")
    for finding in layout.findings.values():
        yield Field("bool ", finding.name, "how values compare", 1, "false")
    for memory in layout.memories.values():
        for remembered, name in memory.doubles:
            started = "0.0" if remembered.initial is None else ""
            yield Field("double ", name, remembered.comment, 8, started)
        if memory.last_t:
            restarted = "" if memory.forgotten_t else "m->now"
            yield Field("int64_t ", memory.last_t, "when it came", 8, "", restarted)
        if memory.window:
            yield Field(f"{layout.prefix}_window ", memory.window, "its samples", WINDOW_SIZE)


def _verdict_fields(program: Program, layout: Layout) -> Iterator[Field]:
    verdict, unknown = f"{layout.prefix}_verdict ", f"{layout.macro}_UNKNOWN"
    unset = f"{layout.macro}_UNSET"
    for rule in program.rules:
        name = layout.verdicts[rule.index]
        yield Field(verdict, name, f"rule {rule.full_name}", 4, unknown)
        what = "when it last became true or ceased to be"
        yield Field("int64_t ", layout.turned[rule.index], what, 8, "", "m->now")
    for name in layout.since.values():
        yield Field("int64_t ", name, "since when its operand has been true", 8, "", unset)
    for name in layout.until.values():
        yield Field("int64_t ", name, "until when a within is true", 8, "", "0")
    for turns in layout.turns.values():
        for number, name in enumerate(turns.ends, 1):
            what = f"until when the turn counts that is the last but {number - 1}"
            what = "until when the last turn counts" if number == 1 else what
            yield Field("int64_t ", name, what, 8, "", "0")
        yield Field("bool ", turns.held, "whether what is counted is true", 1, "", "false")
    for name in layout.kept.values():
        yield Field(verdict, name, "a since, as of the last event", 4, "", f"{layout.macro}_FALSE")
    for name in layout.conditions.values():
        yield Field(verdict, name, "its condition and all around it", 4, unknown)
    for name in layout.enabled.values():
        yield Field("bool ", name, "whether it may act", 1, "true")
    for name in layout.active.values():
        yield Field("bool ", name, "whether it was run and not reset since", 1, "false")
    for name in layout.ran.values():
        yield Field("bool ", name, "whether it ran in this event", 1, "false")
    yield Field("bool ", "started", "whether there has been an event", 1, "false")
