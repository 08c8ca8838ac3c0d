"""The tunable constants of a program, as the emitted monitor takes, checks and stores them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from deros.generators.monitor.python.conditions import scaled
from deros.generators.monitor.python.layout import Layout
from deros.generators.text.prose import printable_line
from deros.generators.text.provenance import origin
from deros.generators.text.python import lay_out_call, wrapped
from deros.rules.program.ir import Program, Scale, Tuned


@dataclass(frozen=True, slots=True)
class ConstantView:
    """A row of the table of the constants: default, least and greatest, and what it is for."""

    name: str
    default: str
    lower: str
    upper: str
    comment: tuple[str, ...]


def constant_views(program: Program) -> tuple[ConstantView, ...]:
    """Return the views of the tunable constants, in the order declared."""
    views: list[ConstantView] = []
    for each in program.tunables:
        text = printable_line(each.description).rstrip(".")
        parts = [text, f"in {each.interval}", f"declared in {origin(each.span)}"]
        comment = wrapped("; ".join(part for part in parts if part), indent=6)
        default, lower, upper = map(repr, (each.default, each.lower, each.upper))
        views.append(ConstantView(each.name, default, lower, upper, tuple(comment)))
    return tuple(views)


def constant_slots(layout: Layout) -> list[str]:
    """Return the attributes that never change once the monitor has started."""
    tuned = [slot.name for value, slot in layout.values.items() if isinstance(value, Tuned)]
    return tuned + [layout.values[value].name for value in layout.computed if value.is_fixed]


def constant_lines(program: Program, layout: Layout) -> Iterator[str]:
    """Yield the statements that store the constants, converted, and what is computed of them."""
    for value, slot in layout.values.items():
        if isinstance(value, Tuned):
            yield f"        self._{slot.name} = {_converted(program, value)}"
    for computed, function in layout.computed.items():
        if computed.is_fixed:
            operands = [f"self._{layout.values[each].name}" for each in computed.operands]
            head = f"self._{layout.values[computed].name} = {function.name}("
            yield from lay_out_call(8, head, operands)


def _converted(program: Program, value: Tuned) -> str:
    name = f"chosen[{program.tunables[value.constant].name!r}]"
    text = f"-{name}" if value.negated else name
    if (value.factor, value.offset) != (1.0, 0.0):
        text = scaled(text, Scale(value, value.factor, value.offset))
    return f"ctypes.c_float({text}).value" if value.single else text
