"""The states of rules that the emitted monitor reports, and whether it is waiting."""

from __future__ import annotations

from collections.abc import Iterator

from deros.generators.monitor.python.layout import Layout
from deros.generators.text.logic import Atom, all_of, any_of, lay_out
from deros.generators.text.python import lay_out_call
from deros.rules.functions.reads import Term, is_single, strip_comments, term_name, terms_of_rules
from deros.rules.program import walk
from deros.rules.program.ir import Active, Age, Frequency, Missing, Program, RuleRef, Unknown


def rules_of(program: Program) -> Iterator[tuple[str, tuple[str, ...]]]:
    """Yield each behaviour's name with those of the rules that its condition names."""
    for behaviour in walk.behaviours(program):
        names = {
            program.rules[part.rule].full_name: None
            for part in walk.parts(behaviour.condition)
            if isinstance(part, RuleRef)
        }
        yield behaviour.name, tuple(names)


def rule_state_lines(program: Program, layout: Layout) -> list[str]:
    """Return the items of the tuple that ``explain()`` returns, one call per rule."""
    lines: list[str] = []
    for rule, read in terms_of_rules(program):
        reads = [
            f"({term_name(program, each)!r}, {value_text(program, each, layout)})" for each in read
        ]
        arguments = [
            repr(rule.full_name),
            str(rule.span.line),
            repr(strip_comments(rule.span.text)),
            f"self._{layout.verdicts[rule.index]}",
            f"self._{layout.since[rule.index]}",
            f"self._{layout.why[rule.index]}",
            *reads,
        ]
        lines += lay_out_call(12, "explained(", arguments, "),")
    return lines


def verdict_lines(program: Program, layout: Layout) -> list[str]:
    """Return the items of the tuple that ``verdicts()`` returns, one call per rule."""
    lines: list[str] = []
    for rule, read in terms_of_rules(program):
        reads = [text for each in read if (text := _knowledge(each, layout))]
        lines += lay_out_call(
            12, "verdict_on(", [f"self._{layout.verdicts[rule.index]}", *reads], "),"
        )
    return lines


def _knowledge(term: Term, layout: Layout) -> str:
    """Return the attribute that is NaN or None while a term is unknown; empty if it never is."""
    match term:
        case Active() | Frequency() | Missing() | Unknown():
            return ""
        case Age():
            return f"self._{layout.counted[term.input]}"
        case _:
            return f"self._{layout.values[term].name}"


def waiting_lines(layout: Layout) -> list[str]:
    """Return the statement that returns whether an input has yet to come for the first time."""
    inputs = [
        all_of((Atom(f"self._{layout.silent[n]}"), Atom(f"not self._{layout.missing[n]}")))
        for n in layout.silent
    ]
    return lay_out(8, "return ", any_of(inputs) if inputs else Atom("False"))


def value_text(program: Program, term: Term, layout: Layout) -> str:
    """Return the expression of a term's value, with NaN or None for unknown."""
    match term:
        case Missing():
            return f"self._{layout.missing[term.input]}"
        case Unknown():
            if term.operand is None:
                known = f"self._{layout.known[term.input]}"
            else:
                value = f"self._{layout.values[term.operand].name}"
                known = f"{value} == {value}"
            silent, missing = layout.silent[term.input], layout.missing[term.input]
            return f"self._{missing} or not (self._{silent} or {known})"
        case Active():
            return f"self._{layout.active[term.action]}"
        case Age():
            return f"(self._now - self._{layout.counted[term.input]}) / 1e9"
        case Frequency():
            first = f"self._{layout.stamps[term.input]}[-{term.messages}]"
            return f"per_second({term.messages}, self._now - {first})"
        case _:
            value = f"self._{layout.values[term].name}"
            return f"decimal({value})" if is_single(program, term) else value
