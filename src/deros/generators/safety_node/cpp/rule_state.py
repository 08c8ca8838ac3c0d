"""C++ expressions of the state of each rule: verdict and terms, read from the monitor in C."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from deros.generators.monitor.c.interface import Layout, known_of
from deros.generators.monitor.c.interface import Term as Field
from deros.generators.text.cpp import Call, Chain, Expression, Text, cpp_double, cpp_string
from deros.rules.compiler.wordings import quoted
from deros.rules.engine.cause_texts import Beams, beams_of
from deros.rules.functions.reads import (
    Term,
    is_single,
    is_whole,
    strip_comments,
    term_name,
    terms_of_rules,
)
from deros.rules.program import walk
from deros.rules.program.ir import Active, Age, Frequency, Missing, Program, Rule, Scale, Unknown


def held_timeouts(program: Program, layout: Layout) -> tuple[str, ...]:
    """Return the fields from which the timeouts count that a copy of a monitor can hold still."""
    return tuple(layout.inputs[each.index].base for each in walk.holdable_inputs(program))


def rule_states(program: Program, layout: Layout) -> Iterator[Expression]:
    """Yield the expression of the state of each rule; the monitor's struct is ``m``."""
    for rule, read in terms_of_rules(program):
        yield Call("runtime::rule_state", tuple(_arguments(program, layout, rule, read)))


def _arguments(
    program: Program, layout: Layout, rule: Rule, read: Iterable[Term]
) -> Iterator[Expression]:
    yield cpp_string(rule.full_name)
    yield str(rule.span.line)
    yield Text(strip_comments(rule.span.text))
    yield f"m.{layout.verdicts[rule.index]} == {layout.macro}_TRUE"
    yield f"m.{layout.turned[rule.index]}"
    for each in read:
        yield reading(program, layout, each)


def reading(program: Program, layout: Layout, term: Term) -> Expression:
    """Return the expression of a term with its value."""
    name = cpp_string(term_name(program, term))
    return Call("runtime::Reading", (name, _value(program, layout, term)))


def reading_of_sector(program: Program, layout: Layout, term: Term) -> Expression:
    """Return the same; the name says how many beams of a sector that the term reads are blind."""
    named = (cpp_string(term_name(program, term)), *beams_texts(layout, beams_of(term)))
    return Call("runtime::Reading", (Chain("", named, " + "), _value(program, layout, term)))


def beams_texts(layout: Layout, beams: Iterable[Beams]) -> Iterator[str]:
    """Yield the expressions of how many beams are blind."""
    for each in beams:
        field = layout.terms[each.share]
        yield f"runtime::beams_text(m.{field.known}, m.{field.name})"


def shown_text(program: Program, layout: Layout, term: Term) -> str:
    """Return the expression of the text of a term in a cause."""
    if isinstance(term, Age):
        fields = layout.inputs[term.input]
        return f"runtime::to_text(runtime::seconds(m.now - m.{fields.base}))"
    if isinstance(term, Frequency):
        return f"runtime::to_text({_frequency(layout, term)})"
    field, scale = _field(layout, term)
    if field.texts:
        return _chosen(f"m.{field.name}", map(quoted, field.texts))
    return f"runtime::to_text({_told(program, term, field, scale)})"


def _value(program: Program, layout: Layout, term: Term) -> str:
    match term:
        case Missing():
            return f"runtime::value_of(true, m.{layout.inputs[term.input].missing})"
        case Unknown():
            fields, known = layout.inputs[term.input], known_of(layout, term)
            unknown = f"(m.{fields.came} || m.{fields.missing}) && !m.{known}"
            return f"runtime::value_of(true, {unknown})"
        case Active():
            return f"runtime::value_of(true, m.{layout.active[term.action]})"
        case Age():
            fields = layout.inputs[term.input]
            return f"runtime::value_of(m.{fields.came}, runtime::seconds(m.now - m.{fields.base}))"
        case Frequency():
            return f"runtime::value_of(true, {_frequency(layout, term)})"
        case _:
            return _known(program, term, *_field(layout, term))


def _frequency(layout: Layout, term: Frequency) -> str:
    first = layout.inputs[term.input].stamps[term.messages - 1]
    return f"runtime::per_second({term.messages}, m.now - m.{first})"


def _field(layout: Layout, term: Term) -> tuple[Field, Scale | None]:
    """Return the field of a term, and the scale of its unit if that is not the term's own."""
    if term in layout.terms:
        return layout.terms[term], None
    return next(
        (field, value)
        for value, field in layout.terms.items()
        if isinstance(value, Scale) and value.operand == term
    )


def _known(program: Program, term: Term, field: Field, scale: Scale | None) -> str:
    value = _told(program, term, field, scale)
    if field.texts:
        value = _chosen(value, field.texts)
    known = f"m.{field.known}" if field.known else "true"  # a constant always is
    return f"runtime::value_of({known}, {value})"


def _chosen(place: str, texts: Iterable[str]) -> str:
    return f"runtime::known_text({place}, {{{', '.join(map(cpp_string, texts))}}})"


def _told(program: Program, term: Term, field: Field, scale: Scale | None) -> str:
    """Return a value in its own unit, as a float if it is one in the message."""
    value = _unscaled(field, scale)
    if is_whole(term):
        return f"runtime::whole({value})"
    return f"static_cast<float>({value})" if is_single(program, term) else value


def _unscaled(field: Field, scale: Scale | None) -> str:
    """Return a value in its own unit."""
    value = f"m.{field.name}"
    if scale is None:
        return value
    offset = f"({value} - {cpp_double(scale.offset)})" if scale.offset else value
    return f"{offset} / {cpp_double(scale.factor)}"
