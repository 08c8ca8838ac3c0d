"""What conditions read, and what rules call it."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import replace

from deros.interfaces.durations import seconds_text
from deros.interfaces.fields import format_steps
from deros.rules.functions.functions import FUNCTIONS, Result
from deros.rules.program import walk
from deros.rules.program.ir import (
    Active,
    Age,
    Apply,
    Compute,
    Condition,
    Const,
    Frequency,
    Missing,
    Program,
    Read,
    Rule,
    RuleRef,
    Scale,
    Tuned,
    Unknown,
    ValueExpression,
)

_COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)

Term = Read | Apply | Compute | Tuned | Missing | Unknown | Age | Frequency | Active
"""What a rule reads: a field, a function of fields, or a question about messages or an action.

A tunable constant is read, too.

Causes show the value of arithmetic, too; among what a rule reads its operands stand in its place.
"""


def strip_comments(text: str) -> str:
    """Return the text of a rule in one line, without comments."""
    return " ".join(_COMMENT.sub(" ", text).split())


def terms(program: Program, condition: Condition) -> tuple[Term, ...]:
    """Return what a condition reads, in the order written, each once.

    In the place of a rule is what that rule reads.
    """
    known: dict[int, tuple[Term, ...]] = {}
    for index in walk.named_rules(condition, program.rules):
        known[index] = _terms(program.rules[index].condition, known)
    return _terms(condition, known)


def terms_of_rules(program: Program) -> Iterator[tuple[Rule, tuple[Term, ...]]]:
    """Yield every rule with what it reads; see :func:`terms`."""
    known: dict[int, tuple[Term, ...]] = {}
    for rule in program.rules:
        known[rule.index] = _terms(rule.condition, known)
        yield rule, known[rule.index]


def _terms(condition: Condition, known: Mapping[int, tuple[Term, ...]]) -> tuple[Term, ...]:
    found: dict[Term, None] = {}
    for part in walk.parts(condition):
        match part:
            case Missing() | Unknown() | Age() | Frequency() | Active():
                found[plain_term(part)] = None
            case RuleRef(rule=rule):
                found.update(dict.fromkeys(known[rule]))
            case _:
                found.update(dict.fromkeys(walk.terminals(part)))
    return tuple(found)


def plain_term(term: Missing | Unknown | Age | Frequency | Active) -> Term:
    """Return a term without what it is compared with, so that equal terms are equal."""
    if isinstance(term, Frequency):
        return Frequency(term.input, term.messages, 0)
    return Age(term.input, "=", 0) if isinstance(term, Age) else term


def told_beside(term: Term | ValueExpression) -> tuple[Apply, ...]:
    """Return the functions that causes tell beside a term, of ``nearest`` what share is blind."""
    if not isinstance(term, Apply):
        return ()
    told = FUNCTIONS[term.function].told
    return tuple(replace(term, function=name, zone=None) for name in told)


def all_told(program: Program) -> tuple[Apply, ...]:
    """Return all functions that causes tell beside others, each once."""
    values = walk.values(walk.conditions(program))
    return tuple(dict.fromkeys(told for each in values for told in told_beside(each)))


def term_name(program: Program, term: Term) -> str:
    """Return a term as rules write it, with angles in radians: ``orientation.roll()``."""
    match term:
        case Missing():
            return f"{program.inputs[term.input].name}.missing()"
        case Unknown():
            if term.operand is None:
                return f"{program.inputs[term.input].name}.unknown()"
            return f"{_function_name(program, term.operand)}.unknown()"
        case Age():
            return f"{program.inputs[term.input].name}.age()"
        case Frequency():
            return f"{program.inputs[term.input].name}.frequency({term.messages})"
        case Active():
            return f"{program.actions[term.action].name}.active"
        case Read():
            return _field_name(program, term)
        case Apply():
            return _function_name(program, term)
        case Compute():
            return term.wording
        case Tuned():
            return f"{'-' if term.negated else ''}{program.tunables[term.constant].name}"


def is_single(program: Program, term: Term | ValueExpression) -> bool:
    """Return whether a term has values of ``float32``, which are told by shorter decimals."""
    match term:
        case Read():
            return program.leaves[term.leaf].type.base == "float32"
        case Apply():
            row = FUNCTIONS[term.function]
            of_elements = row.result is Result.ELEMENT and is_single(program, term.arguments[0])
            return row.is_single or of_elements
    return False


def is_whole(term: Term | ValueExpression) -> bool:
    """Return whether a term is a number of things, which is told without decimals."""
    if not isinstance(term, Apply):
        return False
    row = FUNCTIONS[term.function]
    return row.is_whole or (row.result is Result.ELEMENT and is_whole(term.arguments[0]))


def _field_name(program: Program, read: Read) -> str:
    leaf = program.leaves[read.leaf]
    each = program.inputs[leaf.input]
    rest = leaf.path[len(each.path) :] if leaf.path[: len(each.path)] == each.path else leaf.path
    return each.name + format_steps(rest)


def _function_name(program: Program, function: Apply) -> str:
    row = FUNCTIONS[function.function]
    if function.entry is not None:
        return f"count({function.wording})"
    if not row.is_written:  # named as in the rules
        subject = _operand_name(program, function.arguments[0])
        return _name_over_span(subject, function) if row.over_span else subject
    subject = program.inputs[function.input].name
    if function.zone is not None:
        return f"{subject}.{function.function}({function.zone.name})"
    written = [each for each in function.arguments if isinstance(each, Const)]
    constants = written[: len(row.parameters)]
    operands = [each for each in function.arguments if not isinstance(each, Const)]
    if len(operands) == 1:  # a field or a function of fields, no message or part of one
        subject = _operand_name(program, operands[0])
    texts = ", ".join(f"{each.value:.6g}" for each in constants)
    return f"{subject}.{function.function}({texts})"


def _name_over_span(subject: str, function: Apply) -> str:
    name = next(row.name for row in FUNCTIONS.values() if row.over == function.function)
    span = function.arguments[1]
    assert isinstance(span, Const)
    assert isinstance(span.value, int)
    return f"{subject}.{name}({seconds_text(span.value)})"


def _operand_name(program: Program, value: ValueExpression) -> str:
    match value:
        case Scale():
            return _operand_name(program, value.operand)
        case Const():
            return str(value.value)
        case _:
            return term_name(program, value)
