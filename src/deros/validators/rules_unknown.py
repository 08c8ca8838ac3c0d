"""Values that are unknown although no input is silent, and silence that no rule asks for."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from deros import codes
from deros.diagnostics import Diagnostic, Related, report
from deros.metamodels import rules
from deros.monitor import ir, walk
from deros.monitor.build import BuildResult
from deros.monitor.functions import FUNCTIONS, Argument
from deros.monitor.resolved import AppliedFunction
from deros.validators.rules_walk import behaviours_of, rules_of

_Key = tuple[str, tuple[ir.ValueExpression, ...]]


def check_unknown(written: rules.Rules, result: BuildResult) -> Iterator[Diagnostic]:
    """Yield the findings about what rules without errors do not know."""
    program = result.program
    if program is None:
        return
    used = [program.rules[index] for index in sorted(_used(program))]
    yield from _unnoticed(program, used, result.functions)
    yield from _unasked(written, program, used)
    yield from _negated(written, program)
    yield from _without_effect(written, program)


def _used(program: ir.Program) -> set[int]:
    """Return the rules that a behaviour depends on."""
    return {
        part.rule
        for behaviour in walk.behaviours(program)
        for part in walk.parts(behaviour.condition)
        if isinstance(part, ir.RuleRef)
    }


# Functions that are unknown of known messages ---------------------------------------------------


def _unnoticed(
    program: ir.Program, used: list[ir.Rule], functions: Iterable[AppliedFunction]
) -> Iterator[Diagnostic]:
    """Yield one finding per rule and function whose loss neither it nor another rule notices."""
    fallible = [each for each in functions if _is_fallible(each)]
    keys = {_key(each.expression) for each in fallible}
    noticed = {key for rule in used for key in keys if _notices(rule.condition, key)}
    for rule in used:
        if isinstance(rule.condition, ir.Failsafe):
            continue
        reported: set[_Key] = set()
        read = [part for part in walk.parts(rule.condition) if not isinstance(part, ir.Unknown)]
        asked = {_key(each) for each in walk.values(read) if isinstance(each, ir.Apply)}
        for each in fallible:
            key = _key(each.expression)
            inside = rule.span.start <= each.span.start < rule.span.end
            if not inside or key not in asked or key in noticed | reported:
                continue
            reported.add(key)
            owner = program.inputs[each.expression.input]
            yield report(
                codes.UNNOTICED_UNKNOWN,
                f"'{rule.full_name}' is unknown while {_reason(each)}, and nothing acts on that",
                each.span,
                f"write 'failsafe {rule.name}: …', or use '{each.span.text}.unknown()' in a rule",
                (Related(owner.span, "its messages count all the while: it is not missing"),),
            )


def _is_fallible(function: AppliedFunction) -> bool:
    """Tell whether a function can be unknown of a message that counts."""
    match FUNCTIONS[function.expression.function].argument:
        case Argument.QUATERNION | Argument.SCAN:
            return True
        case Argument.NUMBERS:
            return not (function.type.array == "fixed" and function.type.size)
        case _:
            return False


def _reason(function: AppliedFunction) -> str:
    match FUNCTIONS[function.expression.function].argument:
        case Argument.QUATERNION:
            return "the quaternion has length zero"
        case Argument.SCAN:
            return "no beam of the sector is valid"
        case _:
            return "the array is empty"


def _key(function: ir.Apply) -> _Key:
    """Return what functions have in common that are unknown of the same messages."""
    argument = FUNCTIONS[function.function].argument
    name = function.function
    if argument in (Argument.QUATERNION, Argument.NUMBERS):
        name = argument.value
    return name, function.arguments


def _notices(condition: ir.Condition, key: _Key) -> bool:
    """Tell whether a rule asks whether a function is unknown, or is failsafe while it is."""
    if isinstance(condition, ir.Failsafe):
        not_false, _ = _while_unknown(condition.operand, key)
        if not_false:
            return True
    asked = [part for part in walk.parts(condition) if isinstance(part, ir.Unknown)]
    return any(_key(each) == key for each in walk.values(asked) if isinstance(each, ir.Apply))


def _while_unknown(condition: ir.Condition, key: _Key) -> tuple[bool, bool]:
    """Return whether a condition is surely not false, and surely not true, without a function."""
    match condition:
        case ir.Not():
            not_false, not_true = _while_unknown(condition.operand, key)
            return not_true, not_false
        case ir.And() | ir.Or():
            every = [_while_unknown(each, key) for each in condition.operands]
            none_false = [not_false for not_false, _ in every]
            none_true = [not_true for _, not_true in every]
            if isinstance(condition, ir.And):
                return all(none_false), any(none_true)
            return any(none_false), all(none_true)
        case ir.For():
            not_false, not_true = _while_unknown(condition.operand, key)
            return not_false and not_true, not_true  # true for too short a time is false
        case ir.Unknown():
            return False, False
        case _:
            read = walk.values([condition])
            surely = any(_key(each) == key for each in read if isinstance(each, ir.Apply))
            return surely, surely


# Timeouts ---------------------------------------------------------------------------------------


def _unasked(
    written: rules.Rules, program: ir.Program, used: list[ir.Rule]
) -> Iterator[Diagnostic]:
    """Yield one finding per input whose silence no rule of a behaviour asks for."""
    asked: set[int] = set()
    aged: set[int] = set()
    for rule in used:
        for part in walk.parts(rule.condition):
            if isinstance(part, ir.Missing | ir.Unknown):
                asked.add(part.input)
            elif isinstance(part, ir.Age):
                aged.add(part.input)
            elif isinstance(part, ir.Failsafe):
                asked.update(part.inputs)
    names = {each.name.text: each.name for each in reversed(written.inputs)}
    for each in program.inputs:
        if each.timeout_ns is None or each.index in asked or each.name not in names:
            continue
        # Before the first message there is no age, so age() does not tell that none comes.
        when = "never comes" if each.index in aged else "falls silent"
        yield report(
            codes.UNASKED_TIMEOUT,
            f"no rule asks for the timeout of '{each.name}': when {each.topic} {when},"
            " nothing acts",
            names[each.name].span,
            f"a rule with '{each.name}.missing()' or '{each.name}.unknown()', or a failsafe rule"
            " on it, says what is to happen",
        )


# Failsafe rules ---------------------------------------------------------------------------------


def _negated(written: rules.Rules, program: ir.Program) -> Iterator[Diagnostic]:
    """Yield one finding per ``not`` of a failsafe rule that keeps a behaviour from acting.

    What only resets other actions, or logs, may well stay away.
    """
    resets = {each.reset_by for each in program.actions}
    failsafe = {
        each.full_name: each for each in program.rules if isinstance(each.condition, ir.Failsafe)
    }
    both = zip(behaviours_of(written), walk.behaviours(program), strict=True)
    for source, behaviour in both:
        run = [program.actions[index] for index in sorted(_actions(behaviour) - resets)]
        acts = [f"'{each.name}'" for each in run if each.name != "log_state"]
        for term in _under_not(source.condition, negated=False) if acts else ():
            rule = failsafe.get(f"{term.name}.{term.path[0]}")
            if rule is not None:
                yield report(
                    codes.FAILSAFE_NEGATED,
                    f"'{rule.full_name}' counts as true while it is unknown, so"
                    f" '{behaviour.name}' does not run {', '.join(acts)} then",
                    term.span,
                    "turn the rule round, so that it is true where there is a danger",
                    (Related(rule.span, "the failsafe rule"),),
                )


def _actions(behaviour: ir.Behaviour) -> set[int]:
    """Return the actions in a behaviour's body and in those nested in it."""
    found: set[int] = set()
    for item in behaviour.body:
        found |= _actions(item) if isinstance(item, ir.Behaviour) else {item.action}
    return found


def _under_not(condition: rules.Condition, *, negated: bool) -> Iterator[rules.NamePath]:
    """Yield the rules that stand under an odd number of ``not``."""
    match condition:
        case rules.Truth(operand=rules.NamePath() as term) if negated:
            yield term
        case rules.Not(operand=operand):
            yield from _under_not(operand, negated=not negated)
        case rules.For(operand=operand):
            yield from _under_not(operand, negated=negated)
        case rules.And(operands=operands) | rules.Or(operands=operands):
            for operand in operands:
                yield from _under_not(operand, negated=negated)
        case _:
            pass


def _without_effect(written: rules.Rules, program: ir.Program) -> Iterator[Diagnostic]:
    for built, (full_name, rule) in zip(program.rules, rules_of(written), strict=True):
        if rule.failsafe and not isinstance(built.condition, ir.Failsafe):
            message = f"'{full_name}' is never unknown, so 'failsafe' changes nothing"
            hint = "a failsafe rule reads the value of an input; missing() and unknown() do not"
            yield report(codes.FAILSAFE_WITHOUT_EFFECT, message, rule.name.span, hint)
