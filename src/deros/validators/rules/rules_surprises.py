"""Checks for constructs that do what they say, which is not what most readers expect."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from deros import codes
from deros.diagnostics import Diagnostic, Related, Span, report
from deros.models import rules
from deros.rules.compiler.scope.resolved import AppliedFunction
from deros.rules.functions.functions import FUNCTIONS, Result
from deros.rules.functions.reads import plain_term, term_name
from deros.rules.program import ir, walk
from deros.validators.findings.hints import SHOWN
from deros.validators.rules.losses.rules_losses import keys_read
from deros.validators.rules.losses.rules_noticed import Noticed
from deros.validators.rules.losses.rules_places import Context, Effect
from deros.validators.rules_walk import all_terms, rules_of, terms_of

_SHORT_NS = 1000  # no two messages come within a microsecond
_HIDDEN = {"min": ("<", "<="), "max": (">", ">=")}
"""The comparisons that one operand alone can make true."""


def check_surprises(
    written: rules.Rules,
    program: ir.Program,
    noticed: Noticed,
    functions: Iterable[AppliedFunction],
) -> Iterator[Diagnostic]:
    """Yield the findings about rules without errors."""
    yield from _hidden(written, program, noticed)
    yield from _rounded(program, functions)
    yield from _short(program)
    yield from _starting_over(written, program, noticed)
    yield from _high_at_start(program, noticed)


# Values hidden by unknown ones ------------------------------------------------------------------


def _hidden(written: rules.Rules, program: ir.Program, noticed: Noticed) -> Iterator[Diagnostic]:
    """Yield one finding per ``min`` or ``max`` of several inputs of which one may be unknown."""
    inputs = {each.name: each for each in program.inputs}
    indices = {each.full_name: each.index for each in program.rules}
    for full_name, rule in rules_of(written):
        index = indices[full_name]
        for term in terms_of(rule.condition):
            for call in all_terms(term):
                if not isinstance(call, rules.Call) or call.function.text not in _HIDDEN:
                    continue
                names = _read(call)
                lost = [each for each in names if each in inputs]
                answers = {
                    each: noticed.answer_to_unknown(inputs[each].index, index) for each in lost
                }
                lost = [each for each in lost if answers[each] != "noticed"]
                if call.receiver is None and len(names) > 1 and lost:
                    unknown = " or ".join(f"'{each}'" for each in lost)
                    asked = f"ask '{lost[0]}.unknown()' in a rule"
                    yield report(
                        codes.HIDDEN_BY_UNKNOWN,
                        f"'{call.span.text}' is unknown while {unknown} is, whatever the others"
                        " are, and no rule notices that",
                        call.span,
                        f"{_apart(call, rule.condition)}{asked}",
                    )


def _read(call: rules.Call) -> list[str]:
    """Return the names that the arguments of a function read, each once."""
    terms = (term for argument in call.arguments for term in all_terms(argument))
    return list(dict.fromkeys(each.name.text for each in terms if isinstance(each, rules.NamePath)))


def _apart(call: rules.Call, condition: rules.Condition) -> str:
    """Return a proposal to compare each argument by itself, where that means the same."""
    match condition:
        case rules.Comparison(left=left, operator=operator, right=right) if (
            left is call and operator in _HIDDEN[call.function.text]
        ):
            each = (f"{every.span.text} {operator} {right.span.text}" for every in call.arguments)
            return f"write '{' or '.join(each)}', or "
        case _:
            return ""


# Numbers ----------------------------------------------------------------------------------------


def _rounded(program: ir.Program, functions: Iterable[AppliedFunction]) -> Iterator[Diagnostic]:
    for each in functions:
        computed = each.expression
        if isinstance(computed, ir.Compute) and any(
            _is_long(program, operand) for operand in computed.operands
        ):
            yield report(
                codes.ROUNDED_INTEGER,
                f"'{each.span.text}' is computed in double precision: of a 64-bit integer above"
                " 2^53 the last digits are lost",
                each.span,
                "a comparison without arithmetic is exact: 'x = x.previous()'",
            )


def _is_long(program: ir.Program, value: ir.ValueExpression) -> bool:
    """Return whether a value is a 64-bit integer."""
    match value:
        case ir.Read():
            return program.leaves[value.leaf].type.base in ("int64", "uint64")
        case ir.Apply():
            row = FUNCTIONS[value.function]
            same = row.result is Result.ELEMENT or row.name == "previous"
            return same and _is_long(program, value.arguments[0])
        case _:
            return False


# Times ------------------------------------------------------------------------------------------


def _short(program: ir.Program) -> Iterator[Diagnostic]:
    for part in _written(walk.conditions(program)):
        if isinstance(part, ir.For | ir.Once | ir.Times) and part.duration_ns < _SHORT_NS:
            yield report(
                codes.DURATION_TOO_SHORT,
                f"'{part.span.text}' is over in less than a microsecond, before another message"
                " can come",
                part.span,
                "write a time in which messages come: '0.1 sec'",
            )


def _starting_over(
    written: rules.Rules, program: ir.Program, noticed: Noticed
) -> Iterator[Diagnostic]:
    """Yield one finding per input whose NaN starts a ``for`` over while no rule notices it."""
    every = (part for part in walk.conditions(program) if isinstance(part, ir.For))
    intervals = {each.index: each for each in every}
    found: dict[int, set[int]] = {}
    for place in noticed.places:
        for key in keys_read(place.leaf, program.leaves) if place.context.lasting else ():
            kind, (index, *_) = key
            if kind != "input" or not isinstance(index, int) or index not in noticed.nan:
                continue
            if noticed.answer_at(place, key, at_once=True) != "noticed":
                found.setdefault(index, set()).update(place.context.lasting)
    names = {each.name.text: each.name for each in reversed(written.inputs)}
    for each, indices in sorted(found.items()):
        owner = program.inputs[each]
        if owner.timeout_ns is None or owner.name not in names:
            continue
        spans = [intervals[index].span for index in sorted(indices)]
        yield report(
            codes.INTERVAL_STARTS_OVER,
            f"each NaN of '{owner.name}' starts {_counted(spans)} over, and no rule reacts to it at"
            " once: with one now and then, what should last so long never does",
            names[owner.name].span,
            f"react to '{owner.name}.unknown()' as well",
            tuple(Related(span, "starts over") for span in spans[:SHOWN]),
        )


def _counted(spans: list[Span]) -> str:
    return f"'{spans[0].text}'" if len(spans) == 1 else f"{len(spans)} intervals"


def _written(parts: Iterable[ir.Condition]) -> list[ir.Condition]:
    """Return the parts without those that stand for ``begins``."""
    every = list(parts)
    inner = {id(each.operand) for each in every if isinstance(each, ir.Begins)}
    return [each for each in every if id(each) not in inner]


# Frequencies at the start -----------------------------------------------------------------------


def _high_at_start(program: ir.Program, noticed: Noticed) -> Iterator[Diagnostic]:
    """Yield one finding per rule that acts on a high frequency, which it has before any message."""
    found: dict[int, ir.Frequency] = {}
    for place in noticed.places:
        leaf, context = place.leaf, place.context
        if place.rule is None or not isinstance(leaf, ir.Frequency) or not context.negated:
            continue
        if context.effect is Effect.ACTS and not _has_begun(context, program):
            found.setdefault(place.rule, leaf)
    for index, leaf in sorted(found.items()):
        rule = program.rules[index]
        name = term_name(program, plain_term(leaf))
        yield report(
            codes.HIGH_AT_START,
            f"'{name}' is high at each start, before any message has come, and an action runs where"
            f" it is, by '{rule.full_name}'",
            rule.span,
            f"ask for a low frequency, '{name} < ...', or ask beside it, with 'and', for something"
            " that messages say",
        )


def _has_begun(context: Context, program: ir.Program) -> bool:
    """Return whether a condition decides only where something else is true that no start has."""
    for each in context.assumed:
        if isinstance(each, ir.Frequency | ir.Missing | ir.Unknown):
            return True
        leaf = each.operand if isinstance(each, ir.Not) else each
        if isinstance(leaf, tuple) or walk.operands(leaf):
            continue
        if walk.inputs_read(leaf, program.leaves):  # unknown before the first message
            return True
    return False
