"""Checks of failsafe rules: whether they act, or keep from acting, where they are unknown."""

from __future__ import annotations

from collections.abc import Iterator

from deros import codes
from deros.diagnostics import Diagnostic, Related, report
from deros.models import rules
from deros.rules.program import ir, walk
from deros.validators.rules_walk import RulesByName, behaviours_of, rules_of


def check_failsafe(written: rules.Rules, program: ir.Program) -> Iterator[Diagnostic]:
    """Yield the findings about failsafe rules in rules without errors."""
    yield from _misused(written, program)
    yield from _without_effect(written, program)


def _misused(written: rules.Rules, program: ir.Program) -> Iterator[Diagnostic]:
    """Yield one finding per failsafe rule that keeps a behaviour from acting or permits a reset.

    Under ``not`` it keeps a behaviour from acting, unless that only resets actions or logs. Without
    ``not`` it permits what a behaviour resets.
    """
    reset_by: dict[int, list[str]] = {}
    for action in program.actions:
        if action.reset_by is not None and action.reset_by != action.index:
            reset_by.setdefault(action.reset_by, []).append(f"'{action.name}'")
    failsafe = {
        each.full_name: each for each in program.rules if isinstance(each.condition, ir.Failsafe)
    }
    names = RulesByName(written)
    both = zip(behaviours_of(written), walk.behaviours(program), strict=True)
    for source, behaviour in both if failsafe else ():
        run = [program.actions[index] for index in sorted(_actions(behaviour))]
        resets = [each for each in run if each.index in reset_by]
        acts = [f"'{each.name}'" for each in run if each not in resets and each.name != "log_state"]
        for term, full_name, negated in _signed_names(names, source.condition):
            rule = failsafe.get(full_name)
            if rule is None:
                continue
            counts = f"'{rule.full_name}' counts as true while it is unknown, so '{behaviour.name}'"
            related = (Related(rule.span, "the failsafe rule"),)
            if negated and acts:
                yield report(
                    codes.FAILSAFE_NEGATED,
                    f"{counts} does not run {', '.join(acts)} then",
                    term.span,
                    "invert the rule, so that it is true when there is a danger",
                    related,
                )
            for reset in () if negated else resets:
                yield report(
                    codes.FAILSAFE_NEGATED,
                    f"{counts} may run '{reset.name}' then, which resets"
                    f" {', '.join(reset_by[reset.index])}",
                    term.span,
                    f"state the danger: 'failsafe' before its opposite, and 'not' of that here, or"
                    f" '{rule.name}' without 'failsafe'",
                    related,
                )


def _actions(behaviour: ir.Behaviour) -> set[int]:
    """Return the actions in a behaviour's body and in those nested in it."""
    found: set[int] = set()
    for item in behaviour.body:
        found |= _actions(item) if isinstance(item, ir.Behaviour) else {item.action}
    return found


def _signed_names(
    names: RulesByName, condition: rules.Condition
) -> Iterator[tuple[rules.NamePath, str, bool]]:
    """Yield the rules that a behaviour depends on, once under each parity of ``not``.

    Each is where the behaviour names it, or where a rule on which it depends does, with its full
    name and whether it is under an odd number of ``not``.
    """
    seen: set[tuple[str, bool]] = set()
    open_ = [("", condition, False)]
    while open_:
        entity, asked, negated = open_.pop(0)
        for term, is_negated in _signed(asked, negated):
            full_name = names.full_name(term, entity)
            if full_name is None:
                continue
            yield term, full_name, is_negated
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
        case _:
            for operand in rules.operands(condition):
                yield from _signed(operand, negated)


def _without_effect(written: rules.Rules, program: ir.Program) -> Iterator[Diagnostic]:
    failsafe = {each.full_name for each in program.rules if isinstance(each.condition, ir.Failsafe)}
    for full_name, rule in rules_of(written):
        if rule.failsafe and full_name not in failsafe:
            message = f"'{full_name}' is never unknown, so 'failsafe' changes nothing"
            hint = "a failsafe rule reads the value of an input; missing() and unknown() do not"
            yield report(codes.FAILSAFE_WITHOUT_EFFECT, message, rule.name.span, hint)
