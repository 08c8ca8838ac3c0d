"""Checks for unhandled unknown values, unused timeouts and failsafe rules."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from deros import codes
from deros.diagnostics import Diagnostic, Related, report
from deros.metamodels import rules
from deros.monitor import ir, walk
from deros.monitor.build import BuildResult
from deros.monitor.functions import FUNCTIONS, Argument
from deros.monitor.resolved import AppliedFunction
from deros.validators.rules_walk import RulesByName, behaviours_of, rules_of

_Key = tuple[str, tuple[ir.ValueExpression, ...]]
_Function = ir.Apply | ir.Compute
_Verdicts = dict[int, tuple[bool, bool]]  # by rule: surely not false, surely not true


def check_unknown(written: rules.Rules, result: BuildResult) -> Iterator[Diagnostic]:
    """Yield the findings about unknown values in rules without errors."""
    program = result.program
    if program is None:
        return
    used = _used(program)
    yield from _unnoticed(program, used, result.functions)
    yield from _unasked(written, program, used)
    yield from _negated(written, program)
    yield from _without_effect(written, program)


@dataclass(frozen=True, slots=True)
class _Used:
    """The rules that behaviours depend on, by themselves or by other rules.

    Attributes:
        rules: of any behaviour.
        firm: the indices of those of behaviours that cannot be disabled, by themselves or with one
            around them.
        exposed: the indices of those that a behaviour can see while they are unknown: not only
            through failsafe rules.
    """

    rules: list[ir.Rule]
    firm: frozenset[int]
    exposed: frozenset[int]


def _used(program: ir.Program) -> _Used:
    optional: set[int] = set()
    used: set[int] = set()
    firm: set[int] = set()
    for behaviour in walk.behaviours(program):
        if behaviour.optional or behaviour.parent in optional:
            optional.add(behaviour.index)
        for part in walk.parts(behaviour.condition):
            if isinstance(part, ir.RuleRef):
                used.add(part.rule)
                if behaviour.index not in optional:
                    firm.add(part.rule)
    exposed = set(used)
    for rule in reversed(program.rules):  # a rule comes after those that it names
        named = {part.rule for part in walk.parts(rule.condition) if isinstance(part, ir.RuleRef)}
        used |= named if rule.index in used else set()
        firm |= named if rule.index in firm else set()
        is_failsafe = isinstance(rule.condition, ir.Failsafe)
        exposed |= named if rule.index in exposed and not is_failsafe else set()
    rules_used = [program.rules[each] for each in sorted(used)]
    return _Used(rules_used, frozenset(firm), frozenset(exposed))


# Functions that are unknown of known messages ---------------------------------------------------


def _unnoticed(
    program: ir.Program, used: _Used, functions: Iterable[AppliedFunction]
) -> Iterator[Diagnostic]:
    """Yield one finding per rule and function whose loss no rule detects."""
    fallible = sorted(filter(_is_fallible, functions), key=_start)
    starts = [_start(each) for each in fallible]
    everywhere: set[_Key] = set()
    firmly: set[_Key] = set()
    for rule in used.rules:
        keys = set(_noticed(program, rule.condition))
        everywhere |= keys
        firmly |= keys if rule.index in used.firm else set()
    for rule in used.rules:
        if isinstance(rule.condition, ir.Failsafe) or rule.index not in used.exposed:
            continue
        noticed = firmly if rule.index in used.firm else everywhere
        reported: set[_Key] = set()
        read = [part for part in walk.parts(rule.condition) if not isinstance(part, ir.Unknown)]
        asked = {_key(each) for each in walk.values(read) if isinstance(each, _Function)}
        first, end = (bisect_left(starts, place) for place in (rule.span.start, rule.span.end))
        for each in fallible[first:end]:
            key = _key(each.expression)
            if key not in asked or key in noticed or key in reported:
                continue
            reported.add(key)
            hint = f"write 'failsafe {rule.name}: …'"
            related: tuple[Related, ...] = ()
            if isinstance(each.expression, ir.Apply):
                hint += f", or use '{each.span.text}.unknown()' in a rule"
                owner = program.inputs[each.expression.input]
                related = (Related(owner.span, "its messages still arrive: it is not missing"),)
            yield report(
                codes.UNHANDLED_UNKNOWN,
                f"'{rule.full_name}' is unknown while {_reason(each)}, and no rule reacts to that",
                each.span,
                hint,
                related,
            )


def _start(function: AppliedFunction) -> int:
    return function.span.start


def _is_fallible(function: AppliedFunction) -> bool:
    """Return whether a function can be unknown for a valid message."""
    if isinstance(function.expression, ir.Compute):
        return bool(function.unknown_while)
    match FUNCTIONS[function.expression.function].argument:
        case Argument.QUATERNION | Argument.SCAN:
            return True
        case Argument.NUMBERS:
            return not (function.type.array == "fixed" and function.type.size)
        case _:
            return bool(_header(function.expression))


def _reason(function: AppliedFunction) -> str:
    if isinstance(function.expression, ir.Compute):
        return function.unknown_while
    match FUNCTIONS[function.expression.function].argument:
        case Argument.QUATERNION:
            return "the quaternion has length zero"
        case Argument.SCAN:
            return "no beam of the sector is valid"
        case Argument.NUMBER:
            return "the header stamps do not advance"
        case _:
            return "the array is empty"


def _header(function: ir.Apply) -> tuple[ir.ValueExpression, ...]:
    """Return the header fields that a rate over a span reads; none for other functions."""
    return function.arguments[2:] if FUNCTIONS[function.function].over_span else ()


def _key(function: _Function) -> _Key:
    """Return a key that is equal for functions that are unknown for the same messages."""
    if isinstance(function, ir.Compute):
        return "arithmetic", (function,)
    if _header(function):
        return "stamps", _header(function)
    argument = FUNCTIONS[function.function].argument
    name = function.function
    if argument in (Argument.QUATERNION, Argument.NUMBERS):
        name = argument.value
    return name, function.arguments


def _noticed(program: ir.Program, condition: ir.Condition) -> Iterator[_Key]:
    """Yield the functions for which a rule detects that they are unknown."""
    for value in walk.values(p for p in walk.parts(condition) if isinstance(p, ir.Unknown)):
        if isinstance(value, ir.Apply):
            yield _key(value)
    if not isinstance(condition, ir.Failsafe):
        return
    named = walk.named_rules(condition, program.rules)
    wholes = [*(program.rules[index].condition for index in named), condition]
    parts = (part for whole in wholes for part in walk.parts(whole))
    for value in walk.values(part for part in parts if not isinstance(part, ir.Unknown)):
        if not isinstance(value, _Function):
            continue
        key = _key(value)
        verdicts: _Verdicts = {}
        for index, whole in zip(named, wholes, strict=False):
            not_false, not_true = _while_unknown(whole, key, verdicts)
            verdicts[index] = (not_false, not_true and not isinstance(whole, ir.Failsafe))
        if _while_unknown(condition, key, verdicts)[0]:
            yield key


def _while_unknown(condition: ir.Condition, key: _Key, verdicts: _Verdicts) -> tuple[bool, bool]:
    """Return whether a condition is surely not false, and not true, while a function is unknown.

    ``verdicts`` has the same of the rules that it names.
    """
    match condition:
        case ir.Not():
            not_false, not_true = _while_unknown(condition.operand, key, verdicts)
            return not_true, not_false
        case ir.And() | ir.Or():
            every = [_while_unknown(each, key, verdicts) for each in condition.operands]
            none_false = [not_false for not_false, _ in every]
            none_true = [not_true for _, not_true in every]
            if isinstance(condition, ir.And):
                return all(none_false), any(none_true)
            return any(none_false), all(none_true)
        case ir.For():
            not_false, not_true = _while_unknown(condition.operand, key, verdicts)
            return not_false and not_true, not_true  # true for too short a time is false
        case ir.Once():  # it may be true from before
            return _while_unknown(condition.operand, key, verdicts)[0], False
        case ir.Since():  # it may be false, or true, from before
            return False, False
        case ir.Begins() | ir.Failsafe():
            return _while_unknown(condition.operand, key, verdicts)
        case ir.RuleRef():
            return verdicts[condition.rule]
        case ir.Unknown():
            return False, False
        case _:
            read = walk.values([condition])
            surely = any(_key(each) == key for each in read if isinstance(each, _Function))
            return surely, surely


# Timeouts ---------------------------------------------------------------------------------------


def _unasked(written: rules.Rules, program: ir.Program, used: _Used) -> Iterator[Diagnostic]:
    """Yield one finding per input whose timeout no rule of a behaviour uses."""
    everywhere: set[int] = set()
    firmly: set[int] = set()
    read_firmly: set[int] = set()
    aged: set[int] = set()
    for rule in used.rules:
        parts = tuple(walk.parts(rule.condition))
        aged.update(part.input for part in parts if isinstance(part, ir.Age))
        asked = {index for part in parts for index in _asked(part)}
        everywhere |= asked
        if rule.index in used.firm:
            firmly |= asked
            read_firmly |= walk.inputs_read(rule.condition, program.leaves)
    names = {each.name.text: each.name for each in reversed(written.inputs)}
    for each in program.inputs:
        if each.timeout_ns is None or each.name not in names:
            continue
        noticed = firmly if each.index in read_firmly else everywhere
        if each.index in noticed:
            continue
        # Before the first message there is no age, so age() does not detect that none arrives.
        when = f"messages on {each.topic} {'never arrive' if each.index in aged else 'stop'}"
        if _stops_with(each, [program.inputs[index] for index in noticed]):
            if not any(leaf.can_be_nan for leaf in program.leaves if leaf.input == each.index):
                continue
            when = "it is NaN"
        yield report(
            codes.UNUSED_TIMEOUT,
            f"no rule notices that '{each.name}' is unknown: when {when}, nothing reacts",
            names[each.name].span,
            f"react to '{each.name}.missing()' or '{each.name}.unknown()', or declare a rule on it"
            " 'failsafe'",
        )


def _stops_with(silent: ir.Input, noticed: list[ir.Input]) -> bool:
    """Return whether the silence of another input of the same topic is noticed as early."""
    timeouts = [each.timeout_ns for each in noticed if each.topic == silent.topic]
    return any(each is not None and each <= (silent.timeout_ns or 0) for each in timeouts)


def _asked(condition: ir.Condition) -> tuple[int, ...]:
    """Return the inputs that a condition itself, not a part of it, checks for silence."""
    match condition:
        case ir.Missing(input=index) | ir.Unknown(input=index):
            return (index,)
        case ir.Failsafe(inputs=inputs):
            return inputs
        case _:
            return ()


# Failsafe rules ---------------------------------------------------------------------------------


def _negated(written: rules.Rules, program: ir.Program) -> Iterator[Diagnostic]:
    """Yield one finding per ``not`` of a failsafe rule that keeps a behaviour from acting.

    Behaviours that only reset actions or log are left out.
    """
    resets = {each.reset_by for each in program.actions}
    failsafe = {
        each.full_name: each for each in program.rules if isinstance(each.condition, ir.Failsafe)
    }
    names = RulesByName(written)
    both = zip(behaviours_of(written), walk.behaviours(program), strict=True)
    for source, behaviour in both:
        run = [program.actions[index] for index in sorted(_actions(behaviour) - resets)]
        acts = [f"'{each.name}'" for each in run if each.name != "log_state"]
        for term, full_name in _under_not(names, source.condition) if acts else ():
            rule = failsafe.get(full_name)
            if rule is not None:
                yield report(
                    codes.FAILSAFE_NEGATED,
                    f"'{rule.full_name}' counts as true while it is unknown, so"
                    f" '{behaviour.name}' does not run {', '.join(acts)} then",
                    term.span,
                    "invert the rule, so that it is true when there is a danger",
                    (Related(rule.span, "the failsafe rule"),),
                )


def _actions(behaviour: ir.Behaviour) -> set[int]:
    """Return the actions in a behaviour's body and in those nested in it."""
    found: set[int] = set()
    for item in behaviour.body:
        found |= _actions(item) if isinstance(item, ir.Behaviour) else {item.action}
    return found


