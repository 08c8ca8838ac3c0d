"""Checks of failsafe rules: whether they act, or keep from acting, where they are unknown."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from deros import codes
from deros.diagnostics import Diagnostic, Related, report
from deros.models import rules
from deros.rules.program import ir, walk
from deros.validators.rules_walk import RulesByName, behaviours_of, rules_of

_SignedName = tuple[rules.NamePath, str, bool, rules.NamePath | None]


def check_failsafe(written: rules.Rules, program: ir.Program) -> Iterator[Diagnostic]:
    """Yield the findings about failsafe rules in rules without errors."""
    yield from _misused(written, program)
    yield from _without_effect(written, program)


def _misused(written: rules.Rules, program: ir.Program) -> Iterator[Diagnostic]:
    """Yield one finding per failsafe rule that keeps a behaviour from acting or permits a reset.

    Under ``not`` it keeps a behaviour from acting, unless that only resets actions or logs. Without
    ``not`` it permits what a behaviour resets, also through the state of another action.
    """
    reset_by: dict[int, list[str]] = {}
    for action in program.actions:
        if action.reset_by is not None and action.reset_by != action.index:
            reset_by.setdefault(action.reset_by, []).append(f"'{action.name}'")
    failsafe = {
        each.full_name: each for each in program.rules if isinstance(each.condition, ir.Failsafe)
    }
    both = list(zip(behaviours_of(written), walk.behaviours(program), strict=True))
    signed = _SignedNames(written, program, both)
    for source, behaviour in both if failsafe else ():
        run = [program.actions[index] for index in sorted(_actions(behaviour))]
        resets = [each for each in run if each.index in reset_by]
        acts = [f"'{each.name}'" for each in run if each not in resets and each.name != "log_state"]
        for term, full_name, negated, asked in signed.of(source.condition):
            rule = failsafe.get(full_name)
            if rule is None:
                continue
            counts = f"'{rule.full_name}' counts as true while it is unknown, so '{behaviour.name}'"
            places = [Related(rule.span, "the failsafe rule")]
            if asked is not None:
                places.append(Related(asked.span, f"where '{behaviour.name}' depends on it"))
            related = tuple(places)
            # What acts while an action is not active may mean just that, as a lamp does.
            if negated and acts and asked is None:
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


class _SignedNames:
    """The rules that behaviours depend on, by themselves or through the states of actions."""

    def __init__(
        self,
        written: rules.Rules,
        program: ir.Program,
        both: Iterable[tuple[rules.Behaviour, ir.Behaviour]],
    ) -> None:
        """Note the conditions of the behaviours that run each action, and those around them."""
        self._names = RulesByName(written)
        self._actions = {each.name: each for each in program.actions}
        self._runs: dict[int, list[rules.Condition]] = {}
        for source, behaviour in both:
            for action in _actions(behaviour):
                self._runs.setdefault(action, []).append(source.condition)

    def of(self, condition: rules.Condition) -> Iterator[_SignedName]:
        """Yield the rules that a behaviour depends on, once under each parity of ``not``.

        Each is where the behaviour names it, or where a condition on which it depends does, with
        its full name, whether it is under an odd number of ``not``, and the name of the first
        action whose state leads there, if one does.
        """
        seen: set[tuple[int, bool, bool]] = set()
        open_: list[tuple[str, rules.Condition, bool, rules.NamePath | None]]
        open_ = [("", condition, False, None)]
        while open_:
            entity, whole, negated, asked = open_.pop(0)
            # The models are trees that live as long as this: identity distinguishes conditions.
            key = (id(whole), negated, asked is None)
            if key in seen:
                continue
            seen.add(key)
            for term, is_negated in _signed(whole, negated):
                full_name = self._names.full_name(term, entity)
                if full_name is not None:
                    yield term, full_name, is_negated, asked
                    owner, rule = self._names[full_name]
                    open_.append((owner, rule.condition, is_negated, asked))
                    continue
                for other, is_other_negated in self._deciding(term, is_negated):
                    open_.append(("", other, is_other_negated, asked or term))

    def _deciding(
        self, term: rules.NamePath, negated: bool
    ) -> Iterator[tuple[rules.Condition, bool]]:
        """Yield what decides whether the action that a term names is active, with its parity."""
        action = self._actions.get(self._names.action(term) or "")
        if action is None:
            return
        for trigger in self._runs.get(action.index, ()):
            yield trigger, negated
        for reset in self._runs.get(action.reset_by, ()) if action.reset_by is not None else ():
            yield reset, not negated


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
