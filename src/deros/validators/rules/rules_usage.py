"""Unused declarations, and resets that are never triggered."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from deros import codes
from deros.diagnostics import Diagnostic, report
from deros.models.rules import ActionCall, NamePath, Rules, Term
from deros.rules.compiler.action_states import ACTIVE
from deros.rules.compiler.rule_names import names_alone
from deros.validators.rules_walk import (
    RulesByName,
    all_terms,
    behaviours_of,
    ends_of_limits,
    rules_of,
    terms_of,
)


def check_usage(rules: Rules) -> Iterator[Diagnostic]:
    """Yield a finding for each constant, input, zone, rule and action that does nothing."""
    read = [term for _, rule in rules_of(rules) for term in terms_of(rule.condition)]
    fixed = [constant.value for constant in rules.constants]
    fixed += [action.binding.value for action in rules.actions if action.binding]
    fixed += [a.service.value for a in rules.actions if a.service and a.service.value]
    fixed += [argument for call in _calls(rules) for argument in call.arguments]
    fixed += _terms_of_gates(rules)
    used = _names((*read, *fixed))
    for constant in rules.constants:
        if constant.name.text not in used:
            message = f"constant '{constant.name}' is not used"
            yield report(codes.UNUSED_CONSTANT, message, constant.name.span)
    used = _names((*read, *ends_of_limits(rules)))
    for each in rules.inputs:
        if each.name.text not in used:
            message = f"no rule reads input '{each.name}'"
            yield report(codes.UNUSED_INPUT, message, each.name.span)
    for zone in rules.zones:
        if zone.name.text not in used:
            message = f"no rule asks for zone '{zone.name}'"
            hint = (
                f"ask for a point in it, 'POINT.inside({zone.name})',"
                f" or for those of a scan, 'SCAN.points_in({zone.name})'"
            )
            yield report(codes.UNUSED_ZONE, message, zone.name.span, hint)
    yield from _unused_rules(rules)
    yield from _actions(rules)


def _names(terms: Iterable[Term]) -> set[str]:
    return {
        inner.name.text
        for term in terms
        for inner in all_terms(term)
        if isinstance(inner, NamePath)
    }


def _calls(rules: Rules) -> Iterator[ActionCall]:
    for behaviour in behaviours_of(rules):
        for item in behaviour.body:
            if isinstance(item, ActionCall):
                yield item


def _terms_of_gates(rules: Rules) -> Iterator[Term]:
    yield from ends_of_limits(rules)
    for line in (line for gate in rules.gates for line in gate.lines):
        stop = line.stop
        yield from (each.value for each in (*stop.ramps, *stop.sent) if each.value) if stop else ()


def _unused_rules(rules: Rules) -> Iterator[Diagnostic]:
    by_name = RulesByName(rules)
    used: set[str] = set()
    open_ = [name for each in behaviours_of(rules) for _, name in by_name.named_by(each.condition)]
    while open_:
        name = open_.pop()
        if name not in used:
            used.add(name)
            open_ += [inner for _, inner in by_name.named_by_rule(name)]
    for full_name, rule in rules_of(rules):
        if full_name not in used:
            message = f"no behaviour depends on rule '{full_name}'"
            yield report(codes.UNUSED_RULE, message, rule.name.span)


def _asked(rules: Rules) -> set[str]:
    """Return the names of which a condition asks whether an action is active."""
    wholes = [rule.condition for _, rule in rules_of(rules)]
    wholes += [behaviour.condition for behaviour in behaviours_of(rules)]
    terms = (term for whole in wholes for term in names_alone(whole))
    return {term.name.text for term in terms if term.path == (ACTIVE,)}


def _actions(rules: Rules) -> Iterator[Diagnostic]:
    triggered = {call.action.text for call in _calls(rules)}
    resets = {action.reset_by.text for action in rules.actions if action.reset_by}
    declared = {action.name.text for action in rules.actions}
    asked = _asked(rules)  # that such an action is never active is a finding of its own
    for action in rules.actions:
        name, reset = action.name.text, action.reset_by
        if name not in triggered and name not in resets and name not in asked:
            message = f"no behaviour triggers action '{name}'"
            yield report(codes.UNUSED_ACTION, message, action.name.span)
        if reset is None or reset.text not in declared:
            continue
        if reset.text == name:
            message = f"'{name}' resets itself: its trigger keeps it active"
            yield report(codes.RESET_WITHOUT_TRIGGER, message, reset.span)
        elif reset.text not in triggered:
            message = f"no behaviour triggers '{reset}', so '{name}' is never reset"
            hint = f"run '{reset};' in a behaviour, or declare '{name}' as 'latched'"
            yield report(codes.RESET_WITHOUT_TRIGGER, message, reset.span, hint)
