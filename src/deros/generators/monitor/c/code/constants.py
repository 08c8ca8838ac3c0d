"""The tunable constants of a monitor in C: the struct that its owner hands in, and their values."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from deros.generators.monitor.c.acsl.terms import constant, of
from deros.generators.monitor.c.code.computed import computed_functions
from deros.generators.monitor.c.code.layout import Layout, Term
from deros.generators.monitor.c.code.literals import number
from deros.generators.monitor.c.code.names import new_names
from deros.generators.text.c import harmless
from deros.generators.text.prose import printable_line
from deros.rules.program.ir import Compute, Program, Tuned


@dataclass(frozen=True, slots=True)
class ConstantView:
    """A field of the struct of the constants: its default, its ends, and what it is for."""

    name: str
    field: str
    default: str
    lower: str
    upper: str
    comment: str

    @property
    def test(self) -> str:
        """The condition in C that the constant is within its interval; NaN is not."""
        value = f"constants->{self.field}"
        return f"({value} >= {self.lower}) && ({value} <= {self.upper})"

    @property
    def predicate(self) -> str:
        """The same in ACSL."""
        value = f"constants->{self.field}"
        ends = constant(self.lower), constant(self.upper)
        return f"\\ge_double({value}, {ends[0]}) && \\le_double({value}, {ends[1]})"


def constant_views(program: Program) -> tuple[ConstantView, ...]:
    """Return the fields of the constants of a program, in the order declared."""
    names = constant_names(program)
    views: list[ConstantView] = []
    for each, field in zip(program.tunables, names, strict=True):
        text = printable_line(each.description).rstrip(".")
        comment = harmless(f"{text}{': ' if text else ''}{each.interval}")
        ends = map(number, (each.default, each.lower, each.upper))
        default, lower, upper = ends
        views.append(ConstantView(each.name, field, default, lower, upper, comment))
    return tuple(views)


def constant_names(program: Program) -> list[str]:
    """Return the names of the fields of the constants."""
    names = new_names()
    return [names.new(each.name) for each in program.tunables]


def started_as(program: Program, layout: Layout, term: Term) -> str:
    """Return what a value that never changes is at the start, computed from ``constants``."""
    match term.value:
        case Tuned() as tuned:
            field = f"constants->{constant_names(program)[tuned.constant]}"
            value = f"-{field}" if tuned.negated else field
            if tuned.factor != 1.0 or tuned.offset:
                value = f"({value} * {number(tuned.factor)})"
            if tuned.offset:
                value = f"({value} + {number(tuned.offset)})"
            return f"(double)(float){value}" if tuned.single else value
        case Compute() as computed:
            operands = (f"m->{layout.terms[each].name}" for each in computed.operands)
            return f"{computed_functions(program)[computed].name}({', '.join(operands)})"
    raise AssertionError("other values change")


def started_predicates(program: Program, layout: Layout) -> Iterator[str]:
    """Yield in ACSL what the values that never change are, given ``constants``."""
    for term in layout.fixed:
        match term.value:
            case Tuned(single=False) as tuned:
                yield f"same(m->{term.name}, {_term(program, tuned)})"
            case Compute() as computed:
                operands = [f"m->{layout.terms[each].name}" for each in computed.operands]
                name = computed_functions(program)[computed].name
                yield f"is_{name}({', '.join([f'm->{term.name}', *operands])})"


def _term(program: Program, tuned: Tuned) -> str:
    value = f"constants->{constant_names(program)[tuned.constant]}"
    value = f"\\neg_double({value})" if tuned.negated else value
    if tuned.factor != 1.0 or tuned.offset:
        value = of("mul", value, constant(tuned.factor))
    return of("add", value, constant(tuned.offset)) if tuned.offset else value