def _under_not(
    names: RulesByName, condition: rules.Condition
) -> Iterator[tuple[rules.NamePath, str]]:
    """Yield the rules that a behaviour depends on under an odd number of ``not``.

    Each is where the behaviour names it, or where a rule on which it depends does, with its full
    name.
    """
    seen: set[tuple[str, bool]] = set()
    open_ = [("", condition, False)]
    while open_:
        entity, asked, negated = open_.pop(0)
        for term, is_negated in _signed(asked, negated):
            full_name = names.full_name(term, entity)
            if full_name is None:
                continue
            if is_negated:
                yield term, full_name
            if (full_name, is_negated) not in seen:
                seen.add((full_name, is_negated))
                owner, rule = names[full_name]
                open_.append((owner, rule.condition, is_negated))


def _signed(condition: rules.Condition, negated: bool) -> Iterator[tuple[rules.NamePath, bool]]:
    """Yield the names that stand alone, each with whether it is negated."""
    match condition:
        case rules.Truth(operand=rules.NamePath() as term):
            yield term, negated
        case rules.Not(operand=operand):
            yield from _signed(operand, not negated)
        case rules.For() | rules.Once() | rules.Begins():
            yield from _signed(condition.operand, negated)
        case rules.And(operands=operands) | rules.Or(operands=operands):
            for operand in operands:
                yield from _signed(operand, negated)
        case rules.Since(operand=operand, cause=cause):
            yield from _signed(operand, negated)
            yield from _signed(cause, negated)
        case _:
            pass


def _without_effect(written: rules.Rules, program: ir.Program) -> Iterator[Diagnostic]:
    failsafe = {each.full_name for each in program.rules if isinstance(each.condition, ir.Failsafe)}
    for full_name, rule in rules_of(written):
        if rule.failsafe and full_name not in failsafe:
            message = f"'{full_name}' is never unknown, so 'failsafe' changes nothing"
            hint = "a failsafe rule reads the value of an input; missing() and unknown() do not"
            yield report(codes.FAILSAFE_WITHOUT_EFFECT, message, rule.name.span, hint)
